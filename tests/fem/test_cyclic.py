# SPDX-License-Identifier: BSD-3-Clause
"""Cyclic symmetry: a sector does what the whole does, in the plane and in space, with and without contact."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.fem.probe import StressProbe
from signorini.fem.stress import DeformedBodies, space_of
from signorini.gallery.sectors import SECTORS, ring_on_pads, ring_on_shaft
from signorini.plasticity.fields import nodal_fields

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


def same_stresses(whole, sector):
    """Nodes of a sector, those of its sides too, have the stresses and plastic strains that the whole has there."""
    one, part = sg.solve(whole), sg.solve(sector)
    for body in sector.bodies:
        there, own = one.stress(body.name), part.stress(body.name)
        at = nearest(whole.mesh.points[there.nodes], sector.mesh.points[own.nodes])
        assert np.abs(own.stress - there.stress[at]).max() < 1e-9 * np.abs(there.stress).max()
        probe = StressProbe.at_nodes(
            space_of(sector), sector, np.column_stack([np.zeros(len(own.nodes), int), own.nodes])[::7]
        )
        if len(sector.bodies) == 1 and not sector.yields:
            deformed = DeformedBodies.of(space_of(sector), sector, part.steps[-1].displacement)
            assert probe.stress(deformed)[0] == pytest.approx(own.stress[::7], abs=1e-12 * np.abs(own.stress).max())
    return one, part


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
    same_stresses(whole, sector)
    turned = replace(sector, cyclic_symmetries=[sg.CyclicSymmetry("end", "start", sectors=SECTORS)])
    assert sg.solve(turned).steps[-1].strain_energy == pytest.approx(part.strain_energy, rel=1e-12)


def fan(sectors):
    """A disc of triangles about its centre, a part of it of so many sixths."""
    angle = np.pi / 3.0 * np.arange(0.0, sectors + 0.25, 0.5)
    ring = angle[:-1] if sectors == SECTORS else angle
    rim = np.column_stack([np.cos(ring), np.sin(ring)])
    n = len(ring)
    one, two = np.arange(len(angle) - 1), np.arange(1, len(angle)) % n
    inner = np.column_stack([np.zeros(len(one), int), 1 + one, 1 + two])
    outer = [np.column_stack(rows) for rows in ((1 + one, 1 + n + one, 1 + n + two), (1 + one, 1 + n + two, 1 + two))]
    ends = {"rim": np.column_stack([1 + n + one, 1 + n + two])}
    if sectors < SECTORS:
        ends |= {"start": np.array([[0, 1], [1, 1 + n]]), "end": np.array([[0, n], [n, 2 * n]])}
    return sg.Mesh(
        points=np.vstack([np.zeros((1, 2)), rim, 2.0 * rim]),
        cells={"triangle": np.vstack([inner, *outer])},
        bodies={"disc": np.arange(3 * len(one))},
        boundaries=ends,
    )


def test_stresses_on_the_axis_are_those_of_all_sectors():
    whole = sg.Model(
        fan(SECTORS),
        bodies=[sg.Body("disc", STEEL)],
        supports=[sg.Support("rim", u=(0.0, 0.0))],
        loads=[sg.Load("disc", centrifugal=0.5)],
    )
    part = replace(whole, mesh=fan(1), cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=SECTORS)])
    same_stresses(whole, part)


def test_plastic_strains_on_the_sides_are_those_of_the_whole():
    yields = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(0.9, hardening=20.0))
    whole = sg.Model(
        ring(360.0, 24),
        bodies=[sg.Body("ring", yields)],
        supports=[sg.Support("inner", u=(0.0, 0.0))],
        loads=loads("")[:2],
        steps=[sg.Step(increments=1)],
    )
    sector = replace(whole, mesh=ring(60.0, 4), cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=SECTORS)])
    one, part = same_stresses(whole, sector)
    at = nearest(whole.mesh.points, sector.mesh.points)
    fields = [nodal_fields(space_of(each.model), each.model, each.end.state.plastic)[0].strain for each in (one, part)]
    assert np.abs(fields[1] - fields[0][at]).max() < 1e-6 * np.abs(fields[0]).max()
    assert np.abs(fields[0]).max() > 1e-4


def test_a_sector_with_contact_and_friction_is_the_whole():
    whole, sector = (sg.solve(ring_on_pads(whole=every)) for every in (True, False))
    for one, part in zip(whole.steps, sector.steps, strict=True):
        assert part.contacts[0].pressure == pytest.approx(one.contacts[0].pressure, rel=1e-9, abs=1e-12)
        assert part.contacts[0].traction == pytest.approx(one.contacts[0].traction, rel=1e-9, abs=1e-9)
        assert SECTORS * part.strain_energy == pytest.approx(one.strain_energy, rel=1e-9)
        assert SECTORS * part.dissipation == pytest.approx(one.dissipation, rel=1e-9, abs=1e-15)
    assert part.dissipation > 0.0


def beside_the_whole(whole, sector, tolerance=1e-9):
    """A sector with a contact that its sides cut, whose steps are those of the whole."""
    one, part = sg.solve(whole), sg.solve(sector)
    for a, b in zip(one.steps, part.steps, strict=True):
        there, own = a.contacts[0], b.contacts[0]
        assert len(there.pressure) == SECTORS * len(own.pressure)
        at = nearest(there.points, own.points)
        assert own.pressure == pytest.approx(there.pressure[at], abs=tolerance * there.pressure.max())
        size = tolerance * there.pressure.max()
        assert np.linalg.norm(own.traction, axis=-1) == pytest.approx(
            np.linalg.norm(there.traction[at], axis=-1), abs=size
        )
        assert own.gap == pytest.approx(there.gap[at], abs=1e-11)
        assert own.area == pytest.approx(there.area[at], rel=1e-11)
        assert SECTORS * b.strain_energy == pytest.approx(a.strain_energy, rel=tolerance)
        assert SECTORS * b.dissipation == pytest.approx(a.dissipation, rel=tolerance, abs=1e-15)
        assert b.certificate.passed
    return part


def test_a_contact_that_a_sector_cuts_is_that_of_the_whole():
    part = beside_the_whole(ring_on_shaft(whole=True), ring_on_shaft(whole=False))
    own = part.steps[-1].contacts[0]
    at = np.linalg.norm(own.points - [1.0, 0.0], axis=1) < 1e-12  # where the sector is cut
    assert own.status[at] == ["slip"]
    assert {"stick", "slip"} == set(own.status)
    assert part.steps[-1].dissipation > 0.0


@pytest.mark.parametrize(
    "given",
    [{"coupling": "node-to-segment"}, {"side": "coarser"}, {"gap": "zero", "interference": "0.002 + 0.001*x^2"}],
)
def test_however_its_pairs_are_made(given):
    """A crown is that of a sector in every other one: the whole has it from a function of the angle in its sector."""
    whole, sector = (ring_on_shaft(whole=every) for every in (True, False))
    contacts = [replace(sector.contacts[0], **given)]
    if "gap" in given:

        def crown(at):
            angle = np.arctan2(at[:, 1], at[:, 0]) % (2.0 * np.pi / SECTORS)
            angle[angle > 2.0 * np.pi / SECTORS - 1e-9] = 0.0
            return 0.002 + 0.001 * np.cos(angle) ** 2

        given = {"gap": "zero", "interference": crown}
    whole = replace(whole, contacts=[replace(whole.contacts[0], **given)])
    beside_the_whole(whole, replace(sector, contacts=contacts))


def test_sides_turn_onto_each_other_one_way_or_the_other():
    sector = ring_on_shaft(whole=False)
    one, other = sector.cyclic_symmetries
    turned = replace(sector, cyclic_symmetries=[one, replace(other, first=other.second, second=other.first)])
    first, second = (sg.solve(model).steps[-1] for model in (sector, turned))
    assert second.strain_energy == pytest.approx(first.strain_energy, rel=1e-12)
    there = replace(other, point=(1e-3, 0.0))
    with pytest.raises(sg.InputError, match=r"cyclic_symmetry\[1\]: node 26 of 'shaft.start'"):
        sg.solve(replace(sector, cyclic_symmetries=[one, there]))


def hub(obstacle, **given):
    return sg.Model(
        ring(60.0, 4),
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("outer", u=(0.0, 0.0))],
        contacts=[sg.Contact("inner", obstacle, **given)],
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=6)],
    )


def test_an_obstacle_is_the_same_in_every_sector_or_told():
    sector = hub(sg.Circle((0.0, 0.0), 1.0), interference=0.01)
    whole = replace(sector, mesh=ring(360.0, 24), cyclic_symmetries=[])
    beside_the_whole(whole, sector)
    said = r"contact\[0\].mortar: is reached where the sector is cut, at nodes 1 and 17, and is not the same in every"
    with pytest.raises(sg.InputError, match=said):
        sg.solve(hub(sg.Circle((0.1, 0.0), 0.9)))


def test_what_does_not_go_with_a_contact_that_is_cut_is_told():
    sector = ring_on_shaft(whole=False)
    for given, said in (
        ({"sliding": "finite"}, "sliding: goes with contacts that no side of a cyclic sector cuts"),
        ({"wear": sg.Wear(1e-9)}, "wear: goes with contacts that no side of a cyclic sector cuts"),
    ):
        with pytest.raises(sg.InputError, match=rf"contact\[0\]\.{said}"):
            sg.solve(replace(sector, contacts=[replace(sector.contacts[0], **given)]))


@pytest.mark.slow
def test_contact_in_space_that_a_sector_cuts_is_that_of_the_whole():
    """About another axis, on faces that do not match, tied or slipping, in increments: events are near each other."""

    def made(whole, friction, press):
        flat = ring_on_shaft(whole=whole)
        tilt = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        mesh = sg.extruded(flat.mesh, z=[0.0, 0.4])
        return sg.Model(
            replace(mesh, points=mesh.points @ tilt.T + [3.0, -1.0, 2.0]),
            bodies=flat.bodies,
            supports=[sg.Support("shaft.inner", u=(0.0, 0.0, 0.0))],
            loads=[sg.Load("ring.outer", pressure=lambda at: lobes(at[:, 1] + 1.0, at[:, 2] - 2.0), name="lobes")],
            contacts=[sg.Contact("ring.inner", "shaft.outer", friction=friction, **press)],
            cyclic_symmetries=[
                replace(one, axis=(1.0, 0.0, 0.0), point=(3.0, -1.0, 2.0)) for one in flat.cyclic_symmetries
            ],
        )

    def lobes(x, y):
        return 0.1 + 0.1 * np.sin(SECTORS * np.arctan2(y, x) + 4.4)

    pressed = {"gap": "zero", "interference": 0.002}  # gaps of the drawn sides of the whole repeat to 1e-7 only
    for friction, press in ((0.05, pressed), ("tied", {})):
        beside_the_whole(made(True, friction, press), made(False, friction, press))


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


def test_sides_that_name_corners_alone_have_the_nodes_between_them_too():
    flat = sg.annulus(inner=1.0, outer=2.0, n_radial=2, n_angular=4, angle=60.0, centre=(0.0, 0.0), cells="quad8")
    corners = replace(flat, boundaries={name: flat.facets(name)[0][:, :2] for name in flat.boundaries})
    energy = [
        sg.solve(replace(ring_of(mesh), loads=[sg.Load("outer", pressure=teeth)])).last.strain_energy
        for mesh in (flat, corners)
    ]
    assert energy[1] == pytest.approx(energy[0], rel=1e-12)


def ring_of(mesh):
    return sg.Model(
        mesh,
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("inner", u=(0.0, 0.0))],
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=SECTORS)],
    )


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
