# SPDX-License-Identifier: BSD-3-Clause
"""Results as columns: contacts, the history with what acts from outside, CSV files, pandas, a result folder."""

import csv
import json
import sys
import types
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from tests.helpers.block_deck import block_deck

FLOOR = sg.Plane(point=(0, 0), normal=(0, 1))


def fretted(at=()) -> sg.Solution:
    """A block on a rough floor that is pushed to and fro, held by a spring and a support; with its exact path."""
    model = sg.Model(
        sg.rectangle(width=4.0, height=1.0, nx=8, ny=2),
        kind="plane strain",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, None), name="wall")],
        foundations=[sg.Foundation("right", tangential_stiffness=3.0, name="bed")],
        loads=[sg.Load("top", pressure=10.0, name="press"), sg.Load("right", traction=(6.0, 0.0), name="push")],
        contacts=[sg.Contact("bottom", FLOOR, friction=0.3, name="floor")],
        steps=[
            sg.Step(name="press", scale={"press": 1.0, "push": 0.0}, path="exact", at=at),
            sg.Step(name="fret", scale={"push": [1.0, -1.0]}, path="exact", at=at),
        ],
    )
    return sg.solve(model)


@pytest.fixture(scope="module")
def solution() -> sg.Solution:
    return fretted()


def test_history_balances_and_is_that_of_kept_displacements(solution):
    history, kept = solution.history, fretted(at="events").history
    assert history.rows == kept.rows == sum(len(step.instants) for step in solution.steps)
    assert history.rows > 8
    for name in set(history) - {"work"}:  # which is known at ends of steps alone
        if history[name].dtype.kind == "f":
            assert history[name] == pytest.approx(kept[name], abs=1e-9 * np.abs(kept[name]).max()), name
    pushed = 6.0 * history["factor.push"]
    held = history["wall.reaction_x"] + history["bed.reaction_x"] + history["floor.tangential_force_x"]
    assert pushed + held == pytest.approx(0.0, abs=1e-9)
    down = history["bed.reaction_y"] + history["floor.normal_force_y"]
    assert down == pytest.approx(40.0 * history["factor.press"], abs=1e-9)
    assert np.abs(history["bed.reaction_y"]).max() > 1e-3
    top = solution.last.displacement[np.isclose(solution.model.mesh.points[:, 1], 1.0), 1]
    weights = np.r_[0.5, np.ones(7), 0.5] / 8.0
    order = np.argsort(solution.model.mesh.points[np.isclose(solution.model.mesh.points[:, 1], 1.0), 0])
    assert history["press.approach"][-1] == pytest.approx(-top[order] @ weights, rel=1e-12)


def test_obstacle_that_a_load_drives_is_followed_on_the_way():
    shape = sg.Circle(centre=(2.0, 3.0), radius=2.0)
    punch = sg.Rigid("punch", shape, u=(0, None), force=(None, -300.0), point=(2.0, 3.0))
    model = sg.Model(
        sg.rectangle(width=4.0, height=1.0, nx=24, ny=4),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        obstacles=[punch],
        supports=[sg.Support("bottom", u=(0, 0))],
        contacts=[sg.Contact("top", "punch", friction=0.2, name="nose")],
        steps=[sg.Step(name="press", path="exact")],
    )
    history = sg.solve(model).history
    assert history.rows > 3
    part = {"punch": history["load_factor"][1]}  # up to the first event alone: what ends of steps say
    then = sg.solve(replace(model, steps=(sg.Step(path="exact", scale=part),))).last
    moved = then.obstacles["punch"]
    assert history["punch.displacement_y"][1] == pytest.approx(moved.displacement[1], rel=1e-10)
    assert history["punch.force_y"][1] == pytest.approx(moved.force[1], rel=1e-10)
    assert history["punch.moment"][1] == pytest.approx(moved.moment, abs=1e-9)
    assert history["bottom.reaction_y"][1] == pytest.approx(then.reactions["bottom"][1], rel=1e-10)


def test_contact_table_is_contact_csv_and_more(solution, tmp_path):
    files = solution.save_results(tmp_path / "out")
    rows = list(csv.DictReader((tmp_path / "out" / "contact.csv").open()))
    table = solution.contact_table()
    assert table.rows == len(rows) == 18
    for name in rows[0]:
        read = [row[name] for row in rows]
        assert table[name].tolist() == (read if name in ("contact", "status") else [float(value) for value in read])
    assert tmp_path / "out" / "summary.json" in files
    floor, last = solution.contact("floor"), table["step"] == 2
    assert table["slip_amplitude"][last] == pytest.approx(0.5 * floor.slip_range)
    assert table["dissipation_per_area"][last] @ table["area"][last] == pytest.approx(floor.dissipation)
    assert table["force_y"][last].sum() == pytest.approx(floor.normal_force[1])
    assert table["arc_length"][last] == pytest.approx(table["x"][last])  # the tangent goes along x
    assert set(table["normal_y"]) == {1.0}
    then = solution.at("fret", load=0.3)
    assert then.contact_table()["pressure"].tolist() == then.contact("floor").pressure.tolist()


