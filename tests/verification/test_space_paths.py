# SPDX-License-Identifier: BSD-3-Clause
"""Exact paths in space on cones of facets, and increments that end at events: a slab, a block pushed around, a ball."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import signorini as sg
from signorini.engine.solve import solve
from signorini.errors import InputError, SolveFailed
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.half_spaces import ball
from signorini.meshing.solid import extruded

ADHESIVE = {"friction": 0.3, "adhesion": 0.5}
HISTORY = [sg.Step(scale={"cut": 1.0}), sg.Step(scale={"cut": 0.2}), sg.Step(scale={"cut": 0.7}, at=[0.3])]


def cylinder(law, steps):
    """The paper's cylinder."""
    flat = zhu_cylinder(friction=0.4)
    return replace(flat, contacts=[replace(flat.contacts[0], **law)], steps=steps)


def slab(facets, law, steps):
    """The same as a slab of thickness 1 in plane strain: two pairs of half the area for one."""
    flat = cylinder(law, steps)
    (contact,) = flat.contacts
    floor = sg.Plane(point=(0.0, 0.0, 0.0), normal=(0.0, 1.0, 0.0))
    still = [sg.Support(name, u=(None, None, 0.0)) for name in ("bottom", "top")]
    return replace(
        flat,
        mesh=extruded(flat.mesh, z=[0.0, 1.0]),
        kind="3d",
        supports=[*(replace(held, u=(*held.u, None)) for held in flat.supports), *still],
        loads=[replace(load, force=(*load.force, 0.0)) for load in flat.loads],
        contacts=[replace(contact, mortar=floor, facets=facets, friction_axis=(1.0, 0.0, 0.0))],
        steps=steps,
    )


@pytest.mark.slow
@pytest.mark.parametrize(("facets", "law"), [(8, {}), (0, {}), (8, {"shear_limit": 3.0}), (0, ADHESIVE)])
def test_a_slab_goes_the_exact_path_of_plane_strain(facets, law):
    """With a corner along the loads the polygon is the law of the plane; a circle does not turn friction here."""
    plane = solve(cylinder(law, HISTORY))
    ways = {"path": "exact"} if facets else {"increments": "auto", "tolerance": 1e-12}
    space = solve(slab(facets, law, [replace(step, **ways) for step in HISTORY]))
    for two, three in zip(plane.steps, space.steps, strict=True):
        one, other = two.contacts[0], three.contacts[0]
        size = one.pressure.max()
        here = [np.flatnonzero(np.abs(other.points[:, :2] - point).max(axis=1) < 1e-9) for point in one.points]
        for pairs, p, q, s in zip(here, one.pressure, one.shear, one.slip, strict=True):
            np.testing.assert_allclose(other.pressure[pairs], p, atol=1e-8 * size)
            np.testing.assert_allclose(other.shear[pairs], [[*q, 0.0]] * len(pairs), atol=1e-8 * size)
            np.testing.assert_allclose(np.abs(other.slip[pairs, 0]), np.abs(s), atol=1e-9)
        if facets:
            loads = sorted({round(event.load_factor, 9) for event in two.events})
            assert loads == sorted({round(event.load_factor, 9) for event in three.events})
            assert {event.what for event in two.events} == {event.what for event in three.events}
            assert three.path == "exact"
        # increments that group events have the energy of their own way
        assert three.dissipation == pytest.approx(two.dissipation, rel=1e-8 if facets else 1e-2)
        assert abs(three.energy_defect) < (1e-10 if facets else 1e-3) * abs(three.work)
    asked = [instant for instant in space.steps[2].instants if instant.what == "asked"]
    assert [instant.load_factor for instant in asked] == [2.3]


