# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that a gap keeps from what will hold them: histories begin where they touch."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.blocks import dragged_block

SOFT = sg.Elastic(E=1000.0, nu=0.3)


def stack(gap, kind="plane strain", **step):
    """A block on a block on a block that is held, each ``gap`` above the one below; a force presses down."""
    names, meshes = ("low", "middle", "high"), []
    for k in range(3):
        x, y = np.linspace(0.0, 4.0 - k, 9 - 2 * k), np.linspace(0.0, 1.0, 4) + k * (1.0 + gap)
        # on quarters of it two planes of symmetry let a block fall alone
        solid = {"x": x[::2], "y": x[::2], "z": y[::3]}
        meshes.append(sg.box(**solid) if kind == "space" else sg.rectangle(x=x, y=y))
    held = {"space": (0.0, 0.0, 0.0), "axisymmetric": (None, 0.0)}.get(kind, (0.0, 0.0))
    return sg.Model(
        sg.join(dict(zip(names, meshes, strict=True))),
        **({} if kind == "space" else {"kind": kind}),
        bodies=[sg.Body(name, SOFT) for name in names],
        supports=[sg.Support("low.bottom", u=held)],
        loads=[sg.Load("high.top", force=(0.0,) * (len(held) - 1) + (-5.0,), name="press")],
        contacts=[
            sg.Contact("middle.bottom", "low.top", friction=0.2, name="lower"),
            sg.Contact("high.bottom", "middle.top", friction=0.2, name="upper"),
        ],
        steps=[sg.Step(name="press", **step)],
    )


def same(one, other, size):
    for contact, expected in zip(one.contacts, other.contacts, strict=True):
        np.testing.assert_allclose(contact.pressure, expected.pressure, atol=size * expected.pressure.max())
        np.testing.assert_allclose(contact.traction, expected.traction, atol=size * expected.pressure.max())
        np.testing.assert_allclose(contact.slip, expected.slip, atol=size)
        np.testing.assert_allclose(contact.worn, expected.worn, atol=size * expected.worn.max())
    np.testing.assert_allclose(one.work, other.work, rtol=size)
    np.testing.assert_allclose(one.dissipation, other.dissipation, rtol=size)
    np.testing.assert_allclose(one.energy_defect, other.energy_defect, atol=size * other.work)


@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric", "space"])
@pytest.mark.parametrize("increments", [None, 2])
def test_a_stack_with_gaps_is_the_stack_without(kind, increments):
    """One body after the other approaches and turns as it lands; stresses, slips, work know nothing of it."""
    apart, touching = (sg.solve(stack(gap, kind, increments=increments)).last for gap in (0.125, 0.0))
    assert apart.path == touching.path
    same(apart, touching, 1e-8)
    begun = apart.instants[0]
    assert (begun.what, begun.load_factor, begun.work) == ("approach", 0.0, 0.0)
    assert sum("before contact can hold it" in note for note in apart.notes) == 2
    if kind == "axisymmetric":  # no way to turn
        names = {"middle": 0.125, "high": 0.25}
        assert apart.notes == tuple(
            f"step 'press': body '{name}' approaches by {way} along -y before contact can hold it"
            for name, way in names.items()
        )
        lowered = touching.displacement[:, 1] - apart.displacement[:, 1]
        np.testing.assert_allclose(lowered, np.repeat([0.0, 0.125, 0.25], [36, 28, 20]), atol=1e-10)


@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric", "space"])
def test_a_stack_that_overlaps_is_the_stack_that_touches(kind):
    """Nothing holds the upper bodies down, so they rise out of each other before anything presses."""
    overlapping, touching = (sg.solve(stack(gap, kind)).last for gap in (-0.05, 0.0))
    same(overlapping, touching, 1e-8)
    begun = overlapping.instants[0]
    assert (begun.what, begun.load_factor, begun.work) == ("approach", 0.0, 0.0)
    raised = overlapping.displacement[:, -1] - touching.displacement[:, -1]
    np.testing.assert_allclose(np.unique(raised.round(8)), [0.0, 0.05, 0.1])


