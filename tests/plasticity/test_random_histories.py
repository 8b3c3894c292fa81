# SPDX-License-Identifier: BSD-3-Clause
"""Random small histories of bodies that yield beside elements and a flow rule that share no line with them (a sample).

Hundreds more, of any seed: `python -m benchmarks.plastic_histories 500 --seed 17`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from benchmarks import plastic_histories as histories
from benchmarks.independent_history import Acts, Follower
from benchmarks.plastic_models import in_words, make


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "kinds"),
    [
        (3, "softened table mortar"),
        (2, "quad9 frederick plane-strain"),
        (2, "hexahedron27 combined"),
        (5, "wedge15 prager mortar units"),
        (6, "iterated auto rigid"),
        (8, "tied axisymmetric"),
        (9, "round moving space"),
        (2, "incompatible softened plane-strain"),
        (4, "overlap restart turned"),
        (801, "hexahedron20"),
        (995, "rigid"),
    ],
)
def test_answers_obey_the_laws(seed, kinds):
    case = make(seed, frozenset(word.replace("-", " ") for word in kinds.split()))
    verdict = histories.judge(case)
    assert verdict.outcome == "right", (sorted(case.kinds), verdict)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [8, 26])
def test_collapse_is_named_where_contact_loses_the_longest_step(seed):
    """Contact finds nothing on the softest tangent; on stiffer ones steps are shorter, and bound the load worse."""
    kinds = {"plane stress", "triangle6", "curved", "two", "perfect"}
    verdict = histories.judge(make(seed, frozenset(kinds), exactly=True))
    assert verdict.outcome == "collapse", verdict


@pytest.mark.slow
def test_the_slow_solver_finds_the_same_answers():
    verdict = histories.judge(make(2, frozenset({"plane strain", "quad"})), solve=True)
    assert verdict.outcome == "right", verdict


@pytest.mark.slow
def test_increments_tend_to_tiny_ones():
    verdict = histories.refined(make(3, frozenset({"plane strain", "quad"})))
    assert verdict.outcome == "of first order", verdict


def test_the_judge_sees_a_wrong_answer():
    case = make(2)
    softer = [replace(law, tables=[rows * [1.0, 0.999] for rows in law.tables]) for law in case.structure.laws]
    wrong = replace(case, structure=replace(case.structure, laws=softer))
    assert histories.judge(wrong).outcome == "WRONG"


@pytest.mark.slow
def test_a_plate_with_a_hole_in_plane_stress():
    flat = sg.rectangle(width=1.0, height=1.0, nx=3, ny=4)
    t, turn = flat.points[:, :1], 0.5 * np.pi * flat.points[:, 1:]
    ray = np.hstack([np.cos(turn), np.sin(turn)])
    mesh = replace(flat, points=(1 - t) * 0.4 * ray + t * ray / np.abs(ray).max(axis=1, keepdims=True))
    pulled = np.flatnonzero(np.isclose(mesh.points[:, 1], 1.0))
    steel = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(1.0, hardening=2.0, backstresses=[(20.0, 0.0)]))
    stretch = 1.5 / 200.0
    model = sg.Model(
        mesh,
        kind="plane stress",
        thickness=0.5,
        bodies=[sg.Body("block", steel)],
        supports=[sg.Support("bottom", u=(None, 0.0)), sg.Support("top", u=(0.0, None))]
        + [sg.Support(tuple(mesh.points[i].tolist()), u=(None, stretch)) for i in pulled],
        steps=[sg.Step(increments=2, at="events")],
    )
    moved = np.zeros(mesh.points.size)
    moved[2 * pulled + 1] = stretch
    held = {*(2 * mesh.nodes_of("bottom") + 1).tolist(), *(2 * mesh.nodes_of("top")).tolist()}
    held |= set((2 * pulled + 1).tolist())
    structure = in_words(model, held)
    reference, whole = Follower.of(structure), replace(Acts.none(structure), held=moved)
    solution = sg.solve(model)
    for instant in solution.steps[0].instants:
        reference.follow(Acts.none(structure).plus(whole, instant.load_factor))
        np.testing.assert_allclose(instant.displacement.ravel(), reference.u, atol=1e-8 * stretch)
    plastic = solution.end.state.plastic
    assert plastic.equivalent.max() > 5e-3
    np.testing.assert_allclose(np.sort(plastic.equivalent), np.sort(reference.state.equivalent), atol=1e-9)
