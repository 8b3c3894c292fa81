# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue from a deck to tables, fields and pictures: words, columns, keys, and what a wrong deck is told."""

import csv
import json
from dataclasses import replace

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.gallery.cubes import cubes
from signorini.plot.fatigue import draw_fatigue
from signorini.plot.picture_data import PictureData

BAR = """
kind = "plane stress"

[mesh]
generator = "rectangle"
width = 2.0
height = 1.0
nx = 2
ny = 1

[material.steel]
E = 2.0e5
nu = 0.3

[[body]]
name = "block"
material = "steel"

[[support]]
on = "left"
u = [0, "free"]

[[support]]
on = [0.0, 0.0]
u = ["free", 0]

[[load]]
name = "pull"
on = "right"
traction = [300.0, 0]

[[step]]
name = "cycles"
scale = { pull = [1.0, -1.0] }
repeat = 2

[[fatigue]]
criterion = { name = "SWT", strength = 900.0, strength_exponent = -0.1, ductility = 0.3, ductility_exponent = -0.6 }
where = "top"
distance = 0.1
average = "line"

[[fatigue]]
criterion = { name = "Crossland", bending_limit = 300.0, torsion_limit = 200.0 }
where = ["block"]
steps = "cycles"
"""

COLUMNS = "request,criterion,body,node,x,y,z,parameter,amplitude,stress,plane_x,plane_y,plane_z,distance,life"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    home = tmp_path_factory.mktemp("fatigue")
    (home / "bar.toml").write_text(BAR)
    assert main(["run", str(home / "bar.toml"), "-o", str(home / "out"), "--quiet"]) == 0
    return home / "out"


def test_rows_and_summary_say_the_same(folder):
    with (folder / "fatigue.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert ",".join(rows[0]) == COLUMNS
    swt, crossland = ([row for row in rows if row["request"] == number] for number in "12")
    assert (len(swt), len(crossland)) == (3, 6)
    assert float(swt[0]["parameter"]) == pytest.approx(300.0**2 / 2e5)
    assert [float(swt[1][f"plane_{axis}"]) for axis in "xyz"] == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)
    assert (crossland[0]["plane_x"], crossland[0]["life"], crossland[0]["distance"]) == ("", "", "0.0")
    assert float(crossland[0]["parameter"]) == pytest.approx(1.0)
    told = json.loads((folder / "summary.json").read_text())["fatigue"]
    assert [entry["criterion"]["name"] for entry in told] == ["SWT", "Crossland"]
    assert told[0]["worst"]["life"] == pytest.approx(float(swt[0]["life"]))
    assert (told[1]["worst"]["life"], told[1]["worst"]["plane"], told[1]["places"]) == (None, None, 6)
    assert (told[0]["exact"], told[0]["average"], told[0]["steps"]) == (True, "line", ["cycles"])


def test_fields_are_those_of_the_places(folder):
    grid = meshio.read(folder / "solution.vtu")
    values = grid.point_data["fatigue_1_SWT"]
    assert np.array_equal(np.isfinite(values), grid.points[:, 1] == 1.0)
    np.testing.assert_allclose(grid.point_data["fatigue_2_Crossland"], 1.0)
    assert "fatigue_1_SWT_life" in grid.point_data
    assert "fatigue_2_Crossland_life" not in grid.point_data


