# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that move with what is worn: volumes, pressures of the bodies that are left, energy, runs that go on."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.deck.write import write_deck
from signorini.fem.space import make_space
from signorini.gallery.wearing import rubbed_cylinder, to_and_fro

STEEL, RATE = sg.Elastic(E=200.0, nu=0.3), 4e-3


def rubbed_block(
    cycles: int, *, move_mesh: float | None = 0.25, friction: float = 0.3, cells: str = "quad", **options: object
) -> sg.Model:
    """A block of 1 by 1 in cells of 1/4, pressed by 1 on a rigid plane and rubbed to and fro, 2 in a cycle."""
    sliding = str(options.pop("sliding", "small"))
    rub = sg.Step(name="rub", scale={"drive": [1.0, 0.0, -1.0, 0.0]}, repeat=cycles, **options)  # type: ignore[arg-type]
    return sg.Model(
        sg.rectangle(x=np.linspace(0.0, 1.0, 5), y=np.linspace(0.0, 1.0, 5), cells=cells),
        kind="plane strain",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("top", u=(0.5, None), name="drive")],
        loads=[sg.Load("top", force=(None, -1.0), spread="displacement", name="press")],
        contacts=[
            sg.Contact(
                "bottom",
                sg.Plane((0.0, 0.0), (0.0, 1.0)),
                friction=friction,
                sliding=sliding,  # type: ignore[arg-type]
                wear=sg.Wear(RATE, move_mesh=move_mesh),
                name="sole",
            )
        ],
        steps=[sg.Step(name="press", scale={"press": 1.0}), rub],
    )


def volume_of(model: sg.Model, places: np.ndarray) -> float:
    mesh = replace(model.mesh, points=places)
    return float(sum(v.sum() for v in make_space(mesh, kind=model.kind).volumes))


@pytest.mark.slow
@pytest.mark.parametrize(("cells", "sliding", "cycles"), [("quad8", "small", 60), ("quad", "finite", 9)])
def test_a_block_that_is_worn_away_loses_pressure_times_distance(cells: str, sliding: str, cycles: int) -> None:
    """Half of it, two cells, where it slides a little: from the mesh too, and the energy balance closes."""
    model = rubbed_block(cycles, cells=cells, sliding=sliding, block=5)
    solution = sg.solve(model)
    wear, step = solution.end.state.wear, solution.last
    rubbed = sum(step.dissipation for step in solution.steps) / 0.3
    assert (wear.volume + wear.loose).sum() == pytest.approx(RATE * rubbed, rel=1e-12)
    assert wear.depth == pytest.approx(RATE * cycles * 2.0, rel=0.02)  # but for what the block is sheared
    assert wear.moves == step.contacts[0].wear.mesh_moves >= cycles // 9
    assert 1.0 - volume_of(model, step.places) == pytest.approx(
        wear.taken @ np.array([0.5, 1, 1, 1, 0.5]) / 4, rel=1e-12
    )
    assert wear.beyond.max() <= 0.25 * 0.25
    assert abs(step.energy_defect) < 1e-12 * step.work
    assert step.certificate.passed
    assert any(f"condensed again, {wear.moves} times so far" in note for note in step.notes)


def test_pressures_are_those_of_the_bodies_that_are_left() -> None:
    """A block with a round sole, without friction: worn on its way, or meshed as it is left."""
    model = rubbed_block(3, friction=0.0, move_mesh=1e-5, block=1)
    model = replace(model, contacts=[replace(model.contacts[0], wear=sg.Wear(2e-4, move_mesh=1e-5))])
    x, y = model.mesh.points.T
    points = np.column_stack([x, y + 0.01 * (1.0 - y) * (2.0 * x - 1.0) ** 2])
    round_sole = replace(model, mesh=replace(model.mesh, points=points))
    solution = sg.solve(round_sole)
    step = solution.last
    assert solution.end.state.wear.moves == 3
    mesh, contact = replace(model.mesh, points=step.places), replace(model.contacts[0], wear=None)
    held = sg.Support("top", u=(0.0, None))
    fresh = sg.solve(replace(model, mesh=mesh, steps=model.steps[:1], supports=[held], contacts=[contact])).last
    pressure = fresh.contacts[0].pressure
    assert pressure.max() > 1.2 * pressure.min()
    assert step.contacts[0].pressure == pytest.approx(pressure, rel=1e-9)


