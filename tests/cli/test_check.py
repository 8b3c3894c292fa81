# SPDX-License-Identifier: BSD-3-Clause
"""What ``check`` notices, plain data for other programs, and runs that are interrupted."""

import json
import os
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.engine import solve as engine
from signorini.engine.duplicate_check import same_loads
from signorini.engine.examine import examine
from signorini.inspection.notes import far_notes, held_notes, idle_notes, mesh_notes, unit_notes

DECK = Path(__file__).parents[1] / "deck" / "inp" / "decks" / "two_blocks.inp"


FLOATING = """
[[mesh]]
name = "lower"
generator = "box"
x = [0, 2]
y = [0, 2]
z = [0, 1]

[[mesh]]
name = "upper"
generator = "box"
x = [0, 0.5, 1, 1.5, 2]
y = [0, 0.5, 1, 1.5, 2]
z = [1, 2]

[material.soft]
E = 1.0
nu = 0.3

[[body]]
name = "lower"
material = "soft"

[[body]]
name = "upper"
material = "soft"

[[support]]
on = "lower.bottom"
u = [0, 0, 0]

[[load]]
on = "upper.top"
pressure = 0.01

[[contact]]
name = "joint"
nonmortar = "upper.bottom"
mortar = "lower.top"
friction = 0.3
"""


def block(**changes: object) -> sg.Model:
    """A block on the ground."""
    mesh = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
    given: dict[str, object] = {
        "bodies": [sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        "supports": [sg.Support("left", u=(0, None))],
        "loads": [sg.Load("top", pressure=1.0)],
        "contacts": [sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))],
    }
    return sg.Model(mesh, **(given | changes))  # type: ignore[arg-type]


def test_a_sound_model_raises_no_suspicion() -> None:
    model = block()
    examined = examine(model)
    assert [*mesh_notes(model), *unit_notes(model), *far_notes(examined), *held_notes(examined)] == []


def test_loose_and_coincident_nodes_are_named() -> None:
    model = block()
    mesh = model.mesh
    # a node that both cells share is doubled: the second cell has the new one; a further node is loose
    points = np.vstack([mesh.points, mesh.points[0], [9.0, 9.0]])
    number = len(mesh.points)
    torn = {family: nodes.copy() for family, nodes in mesh.cells.items()}
    shared = mesh.cells["quad"][1][np.isin(mesh.cells["quad"][1], mesh.cells["quad"][0])][0]
    torn["quad"][1] = np.where(torn["quad"][1] == shared, number, torn["quad"][1])
    points[number] = mesh.points[shared]
    cracked = replace(mesh, points=points, cells=torn, boundaries={}, nodes={})
    body = [sg.Body("block", sg.Elastic(E=100.0, nu=0.3))]
    notes = list(mesh_notes(sg.Model(cracked, bodies=body)))
    assert notes[0] == f"1 nodes belong to no element: {number + 2}"
    assert notes[1].startswith(
        f"1 pairs of nodes of one body lie at one place, the first, {shared + 1} and {number + 1}"
    )


@pytest.mark.parametrize(
    ("material", "size", "said"),
    [
        (sg.Elastic(E=2.1e11, nu=0.3), 200.0, "looks like Pa, but the model's size 200 not like m"),
        (sg.Elastic(E=2.1e5, nu=0.3), 0.02, "looks like MPa, but the model's size 0.02 not like mm"),
        (sg.Elastic(E=2.1e5, nu=0.3, density=7850.0), 200.0, "looks like MPa, to which the density 7850 does not fit"),
        (sg.Elastic(E=2.1e5, nu=0.3, density=7.85e-9), 200.0, None),
        (sg.Elastic(E=2.1e11, nu=0.3, density=7850.0), 2.0, None),
    ],
)
def test_units_that_do_not_fit(material: sg.Elastic, size: float, said: str | None) -> None:
    mesh = sg.rectangle(width=size, height=size / 2, nx=1, ny=1)
    notes = list(unit_notes(sg.Model(mesh, bodies=[sg.Body("block", material)])))
    assert [said in note for note in notes] == [True] if said else notes == []


def test_contacts_that_are_far_or_held() -> None:
    far = block(contacts=[sg.Contact("bottom", sg.Plane(point=(0, -0.5), normal=(0, 1)))])
    assert list(far_notes(examine(far))) == ["contact 'bottom' starts far open: by 25% of the model's size"]
    held = block(supports=[sg.Support("left", u=(0, 0))])
    assert list(held_notes(examine(held))) == ["supports hold 1 nodes of contact 'bottom' along its normal: 1"]


