# SPDX-License-Identifier: BSD-3-Clause
"""Meshed bodies that turn while they slide and roll: each in a frame of its own."""

from __future__ import annotations

from dataclasses import replace
from math import atan, cos, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.rolling import block_on_slope, pushed_disc
from signorini.output.fields import Fields

STEEL = sg.Elastic(E=200.0, nu=0.3)


def turned(vectors: np.ndarray, degrees: float) -> np.ndarray:
    """Rows (k, 2) turned counterclockwise."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.asarray(vectors, float) @ np.array([[c, s], [-s, c]])


def shrunk_ring(degrees: float, friction: float = 0.3) -> sg.Model:
    """A ring that nothing but its press fit holds, on a shaft that turns."""
    shaft = sg.annulus(inner=0.5, outer=1.0, n_radial=2, n_angular=24)
    ring = sg.annulus(inner=1.0, outer=1.6, n_radial=2, n_angular=16)
    return sg.Model(
        mesh=sg.join({"shaft": shaft, "ring": ring}),
        kind="plane strain",
        bodies=[sg.Body("shaft", STEEL), sg.Body("ring", STEEL)],
        supports=[sg.Support("hub", u=(0.0, 0.0, radians(degrees)), name="turn")],
        rigid_bodies=[sg.RigidBody("hub", on="shaft.inner", point=(0.0, 0.0))],
        contacts=[
            sg.Contact("ring.inner", "shaft.outer", friction=friction, sliding="finite", interference=0.002, name="fit")
        ],
        steps=[
            sg.Step(name="press", scale={"turn": 0.0}),
            sg.Step(name="settle", scale={"turn": 0.05}),  # pairs are those of what pressing has moved
            sg.Step(name="turn", scale={"turn": 1.0}),
        ],
    )


def roller(degrees: float = 0.0, *, angle: float = -0.05, cells: int = 48) -> sg.Model:
    """A ring, R 2, that its hub presses on a bed and turns; all of it at an angle to the axes."""
    ring = sg.annulus(inner=1.0, outer=2.0, n_radial=2, n_angular=cells, centre=(0.0, 2.0))
    bed = sg.rectangle(x=np.linspace(-2.0, 2.0, 21), y=np.array([-1.5, -0.7, -0.3, 0.0]))
    mesh = sg.join({"ring": ring, "bed": bed})
    mesh = replace(mesh, points=turned(mesh.points, degrees))
    return sg.Model(
        mesh=mesh,
        kind="plane strain",
        bodies=[sg.Body("ring", STEEL), sg.Body("bed", STEEL)],
        supports=[sg.Support("bed.bottom", u=(0.0, 0.0)), sg.Support("hub", u=(None, None, angle), name="turn")],
        rigid_bodies=[sg.RigidBody("hub", on="ring.inner", point=tuple(turned([0.0, 2.0], degrees)))],
        loads=[sg.Load(on="hub", force=(*turned([0.0, -1.0], degrees), None), name="press")],
        contacts=[sg.Contact("ring.outer", "bed.top", friction=0.5, sliding="finite", name="tread")],
        steps=[
            sg.Step(name="press", scale={"press": 1.0, "turn": 0.0}),
            sg.Step(name="roll", scale={"press": 1.0, "turn": 1.0}),
        ],
    )


@pytest.mark.slow
def test_a_press_fit_that_turns_keeps_what_it_bears() -> None:
    """Pressures, tractions, energy and stresses turn along, whatever the angle; nothing is set free, nothing rubs."""
    found = [sg.solve(shrunk_ring(degrees)) for degrees in (20.0, 90.0)]
    one, two = (solution.steps[-1] for solution in found)
    peak = two.contacts[0].pressure.max()
    assert np.abs(one.contacts[0].pressure - two.contacts[0].pressure).max() < 1e-5 * peak
    assert np.abs(one.contacts[0].traction - two.contacts[0].traction).max() < 1e-5 * peak
    assert np.abs(turned(one.contacts[0].normals, 70.0) - two.contacts[0].normals).max() < 1e-7
    assert two.strain_energy == pytest.approx(one.strain_energy, rel=1e-6)
    points = found[0].model.mesh.points
    assert np.abs(turned(points + one.displacement, 70.0) - points - two.displacement).max() < 1e-8
    for step in (one, two):
        assert step.certificate.passed
        assert abs(step.energy_defect) < 1e-12 * step.strain_energy
        assert abs(step.released) < 1e-7 * step.strain_energy
        assert step.contacts[0].dissipation == 0.0
        assert not any("strains or turns" in note for note in step.notes)
    stress, other = (Fields(of.model).at(step) for of, step in zip(found, (one, two), strict=True))
    assert np.abs(stress.von_mises - other.von_mises).max() < 1e-5 * other.von_mises.max()
    tensor, after = (of.stress[:, [[0, 3], [3, 1]]] for of in (stress, other))
    c, s = cos(radians(70.0)), sin(radians(70.0))
    R = np.array([[c, -s], [s, c]])
    assert np.abs(R @ tensor @ R.T - after).max() < 1e-5 * other.von_mises.max()


@pytest.mark.slow
def test_a_meshed_ring_rolls() -> None:
    """Without slip: as far as its facets are long; all of it at an angle to the axes does the same to rounding."""
    found = {degrees: sg.solve(roller(degrees, angle=-0.02)) for degrees in (0.0, 30.0, 90.0)}
    roll = found[0.0].steps[-1]
    hub, contact = roll.rigid_bodies["hub"], roll.contacts[0]
    perimeter = sin(pi / 48) / (pi / 48)
    assert hub.displacement[0] == pytest.approx(0.02 * 2.0 * perimeter, rel=5e-3)  # a part of a facet
    assert contact.forces.sum(axis=0) == pytest.approx([0.0, 1.0], abs=1e-9)
    assert (contact.status != "slip").all()
    assert roll.certificate.passed
    assert abs(roll.energy_defect) < 1e-12 * roll.strain_energy
    for degrees in (30.0, 90.0):
        other = found[degrees].steps[-1]
        assert other.rigid_bodies["hub"].displacement == pytest.approx(turned(hub.displacement, degrees), abs=1e-9)
        assert np.abs(other.contacts[0].pressure - contact.pressure).max() < 1e-7 * contact.pressure.max()
        assert np.abs(other.contacts[0].traction - contact.traction).max() < 1e-7 * contact.pressure.max()


def test_a_hub_in_space_bears_what_contact_and_loads_leave() -> None:
    """A block that its hub turns under a wind: forces are those of space, whatever the axes of its frame."""
    top = sg.box(x=np.linspace(-0.5, 0.5, 3), y=np.linspace(-0.5, 0.5, 3), z=np.linspace(0.0, 1.0, 3))
    bed = sg.box(x=np.linspace(-1.5, 1.5, 5), y=np.linspace(-1.5, 1.5, 5), z=np.linspace(-0.5, 0.0, 2))
    model = sg.Model(
        mesh=sg.join({"top": top, "bed": bed}),
        kind="3d",
        bodies=[sg.Body("top", STEEL), sg.Body("bed", STEEL)],
        supports=[
            sg.Support("bed.bottom", u=(0.0, 0.0, 0.0)),
            sg.Support("hub", u=(0.0, 0.0, None, 0.0, 0.0, 0.3), name="turn"),
        ],
        rigid_bodies=[sg.RigidBody("hub", on="top.top", point=(0.0, 0.0, 1.0))],
        loads=[
            sg.Load(on="hub", force=(None, None, -1.0, None, None, None), name="press"),
            sg.Load(on="top", body_force=(0.2, 0.0, -0.1), name="wind"),
        ],
        contacts=[sg.Contact("top.bottom", "bed.top", friction=0.3, sliding="finite", name="c")],
        steps=[sg.Step(scale={"press": 1.0, "wind": 1.0, "turn": 1.0}, increments=2)],
    )
    step = sg.solve(model).steps[-1]
    force, hub = step.contacts[0].forces.sum(axis=0), step.rigid_bodies["hub"]
    assert force + hub.force + [0.2, 0.0, -0.1] == pytest.approx([0.0] * 3, abs=1e-10)
    assert step.reactions["turn"][:2] == pytest.approx(hub.force[:2], abs=1e-12)
    assert hub.rotation == pytest.approx([0.0, 0.0, 0.3])
    lever = np.array([0.0, 0.0, 1.0]) + hub.displacement
    moment = step.contacts[0].moment(lever) + step.reactions["turn"][3:] + np.cross([0.0, 0.0, -0.5], [0.2, 0.0, -0.1])
    assert moment == pytest.approx([0.0] * 3, abs=2e-3)  # of what bodies give way by


@pytest.mark.slow
def test_a_roll_that_is_cut_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    """What its frame is read off is part of the state."""
    model = roller(angle=-0.01)
    three = replace(model, steps=[*model.steps, sg.Step(name="on", scale={"press": 1.0, "turn": 1.5})])
    whole, first = sg.solve(three), sg.solve(model)
    first.save_state(tmp_path / "first.npz")
    second = sg.solve(replace(three, steps=three.steps[2:]), start=tmp_path / "first.npz")
    for name in ("pressure", "traction", "slip", "normals"):
        assert np.array_equal(getattr(whole.steps[-1].contacts[0], name), getattr(second.steps[-1].contacts[0], name))
    assert np.array_equal(whole.steps[-1].displacement, second.steps[-1].displacement)


@pytest.mark.slow
def test_a_block_slides_off_a_bed_that_is_tilted() -> None:
    """Where the slope is the coefficient of friction, to a stride and its pairs; nothing is followed beyond."""
    with pytest.raises(sg.SolveFailed, match=r"body 'block' can .* away along a rigid motion") as caught:
        sg.solve(block_on_slope(angles=(0.2,), friction=0.15))
    assert caught.value.status == "no_equilibrium"
    step = caught.value.solution.steps[-1]
    assert step.rigid_bodies["hub"].rotation == pytest.approx(atan(0.15), abs=5e-4)
    assert step.contacts[0].forces.sum(axis=0) == pytest.approx([0.0, 0.4 * 9.81], rel=5e-3, abs=3e-2)


def test_a_disc_that_is_pushed_at_its_hub_rolls() -> None:
    """As far as its arc is long; the meshed flat is the nonmortar side."""
    step = sg.solve(pushed_disc(cells=30, force=0.005, facets=2.0)).steps[-1]
    hub = step.rigid_bodies["hub"]
    assert hub.displacement[0] == pytest.approx(-hub.rotation, rel=1e-6)
    assert abs(step.energy_defect) < 1e-9 * step.strain_energy


def test_a_body_that_is_turned_in_fixed_directions_is_refused() -> None:
    """Its name, how far it has turned, and what would do."""
    model = roller()
    lifted = model.mesh.points[model.mesh.nodes_of("ring.inner")][:, 0].argmax()
    node = tuple(model.mesh.points[model.mesh.nodes_of("ring.inner")][lifted])
    other = (-node[0], node[1])
    held = replace(
        model,
        rigid_bodies=[],
        supports=[
            model.supports[0],
            sg.Support(node, u=(0.0, -0.2), name="turn"),
            sg.Support(other, u=(None, 0.2), name="other"),
        ],
        loads=[sg.Load(on="ring", body_force=(0.0, -0.1), name="press")],
        steps=[sg.Step(scale={"press": 1.0, "turn": 1.0, "other": 1.0})],
    )
    with pytest.raises(sg.SolveFailed, match=r"body 'ring' has turned by 0\.0.* in directions of space"):
        sg.solve(held)