def test_arc_length_goes_along_the_tangent_on_curved_quadratic_sides():
    model = sg.Model(
        sg.annulus(inner=1.0, outer=2.0, n_radial=1, n_angular=4, angle=90.0, order=2),
        bodies=[sg.Body("ring", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("start", u=(None, 0)), sg.Support("end", u=(0, None))],
        loads=[sg.Load("outer", pressure=1.0)],
        contacts=[sg.Contact("inner", sg.Circle(centre=(0, 0), radius=1.0), name="shaft")],
    )
    table = sg.solve(model).contact_table()
    assert table.rows == 5  # corners of facets; the way goes over the nodes between them
    angle = np.arctan2(table["y"], table["x"])
    chords = 2.0 * np.sin(np.pi / 32.0) / (np.pi / 16.0)  # normals point outwards, so that the tangent goes clockwise
    assert table["arc_length"] == pytest.approx((0.5 * np.pi - angle) * chords, abs=1e-9)


def test_files_and_dataframes(solution, tmp_path, monkeypatch):
    solution.write(tmp_path / "contact.csv")
    solution.history.write(tmp_path / "history.csv")
    solution.at("fret", event=1).write(tmp_path / "then.csv")
    rows = list(csv.DictReader((tmp_path / "history.csv").open()))
    assert [float(row["wall.reaction_x"]) for row in rows] == solution.history["wall.reaction_x"].tolist()
    assert "" in {row["work"] for row in rows}
    assert len(list(csv.DictReader((tmp_path / "contact.csv").open()))) == 18
    assert len(list(csv.DictReader((tmp_path / "then.csv").open()))) == 9
    with pytest.raises(sg.InputError, match=r"expected a name that ends in \.csv"):
        solution.history.write(tmp_path / "history.txt")
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(sg.InputError, match="a DataFrame needs pandas; expected 'pip install pandas'"):
        solution.to_dataframe()
    monkeypatch.setitem(sys.modules, "pandas", types.SimpleNamespace(DataFrame=lambda columns: columns))
    assert list(solution.to_dataframe()) == list(solution.contact_table())
    assert list(solution.history.to_dataframe()) == list(solution.history)
    with pytest.raises(KeyError, match=r"'wal'; there are step, name"):
        solution.history["wal"]


def test_pandas(solution):
    pandas = pytest.importorskip("pandas")
    frame = solution.history.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["wall.reaction_x"].tolist() == solution.history["wall.reaction_x"].tolist()


def test_a_folder_from_python_is_that_of_a_run(tmp_path):
    deck = tmp_path / "block.toml"
    deck.write_text(block_deck())
    assert main(["run", str(deck), "-o", str(tmp_path / "run"), "--quiet"]) == 0
    model = sg.read(deck)
    sg.solve(model).save_results(tmp_path / "python")
    sg.solve(model).save_results(tmp_path / "python")
    names = {file.name for file in (tmp_path / "run").iterdir()}
    assert {file.name for file in (tmp_path / "python").iterdir()} == names
    for name in ("contact.csv", "history.csv", "solution.vtu"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "run" / name).read_bytes()
    one, two = (json.loads((tmp_path / folder / "summary.json").read_text()) for folder in ("run", "python"))
    assert (one.pop("deck"), two.pop("deck")) == ("block.toml", "")
    for key in ("timings", "peak_memory_bytes"):
        one.pop(key), two.pop(key)
    assert one == two
    assert main(["plot", str(tmp_path / "python"), "--what", "stress"]) == 0
    with pytest.raises(sg.InputError, match="holds the results of another deck"):
        sg.solve(model).save_results(tmp_path / "run")


def test_tables_of_a_result_folder(solution, tmp_path, capsys):
    solution.save_results(tmp_path)
    for words in (["--what", "history"], [], ["--step", "fret", "--load", "0.3", "-o", str(tmp_path / "then.csv")]):
        assert main(["table", str(tmp_path), *words]) == 0
    written = [line.rsplit("/", 1)[1] for line in capsys.readouterr().out.splitlines()]
    assert written == ["history_table.csv", "contact_table.csv", "then.csv"]
    solution.history.write(tmp_path / "expected.csv")
    assert (tmp_path / "history_table.csv").read_text() == (tmp_path / "expected.csv").read_text()
    rows = list(csv.DictReader((tmp_path / "then.csv").open()))
    assert [float(row["pressure"]) for row in rows] == solution.at("fret", load=0.3).contact("floor").pressure.tolist()
    assert main(["table", str(tmp_path), "--what", "history", "--load", "0.5"]) == 2
    assert main(["table", str(tmp_path), "--load", "1.5"]) == 2
    assert "load: is 1.5; expected a part of step 2 between 0 and 1" in capsys.readouterr().err