def test_what_is_given_twice() -> None:
    twice = block(
        supports=[sg.Support("left", u=(0, None)), sg.Support("left", u=(0, None), name="again")],
        loads=[sg.Load("top", pressure=1.0), sg.Load("top", traction=(0, -1), name="other")],
    )
    assert list(idle_notes(examine(twice))) == [
        "support 'again' holds nothing that those before it do not: its reaction is zero"
    ]
    said = "loads 'top' and 'other' are the same forces, and act together: twice what one of them is"
    assert list(same_loads(twice, examine(twice).loads)) == [said]
    turns = [sg.Step(name="one", scale={"top": 1.0}), sg.Step(name="two", scale={"top": 0.0, "other": 1.0})]
    after = replace(twice, steps=turns)
    assert list(same_loads(after, examine(after).loads)) == []


def test_a_floating_body_takes_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "deck.toml"
    deck.write_text(FLOATING)
    assert main(["check", str(deck)]) == 0
    notes = capsys.readouterr().out.split("notes\n")[1].splitlines()
    assert notes == [
        "  contact 'joint': the nonmortar side is the finer one, its pressures can oscillate; name the sides the other "
        "way round, or take side = 'coarser'",
        "  body 'upper' can move along x, y and z, and rotate about the axes through (1, 1, 1.5) along (1, 0, 0), (0, "
        "1, 0) and (0, 0, 1): only contact can hold that",
    ]


def test_plain_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(DECK), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["contacts"][0] | {"initial_gap": None} == {
        "name": "Sslave",
        "nonmortar": "Sslave",
        "mortar": "Smaster",
        "coupling": "nodes",
        "pairs": 3,
        "initial_gap": None,
    }
    assert found["node_sets"]["Top"] == 3
    assert main(["check", str(DECK), "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert main(["run", str(DECK), "-o", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((tmp_path / "summary.json").read_text())


def test_a_moment_on_a_rigid_body_is_no_force(capsys):
    """In words with the moment behind the force; as data the force alone, which is that on the bodies elsewhere."""
    deck = str(DECK.with_name("rigid.inp"))
    assert main(["check", deck]) == 0
    assert "rigid Nhead (2)  force  total force (0, 0, 0.5) at factor 1" in capsys.readouterr().out
    assert main(["check", deck, "--json"]) == 0
    loads = json.loads(capsys.readouterr().out)["loads"]
    assert [load["total_force"] for load in loads] == [[0.0, -10.0], [0.0, 0.0]]


def test_what_is_finished_survives_an_interruption(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    follow = engine._step

    def interrupted(prepared: object, stage: object, *rest: object) -> object:
        if stage.number == 2:  # type: ignore[attr-defined]
            raise KeyboardInterrupt
        return follow(prepared, stage, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(engine, "_step", interrupted)
    assert main(["run", str(DECK), "-o", str(tmp_path), "--quiet"]) == 130
    assert "interrupted in step 2 of 2; 1 steps were finished; results in" in capsys.readouterr().err
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert (summary["status"], len(summary["steps"])) == ("interrupted", 1)
    assert len(sg.load(tmp_path).steps) == 1
    with pytest.raises(KeyboardInterrupt) as stop:
        sg.solve(sg.read(DECK))
    assert isinstance(stop.value, sg.Interrupted)
    assert [step.finished for step in stop.value.solution.steps] == [True]
    assert stop.value.solution.end is not None


def test_a_terminated_run_keeps_what_is_finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """SIGTERM as Ctrl-C; afterwards it does to the process what it did before."""
    follow, before = engine._step, signal.getsignal(signal.SIGTERM)

    def terminated(prepared: object, stage: object, *rest: object) -> object:
        if stage.number == 2:  # type: ignore[attr-defined]
            os.kill(os.getpid(), signal.SIGTERM)
        return follow(prepared, stage, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(engine, "_step", terminated)
    assert main(["run", str(DECK), "-o", str(tmp_path), "--quiet"]) == 130
    assert [step.finished for step in sg.load(tmp_path).steps] == [True]
    assert signal.getsignal(signal.SIGTERM) == before


def test_bodies_that_yield_make_no_linear_problem(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = """
[mesh]
generator = "rectangle"
[material.steel]
E = 1000.0
nu = 0.3
{}
[[body]]
name = "block"
material = "steel"
[[support]]
on = "bottom"
u = [0, 0]
[[load]]
on = "top"
pressure = 1.2
"""
    flowing = "elastic to first yield, then increments until forces change less than 0.01"
    for law, words, way in (
        ("", "there is no contact: this is", "exact path where there is friction, otherwise 1 increment"),
        ("plastic = { yield_stress = 1.0 }", "is no contact\n", flowing),
    ):
        path = tmp_path / "deck.toml"
        path.write_text(deck.format(law))
        assert main(["check", str(path)]) == 0
        said = capsys.readouterr().out
        assert words in said
        assert way in said
