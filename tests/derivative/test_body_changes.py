# SPDX-License-Identifier: BSD-3-Clause
"""What materials and shapes change at once: states substituted back together, other laws, what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.derivative import contact_sums
from signorini.derivative.low_rank import state_columns
from signorini.derivative.modulus_pairs import ModulusPairs
from signorini.derivative.view import displacement_at
from signorini.engine.prepare import prepare
from signorini.fem.kinematics import straining_groups
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness, stiffness_change
from signorini.gallery.sectors import ring_on_pads
from tests.derivative.rig import STEPS, rig


def test_states_are_combinations_of_those_that_are_substituted_back():
    """Let go and pulled again the pairs come back to where they were: fewer states than points."""
    every = sg.solve(rig(steps=(*STEPS, STEPS[1], STEPS[2])), tape=True)._taped.view.points
    points = [point for point in every if point.system.bodies == every[-1].system.bodies]
    columns = list(state_columns(points))
    assert sum(len(part.shares) for part in columns) < len(points)
    for i, point in enumerate(points):
        found = sum(part.displacement @ part.shares[:, i] for part in columns)
        wanted = displacement_at(point)
        assert found == pytest.approx(wanted, abs=1e-10 * np.abs(wanted).max())


def test_of_two_bodies_one_pairing_anew_tells_what_both_moduli_change():
    """Normals know the ratio of both moduli alone."""
    prepared = prepare(rig())
    seen, alone = ModulusPairs(prepared), ModulusPairs(prepared)
    assert seen.of(0).any
    mirrored, found = seen.of(1), alone.of(1)
    for name in ("B", "gap"):
        wanted, rounding = abs(getattr(found, name)).max(), 1e-15 / found.step  # of lengths and weights of about 1
        assert abs(getattr(mirrored, name) - getattr(found, name)).max() <= 1e-7 * wanted + rounding
    assert mirrored.step == found.step
    for one, two in ((mirrored.low, found.low), (mirrored.high, found.high)):
        assert abs(one.B - two.B).max() <= 1e-7 * abs(prepared.interface.B).max()


@pytest.mark.parametrize("formulation", ["standard", "incompatible", "mean dilatation"])
def test_other_laws_add_the_difference_of_both_stiffnesses(formulation):
    block = sg.Body("block", sg.Elastic(E=900.0, nu=0.25), formulation=formulation)
    mesh = sg.rectangle(nx=2, ny=2, width=2.6)
    before = sg.Model(replace(mesh, bodies={"block": mesh.bodies["block"]}), kind="plane strain", bodies=[block])
    after = replace(before, bodies=[replace(block, material=sg.Elastic(E=950.0, nu=0.31))])
    space = make_space(mesh)
    change = stiffness_change(space, before, after, straining_groups(space, before))
    wanted = (stiffness(space, after) - stiffness(space, before)).toarray()
    assert change.toarray() == pytest.approx(wanted, abs=1e-10 * np.abs(wanted).max())


def test_a_shape_that_moves_what_is_held_by_its_place_is_refused():
    model = rig()
    down = sg.Support("pad.top", u=(None, lambda x: -0.02 - 0.001 * x[:, 0]), name="down")
    held = sg.solve(replace(model, supports=[down, model.supports[1]]), tape=True)
    derivative = held.derivative(sg.pressure("joint").peak)
    motion = np.zeros_like(model.mesh.points)
    motion[model.mesh.nodes_of("pad.bottom")] = [0.0, 1.0]
    assert np.isfinite(derivative.shape(motion))
    motion[model.mesh.nodes_of("pad.top")] = [1.0, 0.0]
    with pytest.raises(sg.InputError, match="hold by where they are"):
        derivative.shape(motion)


@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric"])
def test_sums_over_contact_nodes_are_those_over_displacements_of_all_states(kind, monkeypatch):
    """By a material with a temperature, a tilted side and a shape; outputs of contacts and of bodies."""
    solution = sg.solve(rig(kind), tape=True)
    motion = np.random.default_rng(4).standard_normal(solution.model.mesh.points.shape)
    every = [sg.dissipation("joint"), sg.stress("block", 50, "xx").after(2)]

    def found():
        return [
            (derivative.nu["pad"], derivative.expansion["block"], *derivative.shape_sides(motion))
            for derivative in map(solution.derivative, every)
        ]

    monkeypatch.setattr(contact_sums, "_SUBSTITUTED", 0)
    by_sums = found()
    monkeypatch.setattr(contact_sums, "_SUBSTITUTED", np.inf)
    solution.__dict__.pop("_taped")
    for one, other in zip(by_sums, found(), strict=True):
        assert one[:2] == pytest.approx(other[:2], rel=1e-8)
        assert one[2:] == pytest.approx(other[2:], rel=1e-7)  # sums see cells exactly, states by differences


def test_a_stress_on_the_side_of_a_sector_knows_the_cells_at_its_other_side():
    model = ring_on_pads(whole=False)
    body, node = model.bodies[0], int(model.mesh.nodes_of("ring.start")[2])
    output = sg.stress(body.name, node, "xx")

    def stress(nu):
        changed = replace(body, material=replace(body.material, nu=nu))
        return sg.solve(replace(model, bodies=[changed, *model.bodies[1:]]), tape=True).derivative(output).value

    nu, step = body.material.nu, 1e-4
    found = sg.solve(model, tape=True).derivative(output).nu[body.name]
    assert found == pytest.approx((stress(nu + step) - stress(nu - step)) / (2.0 * step), rel=1e-6)