def test_check_and_the_table_tell_it(folder, capsys):
    deck = str(folder.parent / "bar.toml")
    assert main(["check", deck]) == 0
    assert "line at distance 0.1" in capsys.readouterr().out
    assert main(["check", deck, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["fatigue"][1]["bending_limit"] == 300.0
    table = " ".join(str(sg.load(folder)).split())
    assert "fatigue, SWT over cycles, line at distance 0.1: at most 0.45 in 'block' at node" in table
    assert "fatigue, Crossland over cycles: at most 1 in 'block'" in table


def test_decks_that_are_written_ask_the_same(folder, capsys):
    target = folder.parent / "again.toml"
    assert main(["convert", str(folder.parent / "bar.toml"), "-o", str(target)]) == 0
    capsys.readouterr()
    assert sg.read(target).fatigue == sg.read(folder.parent / "bar.toml").fatigue


@pytest.mark.slow
def test_pictures(folder, capsys):
    assert main(["plot", str(folder), "--what", "fatigue"]) == 0
    assert (folder / "fatigue.png").stat().st_size > 20000
    capsys.readouterr()
    plain = sg.solve(replace(sg.read(folder.parent / "bar.toml"), fatigue=()))
    with pytest.raises(sg.InputError, match="fatigue: was not asked for"):
        draw_fatigue(PictureData(plain))


def test_pictures_and_results_in_space():
    asked = [sg.Fatigue(sg.fatigue.SWT()), sg.Fatigue(sg.fatigue.Ruiz(), where="contact")]
    solution = sg.solve(replace(cubes(3), steps=[sg.Step(name="push", increments=3)], fatigue=asked))
    swt, ruiz = solution.fatigue_results
    assert {"upper", "lower"} == set(swt.body)
    assert ruiz.parameter.shape == solution.contact("contact").node.shape
    figure = draw_fatigue(PictureData(solution))
    assert [panel.get_title(loc="left").split(" in ")[0] for panel in figure.axes[:4]][1::2] == ["worst", "worst"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'name = "SWT"',
            'name = "SWTT"',
            ":38: fatigue[0].criterion: unknown fatigue criterion 'SWTT'; did you mean 'SWT'",
        ),
        ("ductility = 0.3", "ductility = 0", ":38: fatigue[0].criterion.ductility: is 0; expected a number > 0"),
        ("strength = 900.0, ", "", ":38: fatigue[0].criterion.strength: is missing beside strength_exponent"),
        ("torsion_limit = 200", "torsion_limit = 20", ":44: fatigue[1].criterion.torsion_limit: is 20.0; expected"),
        ('where = "top"', 'where = "tip"', ":39: fatigue[0].where: unknown contact, boundary, node set or body 'tip'"),
        ('steps = "cycles"', 'steps = "cycle"', ":46: fatigue[1].steps: unknown step 'cycle'; did you mean 'cycles'"),
        ("distance = 0.1", "distance = 0.6", ":40: fatigue[0].distance: leaves the body: point"),
        ("average = ", "avrage = ", ":41: fatigue[0].avrage: unknown key; did you mean 'average'"),
    ],
)
def test_wrong_decks(tmp_path, capsys, old, new, message):
    """Each is named by its line before anything is solved."""
    assert BAR.count(old) == 1
    (tmp_path / "deck.toml").write_text(BAR.replace(old, new))
    assert main(["check", str(tmp_path / "deck.toml")]) == 2
    assert capsys.readouterr().err.startswith(f"signorini: {tmp_path / 'deck.toml'}{message}")


def test_what_cannot_be_answered_afterwards_is_refused_before(tmp_path, capsys):
    yields = BAR.replace("nu = 0.3\n", "nu = 0.3\n[material.steel.plastic]\nyield_stress = 200.0\nhardening = 1e4\n")
    (tmp_path / "deck.toml").write_text(yields)
    assert main(["check", str(tmp_path / "deck.toml")]) == 2
    assert 'fatigue[0].steps: displacements on the way depend on plastic flow; expected at = "events"' in (
        capsys.readouterr().err
    )
    (tmp_path / "deck.toml").write_text(yields.replace('name = "cycles"', 'name = "cycles"\nat = "events"'))
    assert main(["check", str(tmp_path / "deck.toml"), "--quiet"]) == 0