def block_on_a_layer(share: float | None, sliding: str, **joint: object) -> sg.Model:
    """A block is rubbed on a body that lies on springs; with ``joint`` on another body, whose contact does not wear."""
    below: dict[str, object] = {
        "foundations": [sg.Foundation("layer.bottom", normal_stiffness=50.0, tangential_stiffness=20.0)]
    }
    meshes = {
        "block": sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(0.5, 1.0, 3)),
        "layer": sg.rectangle(x=np.linspace(-0.5, 1.5, 6), y=np.linspace(0.0, 0.5, 3)),
    }
    supports = [sg.Support("block.top", u=(0.1, None), name="drive")]
    wear = sg.Wear(4e-3, mortar=8e-3, move_mesh=share)
    contacts = [sg.Contact("block.bottom", "layer.top", friction=0.3, wear=wear, sliding=sliding, name="sole")]  # type: ignore[arg-type]
    if joint:
        below = {}
        meshes["base"] = sg.rectangle(x=np.linspace(-0.5, 1.5, 5), y=np.array([-0.5, 0.0]))
        supports.append(sg.Support("base.bottom", u=(0.0, 0.0)))
        contacts.append(sg.Contact("layer.bottom", "base.top", name="joint", **joint))  # type: ignore[arg-type]
    rub = sg.Step(name="rub", scale={"press": 1.0, "drive": [1.0, 0.0, -1.0, 0.0]}, repeat=2)
    return sg.Model(
        mesh=sg.join(meshes),
        kind="plane strain",
        bodies=[sg.Body(name, STEEL) for name in meshes],
        supports=supports,
        loads=[sg.Load("block.top", force=(None, -1.0), spread="displacement", name="press")],
        contacts=contacts,
        steps=[sg.Step(name="press", scale={"press": 1.0, "drive": 0.0}), rub],
        **below,  # type: ignore[arg-type]
    )


SPRINGS: dict[str, object] = {}
COMPLIANT, TIED = {"friction": 0.6, "normal_compliance": 0.01}, {"friction": "tied"}
CLOSED = {"friction": 0.6, "closure": sg.Closure(points=[(0.0, 0.0), (0.005, 0.5), (0.01, 2.0)])}


@pytest.mark.parametrize(
    ("sliding", "joint"),
    [("small", SPRINGS), ("small", COMPLIANT), ("small", TIED), ("small", CLOSED), ("finite", CLOSED)],
    ids=["springs", "contact", "tie", "closure", "closure, sliding far"],
)
def test_what_the_worn_bodies_rest_on_takes_no_part_in_it(sliding: str, joint: dict[str, object]) -> None:
    """Volume and energy balance are exact, and with small slips pressures nearly those of a mesh that stays."""
    moves = sg.solve(block_on_a_layer(0.01, sliding, **joint))
    wear, step = moves.end.state.wear, moves.last
    sole = len(step.contacts[0].pressure)
    rubbed = float(moves.end.state.dissipation[:sole].sum()) / 0.3
    assert wear.moves >= 1
    assert (wear.volume + wear.loose).sum() == pytest.approx(12e-3 * rubbed, rel=1e-9)
    assert abs(step.energy_defect) < 1e-12 * step.work
    assert step.certificate.passed
    if sliding == "finite":
        return
    stays = sg.solve(block_on_a_layer(None, sliding, **joint))
    off = np.abs(step.contacts[0].pressure - stays.last.contacts[0].pressure).max()
    assert off < 0.02 * stays.last.contacts[0].pressure.max()


@pytest.mark.slow
def test_a_little_wear_is_the_same_on_a_mesh_that_stays() -> None:
    """A cylinder and a flat, worn by a fiftieth of a cell: depths differ by less than that."""
    stays, moves = (
        sg.solve(rubbed_cylinder(to_and_fro(10), wear=sg.Wear(1.9e-6, mortar=2.9e-6, move_mesh=share), spacing=0.05))
        for share in (None, 5e-4)
    )
    one, two = stays.end.state.wear, moves.end.state.wear
    assert two.moves >= 2
    assert 0.0 < np.abs(one.depth - two.depth).max() < 0.02 * one.depth.max()
    pressures = [solution.last.contacts[0].pressure for solution in (stays, moves)]
    assert np.abs(pressures[0] - pressures[1]).max() < 0.02 * pressures[0].max()
    assert abs(moves.last.energy_defect) < 1e-12 * moves.last.work