def between_walls(overlap, clearance, load):
    """A block between two walls, into the lower of which it reaches."""
    return sg.Model(
        sg.rectangle(nx=6, ny=2),
        bodies=[sg.Body("block", SOFT)],
        loads=[sg.Load(side, traction=(0.0, load / 2.0), name=side) for side in ("bottom", "top")],
        contacts=[
            sg.Contact("bottom", sg.Plane((0.0, overlap), (0.0, 1.0)), friction=0.3, name="low"),
            sg.Contact("top", sg.Plane((0.0, 1.0 + overlap + clearance), (0.0, -1.0)), friction=0.3, name="high"),
        ],
        steps=[sg.Step(name="press", path="exact")],
    )


@pytest.mark.parametrize("load", [-5.0, 5.0])
def test_a_block_rises_out_of_one_wall_towards_another(load):
    """Only where it fits between both: otherwise they squeeze it."""
    raised, touching = (sg.solve(between_walls(overlap, 0.01, load)).last for overlap in (0.01, 0.0))
    same(raised, touching, 1e-8)
    squeezed = sg.solve(between_walls(0.01, -0.02, load)).last
    assert squeezed.instants[0].what != "approach"
    assert all(contact.pressure.min() > 0.0 for contact in squeezed.contacts)


def cylinder(turn, *, above=True, **step):
    """Half a disk on a rigid plane, turned about its centre; at y = 0, or where its lowest node is."""
    mesh = sg.half_disk(radius=8.0, contact_length=4.0, contact_spacing=0.5, refine=2)
    c, s = np.cos(turn), np.sin(turn)
    mesh = replace(mesh, points=(mesh.points - [0.0, 8.0]) @ [[c, s], [-s, c]] + [0.0, 8.0])
    place = 0.0 if above else float(mesh.points[:, 1].min())
    return sg.Model(
        mesh,
        bodies=[sg.Body("disk", sg.Elastic(E=200.0, nu=0.3))],
        supports=[sg.Support("cut", u=(0.0, None))],
        loads=[sg.Load("cut", force=(0.0, -156.0))],
        contacts=[sg.Contact("arc", sg.Plane((0.0, place), (0.0, 1.0)), friction=0.05, name="foundation")],
        steps=[sg.Step(**step)],
    )


@pytest.mark.slow
def test_a_cylinder_that_no_node_meets_at_its_pole_has_an_exact_path():
    """It begins where the lowest nodes touch, increments converge to it, and a node at the pole changes little."""
    half_a_cell = 0.5 * 0.25 / 8.0
    exact = sg.solve(cylinder(half_a_cell)).last
    assert exact.path == "exact"
    assert exact.notes == ("step 1: body 'disk' approaches by 0.0009765 along -y before contact can hold it",)
    same(exact, sg.solve(cylinder(half_a_cell, above=False)).last, 1e-8)
    pole = sg.solve(cylinder(0.0)).last
    np.testing.assert_allclose(exact.dissipation, pole.dissipation, rtol=0.05)
    off = [
        sg.solve(cylinder(half_a_cell, increments=number)).last.dissipation / exact.dissipation - 1.0
        for number in (10, 100)
    ]
    assert 0.0 < off[1] < 0.1 * off[0]


def test_a_block_that_falls_starts_from_where_it_touches():
    """A gap that a contact is given counts as one of the mesh; the exact path has no jump in it."""
    still = replace(dragged_block(), steps=[sg.Step(name="press", path="exact")])
    falling = replace(still, contacts=[replace(still.contacts[0], gap=0.01)])
    same(sg.solve(falling).last, sg.solve(still).last, 1e-8)