KEYWORDS = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=BODY
1, 1, 2, 3, 4
*MATERIAL, NAME=STEEL
*ELASTIC
200000., 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL
1.,
*BOUNDARY
1, 1, 2
4, 1, 1
*STEP
*STATIC
*CLOAD
2, 1, 50.
3, 1, 50.
*END STEP
"""


def test_decks_of_keywords_take_the_tables_of_another_file(tmp_path, capsys):
    deck, asked = tmp_path / "bar.inp", tmp_path / "asked.toml"
    deck.write_text(KEYWORDS)
    asked.write_text('[[fatigue]]\ncriterion = "SWT"\nwhere = "ALL"\n')
    assert main(["run", str(deck), "--fatigue", str(asked), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    rows = (tmp_path / "out" / "fatigue.csv").read_text().splitlines()
    assert len(rows) == 1 + 4
    assert float(rows[1].split(",")[7]) == pytest.approx(100.0 * 50.0 / 2e5)
    asked.write_text('[[fatigue]]\ncriterion = "SWT"\nwhere = "AL"\n')
    assert main(["check", str(deck), "--fatigue", str(asked)]) == 2
    assert f"{asked}:3: fatigue[0].where: unknown contact, boundary, node set or body 'AL'" in capsys.readouterr().err
    asked.write_text("title = 'none'\n")
    assert main(["check", str(deck), "--fatigue", str(asked)]) == 2
    assert "fatigue: there is none; expected [[fatigue]] tables" in capsys.readouterr().err


def test_results_are_asked_without_solving_again(folder, capsys, monkeypatch):
    """What `run` writes that asks for the same; two of them are compared."""
    asked, again = folder.parent / "asked.toml", folder.parent / "again"
    asked.write_text(BAR[BAR.index("[[fatigue]]") :])
    monkeypatch.setattr("signorini.engine.solve.solve", None)
    assert main(["fatigue", str(folder), str(asked), "-o", str(again)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "fatigue, SWT over cycles, line at distance 0.1: at most 0.45 in 'block' at node" in told
    assert (again / "fatigue.csv").read_bytes() == (folder / "fatigue.csv").read_bytes()
    assert (
        json.loads((again / "summary.json").read_text())["fatigue"]
        == json.loads((folder / "summary.json").read_text())["fatigue"]
    )
    assert main(["diff", str(folder), str(again)]) == 0
    asked.write_text(asked.read_text().replace("bending_limit = 300.0", "bending_limit = 310.0"))
    assert main(["fatigue", str(folder / "solution.h5"), str(asked), "-o", str(again), "--quiet"]) == 0
    capsys.readouterr()
    assert main(["diff", str(folder), str(again)]) == 1
    apart = capsys.readouterr().out.splitlines()[1:]
    assert len(apart) == 1
    assert apart[0].split()[:5] == ["cycles", "fatigue", "2", "Crossland:", "parameter"]
    asked.write_text(asked.read_text().replace("Crossland", "Dang Van"))
    assert main(["fatigue", str(folder), str(asked), "-o", str(again), "--quiet"]) == 0
    assert main(["diff", str(folder), str(again)]) == 1
    assert "fatigue criterion 2: Crossland and Dang Van" in capsys.readouterr().out


def test_what_cannot_be_asked_of_results_is_told_with_its_line(folder, capsys):
    asked = folder.parent / "wrong.toml"
    for text, said in (
        ('[[fatigue]]\ncriterion = "SWT"\nwhere = "tip"\n', ":3: fatigue[0].where: unknown contact, boundary"),
        ('[[fatigue]]\ncriterion = "SWT"\nwhere = "top"\ndistance = 9.0\n', ":4: fatigue[0].distance: leaves the body"),
        ('title = "none"\n', ": fatigue: there is none; expected [[fatigue]] tables"),
    ):
        asked.write_text(text)
        assert main(["fatigue", str(folder), str(asked), "-o", str(folder.parent / "wrong")]) == 2
        assert said in capsys.readouterr().err
    assert main(["fatigue", str(folder.parent), str(asked)]) == 2
    assert "has no 'summary.json'" in capsys.readouterr().err