@pytest.mark.slow
def test_a_block_in_space_and_a_ring_lose_what_they_rub() -> None:
    """Faces, and volumes all around an axis."""
    line = np.linspace(0.0, 1.0, 4)
    wear = sg.Wear(2e-4, move_mesh=2e-3)
    block = sg.Model(
        sg.box(x=line, y=line, z=np.linspace(0.0, 0.5, 3)),
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("top", u=(0.5, 0.0, None), name="drive")],
        loads=[sg.Load("top", force=(None, None, -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact("bottom", sg.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), wear=wear)],
        steps=to_and_fro(3),
    )
    ring = sg.Model(
        sg.rectangle(x=np.linspace(1.0, 2.0, 5), y=np.linspace(0.0, 0.5, 3)),
        kind="axisymmetric",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support(end, u=(None, 0.5), name=f"push {end}") for end in ("bottom", "top")],
        loads=[sg.Load("right", pressure=5.0, name="press")],
        contacts=[sg.Contact("left", sg.Plane((1.0, 0.0), (1.0, 0.0)), wear=sg.Wear(1e-3, move_mesh=0.01))],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}),
            sg.Step(name="rub", scale={f"push {end}": [1.0, 0.0] for end in ("bottom", "top")}, repeat=2, block=1),
        ],
    )
    for model in (block, ring):
        solution = sg.solve(model)
        worn, last = solution.end.state.wear, solution.last
        taken = volume_of(model, model.mesh.points) - volume_of(model, last.places)
        around = np.pi * (1.0 + last.places[:, 0].min()) if model is ring else 1.0
        assert worn.moves >= 1
        assert taken * around == pytest.approx((worn.volume * worn.taken / worn.depth).sum(), rel=0.01)
        if model is ring:  # in space, increments leave a defect
            assert abs(last.energy_defect) < 1e-12 * abs(last.work)


@pytest.mark.slow
def test_a_run_on_a_mesh_that_has_moved_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    """From a folder, whose files show the mesh as it is."""
    model = rubbed_block(4, move_mesh=0.05, block=1)
    model = replace(model, steps=[*model.steps, replace(model.steps[1], name="on")])
    whole = sg.solve(model)
    for name, part in (("one", model.steps[:2]), ("two", model.steps[2:])):
        write_deck(replace(model, steps=part), tmp_path / f"{name}.toml")
    run = ["run", "--quiet", "-o"]
    assert main([*run, str(tmp_path / "a"), str(tmp_path / "one.toml")]) == 0
    assert main([*run, str(tmp_path / "b"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "a")]) == 0
    rest = sg.load(tmp_path / "b" / "solution.h5")
    assert rest.end.state.wear.moves == whole.end.state.wear.moves > 2
    assert np.array_equal(rest.end.state.wear.depth, whole.end.state.wear.depth)
    assert np.array_equal(rest.last.contacts[0].pressure, whole.last.contacts[0].pressure)
    assert np.array_equal(rest.last.places, whole.last.places)
    summary = json.loads((tmp_path / "b" / "summary.json").read_text())["steps"][-1]
    assert summary["contacts"][0]["wear"]["mesh_moves"] == rest.end.state.wear.moves
    assert "mesh" in [row["what"] for row in csv.DictReader((tmp_path / "b" / "history.csv").open())]
    bodies = meshio.read(sorted((tmp_path / "b").glob("*.vtu"))[-1])
    assert bodies.points[:, 1].min() == pytest.approx(rest.end.state.wear.taken.min(), rel=1e-12)


def turning_block() -> sg.Model:
    """The block, its sliding finite, held by contact alone."""
    model = rubbed_block(1, sliding="finite")
    loads = [sg.Load("top", force=(0.0, -1.0), name="press")]
    return replace(model, supports=[], loads=loads, steps=[sg.Step(name="press", scale={"press": 1.0})])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: sg.Wear(1e-8, move_mesh=0.0), "move_mesh: is 0.0; expected a number > 0"),
        (
            lambda: rubbed_block(1).contacts[0].check_meshed(linked=True),
            "wear.move_mesh: is given, but bolts or cyclic symmetries link parts of the mesh; "
            "expected a mesh that stays",
        ),
        (
            lambda: sg.solve(turning_block()),
            "contact[0].wear.move_mesh: is given, but bodies may turn by any angle; expected a mesh that stays, or "
            "supports against turning",
        ),
    ],
)
def test_a_mesh_that_cannot_move_is_refused(make: Callable[[], object], words: str) -> None:
    with pytest.raises(sg.InputError) as caught:
        make()
    assert str(caught.value) == words
