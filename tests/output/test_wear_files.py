# SPDX-License-Identifier: BSD-3-Clause
"""What is worn, in every file of a run, in the table and as a picture."""

import csv
import json

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.gallery.wearing import rubbed_cylinder, to_and_fro
from signorini.output.table import history_table
from signorini.plot.picture_data import PictureData
from signorini.plot.wear import draw_wear


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worn")
    from signorini.deck.write import write_deck

    model = rubbed_cylinder(to_and_fro(6, block=2), wear=sg.Wear(1.9e-6, mortar=2.9e-6), spacing=0.025, ratio=0.8)
    path, _ = write_deck(model, folder / "deck.toml")
    assert main(["run", str(path), "-o", str(folder / "out")]) == 0
    return sg.read(path), sg.load(folder / "out" / "solution.h5"), folder / "out"


def test_every_file_says_what_is_worn(run):
    _, solution, out = run
    wear = solution.last.contacts[0].wear
    summary = json.loads((out / "summary.json").read_text())["steps"][-1]
    assert summary["contacts"][0]["wear"]["volume_mortar"] == wear.volume[1] > 0.0
    assert summary["contacts"][0]["wear"]["max_depth"] == wear.deepest[0] > 0.0
    assert [cycle["number"] for cycle in summary["cycles"]] == [1, 2, 5, 6]
    rows = [row for row in csv.DictReader((out / "contact.csv").open()) if row["step"] == "2"]
    assert [float(row["depth"]) for row in rows] == wear.depth.tolist()
    assert [float(row["mortar_depth"]) for row in rows] == wear.mortar_depth.tolist()
    last = list(csv.DictReader((out / "history.csv").open()))[-1]
    assert float(last["worn_volume"]) == sum(wear.volume)
    assert (float(last["max_depth"]), int(last["cycles"])) == (max(wear.deepest), 7)
    bodies = meshio.read(sorted(out.glob("*.vtu"))[-1])
    assert bodies.point_data["worn_depth"].max() == max(wear.deepest)
    assert "worn: contact: " in history_table(solution)
    assert f"slid by up to {summary['contacts'][0]['wear']['max_distance']:.5g}" in history_table(solution)
    assert any("debris neither carries nor rubs" in note for note in solution.last.notes)


def test_an_archive_holds_what_is_worn(run):
    model, read, _ = run
    solved = sg.solve(model)
    assert np.array_equal(read.end.state.wear.depth, solved.end.state.wear.depth)
    assert np.array_equal(read.last.contacts[0].wear.depths, solved.last.contacts[0].wear.depths)


def test_wear_is_drawn(run, capsys):
    _, _, out = run
    assert main(["plot", str(out), "--what", "wear", "-o", str(out / "wear.svg")]) == 0
    words = (out / "wear.svg").read_text()
    assert len(words) > 10_000
    capsys.readouterr()


@pytest.mark.slow
def test_the_picture_has_volumes_beside_the_ways_that_wore_them():
    """Not beside those of the cycle behind, of which nothing is worn yet."""
    solution = sg.solve(rubbed_cylinder(to_and_fro(2), wear=sg.Wear(1.9e-6, mortar=2.9e-6), spacing=0.05))
    worn, most = draw_wear(PictureData(solution)).axes[3].lines[:2]
    assert worn.get_xdata().tolist() == most.get_xdata().tolist() == [0, 1, 2]
    shares = worn.get_ydata()[1:] / most.get_ydata()[1:]
    assert (shares > 0.8).all()
    assert (shares <= 1.0).all()


def test_the_picture_counts_the_cycles_of_steps_that_repeat(run):
    """The press before them is none: what it has worn is where no cycle is behind."""
    _, solution, _ = run
    figure = draw_wear(PictureData(solution))
    deepest = figure.axes[2].lines[0]
    assert deepest.get_xdata().tolist() == [0, 1, 2, 5, 6]
    assert deepest.get_ydata()[-1] == solution.last.contacts[0].wear.deepest[0]