def test_bodies_that_loads_pull_away_are_named_with_their_motion():
    model = replace(stack(0.125), loads=[sg.Load("high.top", force=(0.0, 5.0), name="press")])
    with pytest.raises(sg.SolveFailed, match=r"body 'high' can move along y: .*no equilibrium"):
        sg.solve(model)


def test_a_load_that_turns_carries_a_block_from_wall_to_wall():
    """Through no load the path goes on from the other wall; every cycle is the same, and nothing is set free."""
    walls = {"floor": ((0.0, -0.25), (0.0, 1.0), "bottom"), "roof": ((0.0, 1.5), (0.0, -1.0), "top")}
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=6, ny=3),
        bodies=[sg.Body("block", SOFT)],
        loads=[sg.Load("top", force=(0.0, -5.0), name="press")],
        contacts=[sg.Contact(on, sg.Plane(at, n), friction=0.2, name=name) for name, (at, n, on) in walls.items()],
        steps=[sg.Step(scale={"press": [1.0, -1.0]}, repeat=2, path="exact")],
    )
    step = sg.solve(model).last
    ways = [note for note in step.notes if "approaches" in note]
    assert [note.split(": ")[0] for note in ways] == ["step 1", *(f"step 1 at {at}.5%" for at in (37, 62, 87))]
    assert ways[0].endswith("approaches by 0.25 along -y before contact can hold it")
    assert all("approaches by 0.75 along" in note for note in ways[1:])
    assert step.cycles[0].dissipation > 0.0
    np.testing.assert_allclose(step.cycles[1].dissipation, step.cycles[0].dissipation, rtol=1e-9)
    work = 5.0 * 0.75  # of the load on the way from wall to wall, whose rounding the balance has
    np.testing.assert_allclose([step.released, step.energy_defect], 0.0, atol=1e-12 * work)


@pytest.mark.parametrize("kind", ["plane strain", pytest.param("space", marks=pytest.mark.slow)])
def test_a_body_that_nothing_touches_or_loads_rests_until_a_step_loads_it(kind):
    """It is not there as far as the others feel; an unloaded contact is open, has not slipped and did not grow."""
    apart, touching = stack(0.125, kind), stack(0.0, kind)
    down = apart.loads[0].force

    def steps(model):
        loads = [sg.Load("middle.top", force=down, name="first"), *model.loads]
        schedule = [sg.Step(name="first", scale={"first": 1.0}), sg.Step(name="press", scale={"press": 1.0})]
        return sg.solve(replace(model, loads=loads, steps=schedule)).steps

    first, second = steps(apart)
    upper = first.contacts[1]
    assert (upper.status == "open").all()
    assert not upper.slip.any()
    assert not upper.traction.any()
    assert not any("high" in note or "grew" in note for note in first.notes)
    high = apart.mesh.points[:, -1] > 2.2
    np.testing.assert_allclose(first.displacement[high], 0.0, atol=1e-12)
    small = (1e-9 if second.path == "exact" else 1e-6) * second.work
    np.testing.assert_allclose([first.energy_defect, second.energy_defect], 0.0, atol=small)
    unloaded, expected = steps(touching)
    assert (unloaded.contacts[1].status == "open").all()
    assert not unloaded.contacts[1].slip.any()
    for contact, reference in zip(second.contacts, expected.contacts, strict=True):
        np.testing.assert_allclose(contact.normal_force, reference.normal_force, atol=1e-8 * abs(down[-1]))
        np.testing.assert_allclose(contact.pressure, reference.pressure, atol=1e-2 * reference.pressure.max())


def test_a_support_that_pushes_a_loose_block_takes_it_along():
    """A tool comes down on a block that hangs between it and the table: it touches, pushes, and presses at last."""
    model = stack(0.125)
    pushed = sg.Support("high.top", u=(0.0, -0.3), name="tool")
    step = sg.solve(replace(model, supports=[*model.supports, pushed], loads=[])).last
    assert step.path == "exact"
    np.testing.assert_allclose(step.energy_defect, 0.0, atol=1e-9 * step.work)
    touches, rests = step.events[0], step.events[1]
    assert (touches.contact, rests.contact) == ("upper", "lower")
    np.testing.assert_allclose([touches.load_factor, rests.load_factor], [0.125 / 0.3, 0.25 / 0.3], rtol=1e-9)


