# SPDX-License-Identifier: BSD-3-Clause
"""Notes on patches of too few pairs, and on overlaps that a mesh has."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.validity_notes import overlap_notes
from signorini.gallery.blocks import block_on_foundation
from signorini.gallery.press_fit import press_fit

STEEL = sg.Elastic(E=1000.0, nu=0.3)


def disk(load, *, kind="plane strain", order=1):
    mesh = sg.quarter_disk(radius=8.0, contact_length=2.0, contact_spacing=0.25, order=order)
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body("disk", STEEL)],
        supports=[sg.Support("axis", u=(0, None))],
        loads=[sg.Load("cut", traction=(0, -load))],
        contacts=[sg.Contact("arc", sg.Plane((0, 0), (0, 1)), name="floor")],
    )


def few(model):
    return [note for note in sg.solve(model).last.notes if "across" in note]


@pytest.mark.parametrize(("load", "pairs"), [(0.05, 1), (1.0, 3), (20.0, None)])
def test_a_patch_of_few_pairs_is_noted(load, pairs):
    """Half a patch at the plane of symmetry: two pairs are three across."""
    notes = few(disk(load))
    assert bool(notes) == (pairs is not None)
    assert all(f"with {pairs} pair" in note for note in notes)


@pytest.mark.parametrize("cells", ["hexahedron", "tetra"])
@pytest.mark.parametrize(
    ("width", "half", "pairs"),
    [
        (0.1, False, 1),
        (0.3, False, 2),
        (0.6, False, 3),
        (0.8, False, 4),
        (0.1, True, 1),
        (0.6, True, 3),
        (1.1, True, 5),
    ],
)
def test_in_space_pairs_are_counted_across(width, half, pairs, cells):
    """A punch with a flat square end on pairs 0.25 apart; half of it where y = 0 is a plane of symmetry."""
    z = np.linspace(-1.0, 1.0, 9)
    x = z + (0.125 if pairs % 2 == 0 else 0.0)
    y = np.linspace(0.0, 1.0, 5) if half else x
    edges = 0.5 * width * np.array([-1.0, 1.0])
    ends = np.array([[a, b, 1.0] for b in edges for a in edges])
    punch = sg.Surface(ends, [[0, 3, 1], [0, 2, 3]])
    model = sg.Model(
        sg.box(x=x, y=y, z=z, cells=cells),
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(0, 0, 0)), sg.Support("front", u=(None, 0, None))][: 1 + half],
        contacts=[sg.Contact("top", punch, name="punch", interference=0.01)],
    )
    notes = few(model)
    assert bool(notes) == (pairs < 4)
    assert all(f"with {pairs} pair" in note for note in notes)


def test_patches_that_end_with_their_side_are_not():
    assert not few(block_on_foundation(across=(2, 1)))
    assert not few(press_fit(n_radial=1, n_angular=2))


def test_an_overlap_of_the_mesh_is_noted_by_a_solution_too():
    model = press_fit(n_radial=1, n_angular=(3, 2), interference=0.0, drawn=0.01)
    notes = [note for note in sg.solve(model).last.notes if "overlaps" in note]
    assert notes == list(overlap_notes(sg.engine.examine.examine(model)))
    assert len(notes) == 1
    assert not [n for n in sg.solve(press_fit(n_radial=1, n_angular=3)).last.notes if "overlaps" in n]


@pytest.mark.parametrize("gap", [np.zeros(3), [0.0, 1.0], np.array([])])
def test_gaps_that_are_not_one_a_node_are_told(gap):
    model = press_fit(n_radial=1, n_angular=3)
    contacts = [replace(contact, gap=gap, interference=0.0) for contact in model.contacts]
    with pytest.raises(sg.InputError, match=r"contact\[0\]\.gap: has \d values; expected one per node"):
        sg.solve(replace(model, contacts=contacts))
