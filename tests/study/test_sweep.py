# SPDX-License-Identifier: BSD-3-Clause
"""Parameter studies: rows are the answers of models that are solved one by one, what is shared is prepared once, and a
sweep goes on where it stopped."""

import csv
import json
import pickle
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.engine import prepare as preparing
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit
from signorini.output.dataclasses_json import to_plain
from signorini.study.problem import DeckFile, GivenModel, Study
from tests.distributed.test_on_ranks import on_ranks, with_ranks
from tests.helpers.block_deck import block_deck

CYLINDER = str(Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml")
SECONDS = ("cpu_seconds", "wall_seconds")
BLOCK = """\
[mesh]
generator = "rectangle"
nx = 2
[material.soft]
E = 100.0
nu = 0.0
[[body]]
name = "block"
material = "soft"
[[contact]]
name = "floor"
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = 0.5
[[load]]
name = "press"
on = "top"
force = [0.3, -1.0]
"""
"""A block that friction alone holds, from a coefficient of 0.3 on."""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text(BLOCK)
    return path


def swept(*arguments):
    """Exit code of a quiet sweep without a picture, which takes most of the time of small studies."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("signorini.cli.sweep_command._picture", lambda *_: [])
        return main(["sweep", *map(str, arguments), "--quiet"])


def table(folder):
    """Rows of the table without seconds."""
    with (folder / "sweep.csv").open(newline="") as file:
        return [{key: value for key, value in row.items() if key not in SECONDS} for row in csv.DictReader(file)]


def rows_of(folder):
    return json.loads((folder / "sweep.json").read_text())["rows"]


@pytest.fixture
def factorised(monkeypatch):
    """How often bodies are condensed."""
    calls = []
    condense = preparing.condense_bodies

    def counted(*arguments, **more):
        calls.append(1)
        return condense(*arguments, **more)

    monkeypatch.setattr(preparing, "condense_bodies", counted)
    return calls


def test_nine_frictions_cost_one_factorisation(factorised, tmp_path):
    assert swept(CYLINDER, "--set", "friction.foundation=0:0.8:9", "-o", tmp_path) == 0
    assert len(factorised) == 1
    assert [row["values"]["friction.foundation"] for row in rows_of(tmp_path)] == [k / 10 for k in range(9)]


def test_rows_are_the_answers_of_models_solved_one_by_one(factorised):
    """A factorisation for each modulus, whatever the order of the parameters."""
    model = zhu_cylinder(friction=0.3)
    (body,), law = model.bodies, model.contacts[0]
    moduli = [1.0 * body.material.E, 2.0 * body.material.E]
    found = sg.sweep(
        model, {"friction.foundation": [0.0, 0.4], f"E.{body.name}": moduli, "load.cut": np.array([0.5, 1.0])}
    )
    assert len(factorised) == 2
    assert len(found.rows) == 8
    assert found.solved
    for row in found.rows:
        friction, modulus, factor = row.values.values()
        alone = replace(
            model,
            bodies=[replace(body, material=replace(body.material, E=modulus))],
            contacts=[replace(law, friction=friction)],
            loads=[replace(model.loads[0], force=(model.loads[0].force[0], factor * -78.0))],
        )
        solution = sg.solve(alone)
        contact, outputs = solution.contact("foundation"), row.outputs
        assert outputs["foundation.max_pressure"] == pytest.approx(contact.pressure.max(), rel=1e-9)
        assert outputs["foundation.normal_force_y"] == pytest.approx(78.0 * factor, rel=1e-9)
        assert outputs["foundation.stick"] == contact.count("stick")
        assert outputs["dissipation"] == pytest.approx(solution.last.dissipation, rel=1e-7, abs=1e-12)
        assert outputs["strain_energy"] == pytest.approx(solution.last.strain_energy, rel=1e-9)


def test_interferences_share_a_factorisation(factorised):
    model = press_fit()
    name = model.contacts[0].label
    found = sg.sweep(model, {f"interference.{name}": [0.01, 0.02]})
    assert len(factorised) == 1
    low, high = (row.outputs[f"{name}.max_pressure"] for row in found.rows)
    assert high == pytest.approx(2.0 * low, rel=1e-9)


def test_keys_of_a_deck_are_read_as_the_deck_is(tmp_path, factorised):
    """Meshes and components of forces; friction by its key is the friction of sensitivities."""
    path = tmp_path / "block.toml"
    path.write_text(block_deck(name="own"))
    keys = ["--set", "mesh.nx=2,4", "--set", "load.own.force[1]=-1:-3:2", "--set", "contact.friction=0.1,0.2"]
    assert swept(path, *keys, "-o", tmp_path) == 0
    assert len(factorised) == 4  # of eight rows
    forces = {(row["values"]["load.own.force[1]"], row["outputs"]["own.normal_force_y"]) for row in rows_of(tmp_path)}
    assert {(given, round(found, 9)) for given, found in forces} == {(-1, 1.0), (-3, 3.0)}
    nodes = [sum(row["outputs"][f"own.{state}"] for state in ("open", "stick", "slip")) for row in rows_of(tmp_path)]
    assert nodes == [3] * 4 + [5] * 4


def test_a_row_that_fails_says_why_and_others_go_on(deck, tmp_path, capsys):
    keys = ["--set", "friction.floor=0.1,0.2,0.4"]
    assert swept(deck, *keys, "-o", tmp_path) == 3
    said = capsys.readouterr().err
    assert "2 of 3 rows have no certified solution" in said
    assert "friction.floor = 0.1: no_equilibrium: " in said
    rows = table(tmp_path)
    assert [(row["status"], row["certified"]) for row in rows] == [("no_equilibrium", "False")] * 2 + [
        ("solved", "True")
    ]
    assert rows[0]["floor.normal_force_y"] == ""
    assert float(rows[2]["floor.normal_force_y"]) == pytest.approx(1.0, abs=1e-9)
    assert float(rows[2]["floor.tangential_force_x"]) == pytest.approx(-0.3, abs=1e-9)


def test_values_that_mend_the_deck_are_solved_anew(deck):
    """Without friction nothing holds the block, so that the deck itself cannot be prepared."""
    deck.write_text(BLOCK.replace("friction = 0.5", "friction = 0.0"))
    rows = sg.sweep(deck, {"friction.floor": [0.0, 0.4]}).rows
    assert [row.status for row in rows] == ["wrong_input", "solved"]
    assert rows[0].message.endswith("nothing but frictionless contact, which cannot resist; add a support or friction")
    assert rows[1].outputs["floor.normal_force_y"] == pytest.approx(1.0, abs=1e-9)


def test_values_that_do_not_go_together_are_a_row(deck):
    """Each of them is right by itself."""
    rows = sg.sweep(deck, {"kind": ["plane strain", "axisymmetric"], "thickness": [1.0, 2.0]}).rows
    assert [row.status for row in rows][:2] == ["solved", "solved"]
    assert rows[3].status == "wrong_input"
    assert rows[3].message.startswith("kind = axisymmetric: thickness is 2; ")


@pytest.mark.parametrize(
    ("key", "words"),
    [
        (
            "friction.flor=0.1",
            "'friction.flor': unknown friction of the model 'flor'; did you mean 'floor'? Known: floor",
        ),
        ("friction.floor=0.1,-0.2", "friction.floor = -0.2: friction is -0.2; expected a number >= 0"),
        ("E.block=stiff", "E.block = stiff: is 'stiff'; expected a number"),
        ("contact.floor.gap=wide", "contact.floor.gap = wide: contact[0].gap is 'wide'; expected 'geometry', "),
        ("mesh.nz=1", "mesh.nz = 1: mesh.nz unknown key"),
        ("contact[1].friction=0.1", "there is no contact[1] in the deck; it has 1"),
        ("mesh.nx.ny=1", "there is no 'mesh.nx.ny' in the deck: 'mesh.nx' is 2, which has no parts"),
        ("frction.floor=0.1", "'frction.floor': unknown kind of parameter, or key of the deck 'frction'; did you mean"),
        ("friction.floor=0.1:0.2", "--set: is 'friction.floor=0.1:0.2'; expected KEY=FROM:TO:NUMBER"),
        ("friction.floor=0.1,,0.2", "--set: is 'friction.floor=0.1,,0.2', with an empty value; expected KEY="),
        ("friction.floor", "--set: is 'friction.floor'; expected KEY="),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(deck, tmp_path, capsys, monkeypatch, key, words):
    monkeypatch.setattr(preparing, "condense_bodies", None)
    assert swept(deck, "--set", key, "-o", tmp_path / "out") == 2
    assert capsys.readouterr().err.startswith(f"signorini: {words}")
    assert not (tmp_path / "out").exists()


def test_one_parameter_has_one_name(deck, tmp_path, capsys):
    keys = ["--set", "friction.floor=0.1", "--set", "contact[0].friction=0.2"]
    assert swept(deck, *keys, "-o", tmp_path) == 2
    assert "'contact[0].friction' is what 'friction.floor' is; expected each parameter once" in capsys.readouterr().err


def test_a_deck_of_keywords_knows_the_names_of_sensitivities(tmp_path, capsys):
    path = Path(__file__).parents[1] / "deck" / "inp" / "decks" / "two_blocks.inp"
    model = sg.read(path)
    name, body = model.contacts[0].label, model.bodies[0].name
    keys = ["--set", f"friction.{name}=0.1,0.3", "--set", f"E.{body}=1e5,2e5"]
    assert swept(path, *keys, "-o", tmp_path) == 0
    assert len(rows_of(tmp_path)) == 4
    assert swept(path, "--set", "mesh.nx=2", "-o", tmp_path) == 2
    assert "unknown kind of parameter 'mesh'" in capsys.readouterr().err


def test_a_sweep_goes_on_from_what_is_there(deck, tmp_path, factorised):
    assert swept(deck, "--set", "friction.floor=0.1,0.4", "-o", tmp_path) == 3
    before = rows_of(tmp_path)
    assert swept(deck, "--set", "friction.floor=0.1,0.4,0.5", "-o", tmp_path) == 3
    assert rows_of(tmp_path)[:2] == before  # seconds too: they were not solved again
    assert len(factorised) == 2
    assert swept(deck, "--set", "friction.floor=0.1,0.4", "-o", tmp_path) == 3
    assert len(factorised) == 2
    assert rows_of(tmp_path) == before
    assert swept(deck, "--set", "friction.floor=0.5", "-o", tmp_path) == 0  # which the record has kept all the same
    assert len(factorised) == 2


def test_results_of_kept_rows_are_made_where_they_are_asked_for(deck, tmp_path):
    keys = ["--set", "friction.floor=0.1,0.4", "-o", tmp_path]
    assert swept(deck, *keys) == 3
    assert swept(deck, *keys, "--results") == 3
    (folder,) = (tmp_path / "results").iterdir()
    assert folder.name == "friction.floor=0.4"
    assert sg.load(folder).contact("floor").normal_force[1] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "key", "why"),
    [
        (BLOCK.replace("100.0", "200.0"), "friction.floor", "of this deck as it was before, with other settings or by"),
        (BLOCK + "[solver]\nnewton_steps = 50\n", "friction.floor", "of this deck as it was before"),
        (BLOCK, "load.press", "over friction.floor"),
    ],
)
def test_rows_of_another_study_are_left_alone(deck, tmp_path, capsys, text, key, why):
    assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 0
    before = (tmp_path / "sweep.csv").read_bytes()
    deck.write_text(text)
    assert swept(deck, "--set", f"{key}=1,2", "-o", tmp_path) == 2
    said = capsys.readouterr().err
    assert f"signorini: the folder '{tmp_path}' holds a sweep {why}" in said
    assert said.endswith("; expected a folder of its own (-o)\n")
    assert (tmp_path / "sweep.csv").read_bytes() == before


def test_a_comment_in_the_deck_changes_nothing(deck, tmp_path, factorised):
    assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 0
    deck.write_text("# a comment\n" + BLOCK)
    assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 0
    assert len(factorised) == 1


def test_a_program_that_fails_is_a_row_that_is_tried_again(deck, tmp_path, monkeypatch, capsys):
    solver = "signorini.study.row_solver.solve_prepared"

    def broken(*_, **__):
        raise MemoryError("5 GB")

    with monkeypatch.context() as patched:
        patched.setattr(solver, broken)
        assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 1
        assert "friction.floor = 0.4: error: MemoryError: 5 GB" in capsys.readouterr().err
    assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 0


def test_an_interrupted_sweep_says_what_is_there(deck, tmp_path, monkeypatch, capsys):
    from signorini.study import row_solver

    solve, calls = row_solver.solve_prepared, []

    def interrupted(*arguments, **more):
        calls.append(1)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return solve(*arguments, **more)

    monkeypatch.setattr(row_solver, "solve_prepared", interrupted)
    keys = ["--set", "friction.floor=0.4,0.5,0.6", "-o", tmp_path]
    assert swept(deck, *keys) == 130
    words = f"signorini: interrupted; 1 of 3 rows are in {tmp_path}, the same command goes on from them\n"
    assert capsys.readouterr().err == words
    assert swept(deck, *keys) == 0
    assert len(table(tmp_path)) == 3


def test_what_is_printed(deck, tmp_path, capsys):
    assert main(["sweep", str(deck), "--set", "friction.floor=0.4:0.6:3", "-o", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[2].split() == ["friction.floor", "floor.max_pressure", "floor.max_slip", "dissipation", "seconds"]
    assert [line.split()[0] for line in lines[3:6]] == ["0.4", "0.5", "0.6"]
    assert lines[-1] == f"sweep.csv, sweep.png in {tmp_path}"
    assert (tmp_path / "sweep.png").stat().st_size > 10_000
    assert main(["sweep", str(deck), "--set", "friction.floor=0.4", "-o", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["rows"][0]["outputs"]["floor.normal_force_y"] == pytest.approx(1.0, abs=1e-9)
    assert not (tmp_path / "sweep.png").exists()  # there is nothing to draw over


def test_the_folder_of_a_sweep_is_not_taken_for_that_of_a_run(deck, tmp_path, capsys):
    assert main(["sweep", str(deck), "--set", "friction.floor=0.4,0.6", "-o", str(tmp_path), "--quiet"]) == 0
    said = f"the folder '{tmp_path}' is that of a sweep, whose rows are in 'sweep.csv', drawn in 'sweep.png'; expected"
    for command in ("plot", "report"):
        assert main([command, str(tmp_path)]) == 2
        assert said in capsys.readouterr().err


def test_units_are_those_of_the_deck(deck, tmp_path):
    deck.write_text('units = "mm, N, MPa"\n' + BLOCK)
    assert swept(deck, "--set", "friction.floor=0.4", "-o", tmp_path) == 0
    units = json.loads((tmp_path / "sweep.json").read_text())["units"]
    assert (units["floor.max_pressure"], units["work"], units["floor.closed_area"]) == ("MPa", "N mm", "mm^2")


def test_a_model_with_a_function_is_swept_but_not_recorded(tmp_path):
    model = zhu_cylinder(friction=0.3)
    heavy = replace(
        model, loads=[replace(model.loads[0], force=None, traction=lambda x: np.tile([0.0, -1.0], (len(x), 1)))]
    )
    assert sg.sweep(heavy, {"friction.foundation": [0.1, 0.2]}).solved
    with pytest.raises(sg.InputError, match="which a file cannot hold"):
        sg.sweep(heavy, {"friction.foundation": [0.1]}, folder=tmp_path)


@pytest.mark.slow
def test_processes_give_the_same_table(deck, tmp_path):
    keys = ["--set", "friction.floor=0.2,0.4,0.5", "--set", "E.block=100,200"]
    assert swept(deck, *keys, "-o", tmp_path / "one", "--processes", 1) == 3
    assert swept(deck, *keys, "-o", tmp_path / "two", "--processes", 2) == 3
    assert table(tmp_path / "one") == table(tmp_path / "two")


def test_a_model_goes_to_processes():
    """As data: what is read only in it cannot be copied as it is."""
    model = zhu_cylinder(friction=0.3)
    there = pickle.loads(pickle.dumps(GivenModel(model))).read({}).model
    assert to_plain(there, "", lambda *_: "") == to_plain(model, "", lambda *_: "")
    one, other = (sg.sweep(given, {"friction.foundation": [0.2]}).rows[0] for given in (model, there))
    assert one.outputs == other.outputs


def ended(processes):
    """Whether processes end within ten seconds: one that nobody has reaped yet has ended."""

    def runs(process):
        try:
            return Path("/proc", process, "stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
        except (FileNotFoundError, ProcessLookupError):
            return False

    until = time.monotonic() + 10.0
    while any(map(runs, processes)) and time.monotonic() < until:
        time.sleep(0.05)
    return not any(map(runs, processes))


@pytest.mark.slow
def test_a_sweep_that_is_killed_goes_on_to_the_same_table(deck, tmp_path):
    """Its processes end with it, or two would write into a folder of results."""
    keys = ["--set", "friction.floor=0.31:0.9:30", "--set", "mesh.nx=4,6"]
    there, whole = tmp_path / "killed", tmp_path / "whole"
    command = [sys.executable, "-m", "signorini", "sweep", str(deck), *keys, "-o", str(there)]
    begun = subprocess.Popen([*command, "--processes", "2", "--quiet"])
    while not (there / "sweep.json").exists() or len(rows_of(there)) < 3:
        assert begun.poll() is None
        time.sleep(0.05)
    children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(begun.pid)], capture_output=True, text=True).stdout
    begun.send_signal(signal.SIGKILL)
    begun.wait()
    kept = rows_of(there)
    assert 3 <= len(kept) < 60
    assert swept(deck, *keys, "-o", there) == 0
    again = {json.dumps(row["values"]): row for row in rows_of(there)}
    assert all(again[json.dumps(row["values"])] == row for row in kept)
    assert swept(deck, *keys, "-o", whole) == 0
    assert table(there) == table(whole)
    assert ended(children.split())


class SilentRank:
    """The communicator of two ranks of which the other one never answers."""

    size = 2

    def __init__(self):
        self.sent = []

    def send(self, message, dest):
        self.sent.append((message, dest))

    def iprobe(self, source):
        assert source == 1
        return False

    def Abort(self, code):
        self.sent.append(("abort", code))


@pytest.mark.slow
def test_the_first_rank_has_a_row_solved_beside_it(deck):
    """Rows go to as many places as there are ranks, and its own does not wait for the others'."""
    from signorini.study.lanes import RankLanes

    study = Study.of(DeckFile(path=deck), {"friction.floor": (0.4, 0.5)}, "auto", None)
    comm = SilentRank()
    lanes = RankLanes(comm, study)
    assert lanes.count == 2
    try:
        for lane, friction in enumerate((0.4, 0.5)):
            lanes.begin(lane, 7 + lane, {"friction.floor": friction})
        lane, number, row = lanes.finished()
    finally:
        lanes.close()
    assert (lane, number, row.status) == (0, 7, "solved")
    assert comm.sent[:2] == [((8, {"friction.floor": 0.5}), 1), ("abort", 1)]


@with_ranks
@pytest.mark.slow
def test_rows_are_shared_out_over_ranks(deck, tmp_path):
    keys = ["--set", "friction.floor=0.2,0.4,0.5", "--set", "E.block=100,200"]
    there, here = tmp_path / "ranks", tmp_path / "here"
    done = on_ranks(3, "-m", "signorini", "sweep", str(deck), *keys, "-o", str(there))
    assert done.returncode == 3, done.stderr
    assert swept(deck, *keys, "-o", here) == 3
    assert table(there) == table(here)
    wrong = on_ranks(2, "-m", "signorini", "sweep", str(deck), "--set", "friction.flor=1", "-o", str(there))
    assert wrong.returncode == 2
    assert wrong.stderr.count("did you mean 'floor'") == 1