def test_a_pair_that_sticks_up_to_a_limit_lets_go_at_once_as_in_the_plane():
    """Where its pressure vanishes it still holds its limit: a jump, which both follow."""
    law = {"friction": "stick", "shear_limit": 3.0}
    plane = solve(cylinder(law, HISTORY[:2]))
    space = solve(slab(8, law, [replace(step, path="exact", jump="follow") for step in HISTORY[:2]]))
    for two, three in zip(plane.steps, space.steps, strict=True):
        assert three.dissipation == pytest.approx(two.dissipation, rel=1e-8)
        assert three.released == pytest.approx(two.released, rel=1e-6, abs=1e-12)
        np.testing.assert_allclose(
            three.contacts[0].tangential_force[0], two.contacts[0].tangential_force[0], rtol=1e-9
        )
    jumps = [[i.load_factor for i in step.instants if i.what == "jump"] for step in (plane.last, space.last)]
    assert len(jumps[0]) == 1
    np.testing.assert_allclose(*jumps, rtol=1e-10)


def pushed_around(facets, **way):
    """A cube on a cube pressed, then pushed along a square path."""
    model = cubes(3)
    names = {"press": (None, None, -1.0), "x": (1.0, None, None), "y": (None, 1.0, None)}
    loads = [sg.Load("upper.top", force=f, spread="displacement", name=name) for name, f in names.items()]
    P, q = 0.01, 0.0024
    square = {"x": [q, 0.0, -q, 0.0], "y": [0.0, q, 0.0, -q]}
    steps = [sg.Step(scale={"press": P}, **way), sg.Step(scale=square, repeat=6, **way)]
    contacts = [replace(model.contacts[0], facets=facets)]
    return replace(model, supports=model.supports[:1], loads=loads, contacts=contacts, steps=steps)


def test_a_cycle_around_a_square_closes_with_its_energy():
    """Friction of facets turns from edge to edge, and cycle after cycle comes nearer to one that repeats."""
    step = solve(pushed_around(8, path="exact")).last
    assert step.path == "exact"
    assert abs(step.energy_defect) < 1e-11 * step.work
    changes = [cycle.change for cycle in step.cycles]
    assert all(later < 0.2 * earlier for earlier, later in pairwise(changes[1:])), changes
    last = step.cycles[-1]
    assert last.dissipation > 0.0
    assert last.work == pytest.approx(last.dissipation, rel=1e-10)
    assert step.certificate.facets == 8


def test_increments_come_to_the_exact_path():
    smooth = ball(n=2, size=4.0)
    model = replace(smooth, contacts=[replace(smooth.contacts[0], friction=0.3, facets=8)])
    ways = [{"path": "exact"}, {"increments": 8}, {"increments": 64}]
    exact, *found = (solve(replace(model, steps=[sg.Step(**way)])).last.contacts[0] for way in ways)
    errors = [np.abs(contact.traction - exact.traction).max() / exact.pressure.max() for contact in found]
    assert errors[1] < 0.5 * errors[0] < 0.05


@pytest.mark.slow
def test_increments_that_end_at_events_are_better_than_as_many_equal_ones():
    """A ball that grips a rigid plane: pairs drift until they touch, which no increment can know that goes beyond."""
    smooth = ball(n=2, size=4.0)
    model = replace(smooth, contacts=[replace(smooth.contacts[0], friction=0.3)])
    fine, found = (solve(replace(model, steps=[sg.Step(increments=n)])).last for n in (400, "auto"))
    equal = solve(replace(model, steps=[sg.Step(increments=found.increments)])).last
    assert found.events
    off = [np.abs(step.contacts[0].traction - fine.contacts[0].traction).max() for step in (found, equal)]
    assert off[0] < 0.3 * off[1]
    assert found.certificate.passed


def test_what_an_exact_path_in_space_needs_is_said():
    with pytest.raises(InputError, match=r"step\[0\].path: is \"exact\", but friction on the exact cone of contact"):
        replace(cubes(1), steps=[sg.Step(path="exact")])
    smooth = replace(cubes(2, friction=0.0), steps=[sg.Step(path="exact")])
    assert solve(smooth).last.path == "exact"


def test_gross_sliding_ends_an_exact_path_in_space():
    model = pushed_around(8, path="exact")
    far = replace(model, steps=[model.steps[0], sg.Step(scale={"x": 0.006, "y": 0.0}, path="exact")])
    with pytest.raises(SolveFailed, match="gross sliding") as caught:
        solve(far)
    assert caught.value.status == "jump"
