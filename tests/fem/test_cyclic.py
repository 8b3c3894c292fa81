# SPDX-License-Identifier: BSD-3-Clause
"""Cyclic symmetry: a sector does what the whole does, in the plane and in space, with and without contact."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.gallery.sectors import SECTORS, ring_on_pads

STEEL = sg.Elastic(E=200.0, nu=0.3, density=2.0)


def ring(angle, n, inner=1.0, outer=2.0):
    return sg.annulus(inner=inner, outer=outer, n_radial=3, n_angular=n, angle=angle, centre=(0.0, 0.0))


def teeth(at):
    """A pressure that repeats with the sectors and is no mirror image of itself."""
    angle = np.arctan2(at[:, 1], at[:, 0])
    return 1.0 + 0.5 * np.sin(SECTORS * angle) + 0.3 * np.cos(2 * SECTORS * angle)


def spokes(at):
    """A traction around, which repeats too."""
    return 0.2 * np.sin(SECTORS * np.arctan2(at[:, 1], at[:, 0]))[:, None] * np.column_stack([-at[:, 1], at[:, 0]])


def loads(on):
    return [
        sg.Load(f"{on}outer", pressure=teeth, name="teeth"),
        sg.Load(f"{on}outer", traction=spokes, name="spokes"),
        sg.Load(on.rstrip(".") or "ring", centrifugal=0.5, name="spin"),
    ]


def nearest(points, at):
    return np.array([np.argmin(np.linalg.norm(points - x, axis=1)) for x in at])


def test_a_sector_of_a_ring_is_the_ring():
    whole = sg.Model(
        ring(360.0, 48),
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("inner", u=(0.0, 0.0))],
        loads=loads(""),
    )
    sector = replace(
        whole,
        mesh=ring(60.0, 8),
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=SECTORS)],
    )
    one, part = sg.solve(whole).steps[-1], sg.solve(sector).steps[-1]
    at = nearest(whole.mesh.points, sector.mesh.points)
    assert part.displacement == pytest.approx(one.displacement[at], abs=1e-11 * np.abs(one.displacement).max())
    assert SECTORS * part.strain_energy == pytest.approx(one.strain_energy, rel=1e-11)
    turned = replace(sector, cyclic_symmetries=[sg.CyclicSymmetry("end", "start", sectors=SECTORS)])
    assert sg.solve(turned).steps[-1].strain_energy == pytest.approx(part.strain_energy, rel=1e-12)


def test_a_sector_with_contact_and_friction_is_the_whole():
    whole, sector = (sg.solve(ring_on_pads(whole=every)) for every in (True, False))
    for one, part in zip(whole.steps, sector.steps, strict=True):
        assert part.contacts[0].pressure == pytest.approx(one.contacts[0].pressure, rel=1e-9, abs=1e-12)
        assert part.contacts[0].traction == pytest.approx(one.contacts[0].traction, rel=1e-9, abs=1e-9)
        assert SECTORS * part.strain_energy == pytest.approx(one.strain_energy, rel=1e-9)
        assert SECTORS * part.dissipation == pytest.approx(one.dissipation, rel=1e-9, abs=1e-15)
    assert part.dissipation > 0.0


def test_a_contact_that_a_sector_cuts_is_refused():
    meshes = {"hub": ring(60.0, 8), "shaft": ring(60.0, 8, inner=0.4, outer=1.0)}
    model = sg.Model(
        sg.join(meshes),
        bodies=[sg.Body("hub", STEEL), sg.Body("shaft", STEEL)],
        supports=[sg.Support("shaft.inner", u=(0.0, 0.0))],
        contacts=[sg.Contact("hub.inner", "shaft.outer", interference=0.002)],
        cyclic_symmetries=[sg.CyclicSymmetry(f"{name}.start", f"{name}.end", sectors=6) for name in meshes],
    )
    with pytest.raises(sg.InputError, match=r"reaches 'hub\.start' or 'hub\.end' at node 1"):
        sg.solve(model)
    shaft = replace(model, cyclic_symmetries=model.cyclic_symmetries[1:])  # whichever side turns out to be the coarser
    shaft = replace(shaft, contacts=[replace(model.contacts[0], side="coarser")])
    with pytest.raises(sg.InputError, match=r"contact\[0\]\.mortar: reaches 'shaft\.start' or 'shaft\.end' at node"):
        sg.solve(shaft)


def test_in_space_about_an_axis_of_its_own():
    sectors = 6
    solid = sg.extruded(ring(60.0, 4), z=np.linspace(0.0, 0.5, 3))
    spun = sg.Model(
        solid,
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("inner", u=(0.0, 0.0, 0.0))],
        loads=[sg.Load("ring", centrifugal=0.5, name="spin"), sg.Load("outer", pressure=0.3, name="push")],
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=sectors)],
    )
    flat = sg.solve(spun).steps[-1]
    # the same with the axis along another line
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    away = np.array([3.0, -1.0, 2.0])
    there = replace(
        spun,
        mesh=replace(solid, points=solid.points @ turn.T + away),
        loads=[replace(spun.loads[0], axis=tuple(turn[:, 2]), centre=tuple(away)), spun.loads[1]],
        cyclic_symmetries=[
            sg.CyclicSymmetry("start", "end", sectors=sectors, axis=tuple(turn[:, 2]), point=tuple(away))
        ],
    )
    moved = sg.solve(there).steps[-1]
    assert moved.displacement == pytest.approx(flat.displacement @ turn.T, abs=1e-12 * np.abs(flat.displacement).max())
    radius = np.linalg.norm(solid.points[:, :2], axis=1)
    radial = (flat.displacement[:, :2] * solid.points[:, :2]).sum(axis=1) / radius
    around = flat.displacement[:, 1] * solid.points[:, 0] - flat.displacement[:, 0] * solid.points[:, 1]
    assert np.ptp(radial[(radius > 1.99) & (solid.points[:, 2] == 0.0)]) < 1e-6 + 0.05 * np.abs(radial).max()
    assert np.abs(around).max() < 0.05 * np.abs(radial).max()


def test_what_does_not_repeat_is_told():
    base = sg.Model(ring(60.0, 8), bodies=[sg.Body("ring", STEEL)], supports=[sg.Support("inner", u=(0.0, 0.0))])
    five = replace(base, cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=5)])
    with pytest.raises(sg.InputError, match=r"cyclic_symmetry\[0\]: node \d+ of 'start', turned by 1/5 of a full turn"):
        sg.solve(five)
    arcs = replace(base, cyclic_symmetries=[sg.CyclicSymmetry("start", "outer", sectors=6)])
    with pytest.raises(sg.InputError, match="'start' has 4 nodes and 'outer' 9"):
        sg.solve(arcs)
    with pytest.raises(sg.InputError, match="unknown boundary"):
        replace(base, cyclic_symmetries=[sg.CyclicSymmetry("strt", "end", sectors=6)])
    with pytest.raises(sg.InputError, match="sectors: is 1; expected a whole number >= 2"):
        sg.CyclicSymmetry("start", "end", sectors=1)


def test_a_sector_that_turns_as_a_whole_is_named():
    free = sg.Model(
        ring(60.0, 8),
        bodies=[sg.Body("ring", STEEL)],
        loads=[sg.Load("outer", pressure=1.0)],
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=6)],
    )
    with pytest.raises(sg.InputError, match=r"body 'ring' can (rotate|turn)"):
        sg.solve(free)


DECK = """\
kind = "plane strain"
[mesh]
generator = "annulus"
inner = 1.0
outer = 2.0
n_radial = 2
n_angular = 4
angle = 60.0
[material.steel]
E = 200.0
nu = 0.3
[[body]]
name = "ring"
material = "steel"
[[support]]
on = "inner"
u = [0.0, 0.0]
[[load]]
on = "outer"
pressure = 1.0
[[cyclic_symmetry]]
first = "start"
second = "end"
sectors = 6
"""


def test_a_deck_has_sectors(tmp_path, capsys):
    deck, again = tmp_path / "deck.toml", tmp_path / "again.toml"
    deck.write_text(DECK)
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert main(["convert", str(deck), "-o", str(again)]) == 0
    one, other = (sg.solve(sg.read(path)).steps[-1].strain_energy for path in (deck, again))
    assert one == pytest.approx(other, rel=1e-12)
    deck.write_text(DECK.replace("sectors = 6", "sectors = 7"))
    assert main(["check", str(deck)]) == 2
    assert "cyclic_symmetry[0]: node" in capsys.readouterr().err