@pytest.mark.parametrize(
    ("kind", "how"), [("plane strain", "pressed"), ("plane strain", "squeezed"), ("space", "pressed")]
)
def test_an_unloaded_body_is_pushed_along_without_force(kind, how):
    """It lies on a block that sinks or bulges: the way is exact and takes no energy."""
    model = stack(0.0, kind)
    force = model.loads[0].force
    loads = {
        "pressed": [sg.Load("middle.top", force=force, name="first")],
        "squeezed": [sg.Load(f"middle.{side}", pressure=20.0, name=side) for side in ("left", "right")],
    }[how]
    first = sg.Step(scale={load.label: 1.0 for load in loads})
    press = sg.Step(name="press", scale={"press": 1.0})
    solution = sg.solve(replace(model, loads=[*loads, *model.loads], steps=[first, press]))
    step = solution.steps[0]
    upper = step.contacts[1]
    assert (upper.gap > -1e-9 * np.abs(step.displacement).max()).all()
    assert not upper.pressure.any()
    assert not any("candidate" in note for step in solution.steps for note in step.notes)
    assert solution.steps[1].contacts[1].normal_force[-1] == pytest.approx(-force[-1], rel=1e-8)
    size = 1e-8 if kind == "plane strain" else 1e-4  # of increments on the circular cone
    small = size * solution.steps[1].strain_energy
    np.testing.assert_allclose([step.energy_defect for step in solution.steps], 0.0, atol=small)
    if kind == "plane strain":
        assert [step.path for step in solution.steps] == ["exact", "exact"]


@pytest.mark.parametrize("gap", [0.0, 0.05])
@pytest.mark.parametrize("how", [{"path": "exact"}, {"increments": 3}, {}])
def test_a_neighbour_whose_mesh_does_not_match_pushes_a_loose_block_along_in_space(gap, how):
    """A tool that is moved by 0.3 against a block on a floor; no weight presses it, so nothing rubs, on facets too."""
    side, wide = np.linspace(0.0, 1.0, 3), np.linspace(-0.1, 1.1, 4)
    facets = {"friction": 0.2, "facets": 8}
    model = sg.Model(
        sg.join(
            {
                "tool": sg.box(x=side, y=side, z=side),
                "block": sg.box(x=side + 1.0 + gap, y=wide, z=np.linspace(0.0, 1.0, 4)),
            }
        ),
        bodies=[sg.Body(name, SOFT) for name in ("tool", "block")],
        supports=[sg.Support("tool.left", u=(0.3, 0.0, 0.0), name="drive")],
        contacts=[
            sg.Contact("tool.right", "block.left", friction_axis=(0, 1, 0), name="push", **facets),
            sg.Contact("block.bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction_axis=(1, 0, 0), name="floor", **facets),
        ],
        steps=[sg.Step(name="drive", **how)],
    )
    step = sg.solve(model).last
    ways = np.repeat([0.3, 0.3 - gap], [27, 3 * 4 * 4])
    np.testing.assert_allclose(step.displacement, np.outer(ways, [1.0, 0.0, 0.0]), atol=1e-9)
    assert not any(contact.pressure.any() for contact in step.contacts)


def test_an_approach_that_spends_its_budget_is_told(monkeypatch):
    monkeypatch.setattr("signorini.friction.approach.MAX_PIECES", 1)
    solution = sg.solve(stack(0.125, "axisymmetric"), raise_on_failure=False)
    told = (
        "step 'press' at 0%: all 1 straight pieces of a rigid approach that may be tried are spent; bodies stay where"
    )
    said = [note for step in solution.steps for note in step.notes] + [solution.message]
    assert sum(words.startswith(told) for words in said) == 1
