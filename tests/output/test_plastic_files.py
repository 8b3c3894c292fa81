# SPDX-License-Identifier: BSD-3-Clause
"""What a run of bodies that yield leaves: summary, history, fields, tables of decks, differences."""

import csv
import json
from pathlib import Path

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from tests.output.test_keyword_files import read_frd

DECK = """*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
5, 0, 1
6, 1, 1
7, 1, 2
8, 0, 2
*ELEMENT, TYPE=CPE4, ELSET=SOFT
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=HARD
2, 5, 6, 7, 8
*ELSET, ELSET=BOTH
SOFT, HARD
*SURFACE, NAME=LOWER
1, S3
*SURFACE, NAME=UPPER
2, S1
*MATERIAL, NAME=SOFT
*ELASTIC
200, 0.3
*PLASTIC
2, 0
3, 0.1
*MATERIAL, NAME=HARD
*ELASTIC
200, 0.3
*SOLID SECTION, ELSET=SOFT, MATERIAL=SOFT
*SOLID SECTION, ELSET=HARD, MATERIAL=HARD
*SURFACE INTERACTION, NAME=I
*FRICTION
0.2
*CONTACT PAIR, INTERACTION=I
LOWER, UPPER
*BOUNDARY
1, 1, 2
2, 2
5, 1
8, 1
*STEP
*STATIC
*BOUNDARY
7, 2, 2, {press}
8, 2, 2, {press}
*EL PRINT, ELSET=BOTH
S, PEEQ, PE
*END STEP
*STEP
*STATIC
*BOUNDARY
7, 2, 2, 0
8, 2, 2, 0
*END STEP
"""


def run(folder: Path, press: float) -> Path:
    folder.mkdir(exist_ok=True)
    deck = folder / "deck.inp"
    deck.write_text(DECK.format(press=press))
    assert main(["run", str(deck), "-o", str(folder / "out"), "--quiet"]) == 0
    return folder / "out"


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(tmp_path_factory.mktemp("yields"), -0.06)


def test_the_summary_says_how_far_bodies_have_yielded(out: Path) -> None:
    first, second = json.loads((out / "summary.json").read_text())["steps"]
    keys = ["dissipation", "back_stress_energy", "max_equivalent_strain", "max_equivalent_strain_in"]
    assert list(first["plastic"]) == [*keys, "max_equivalent_strain_at", "share_of_volume", "first_yield"]
    assert 0.0 < first["plastic"]["first_yield"] < 1.0
    assert first["plastic"]["share_of_volume"] == 1.0
    assert first["plastic"]["max_equivalent_strain_in"].upper() == "SOFT"
    assert first["plastic"]["dissipation"] > 0.0
    assert second["plastic"]["first_yield"] is None
    assert second["plastic"]["dissipation"] == 0.0
    assert second["plastic"]["max_equivalent_strain"] == first["plastic"]["max_equivalent_strain"]


def test_the_history_has_its_plastic_columns_last(out: Path) -> None:
    rows = list(csv.DictReader((out / "history.csv").open()))
    assert list(rows[0])[-3:] == ["work", "plastic_dissipation", "back_stress_energy"]
    first = json.loads((out / "summary.json").read_text())["steps"][0]
    ends = [row for row in rows if row["what"] == "segment"]
    assert float(ends[0]["plastic_dissipation"]) == first["plastic"]["dissipation"]
    assert float(ends[1]["plastic_dissipation"]) == 0.0
    assert float(rows[0]["plastic_dissipation"]) == 0.0


def test_fields_hold_plastic_strains(out: Path) -> None:
    solution, grid = sg.load(out), meshio.read(out / "solution_0001.vtu")
    step = solution.steps[0]
    peeq, strain = grid.point_data["peeq"], grid.point_data["plastic_strain"]
    hard = grid.point_data["node"] > 4
    assert peeq[~hard].min() > 0.0
    assert np.allclose(strain[:, :3].sum(axis=1), 0.0, atol=1e-15)
    for name in ("peeq", "plastic_strain", "back_stress"):
        assert not np.any(grid.point_data[name][hard])
        (values,) = [np.concatenate(grid.cell_data[name])]
        assert len(values) == 2
        assert not np.any(values[np.concatenate(grid.cell_data["body"]) == 1])
    means = np.concatenate(grid.cell_data["peeq"])
    assert means.max() == pytest.approx(step.plastic.state.equivalent.mean())
    assert set(grid.point_data) == {
        "displacement",
        "stress",
        "strain",
        "von_mises",
        "principal_stress",
        "reaction",
        "contact_force",
        "node",
        "peeq",
        "plastic_strain",
        "back_stress",
    }


def test_stress_left_by_unloading_is_that_of_the_strain_left(out: Path) -> None:
    """The block is free again: stresses balance to nothing across every line, and plastic strain is left."""
    solution = sg.load(out)
    assert not solution.last.contacts[0].closed.any()
    left = solution.stress(solution.model.bodies[0].name).stress
    assert abs(left[:, 1].mean()) < 1e-8
    assert solution.last.contacts[0].gap.min() > 0.01


def test_programs_that_read_frd_find_pe(out: Path) -> None:
    _, _, fields = read_frd(out / "solution.frd")
    assert [name for name, _ in fields] == ["DISP", "FORC", "STRESS", "PE", "CONTACT"] * 2
    grid = meshio.read(out / "solution_0001.vtu")
    for node, (value,) in fields[3][1].items():
        assert value == pytest.approx(grid.point_data["peeq"][grid.point_data["node"] == node][0], rel=1e-5)


def test_tables_of_elements(out: Path) -> None:
    text = (out / "solution.dat").read_text()
    state = sg.load(out).steps[0].plastic.state
    head = " equivalent plastic strain (elem, integ.pnt.,pe)for set BOTH and time  0.1000000E+01"
    lines = text.split(head)[1].splitlines()[2:10]
    assert [line[:14] for line in lines] == [f"{cell:10d}{q:4d}" for cell in (1, 2) for q in (1, 2, 3, 4)]
    found = [float(line[14:]) for line in lines]
    assert found == pytest.approx([*state.equivalent, 0, 0, 0, 0], rel=1e-6)
    lines = text.split("pexy,pexz,peyz) for set BOTH")[1].splitlines()[2:6]
    rows = np.array([[float(x) for x in line[14:].split()] for line in lines])
    assert np.allclose(rows[:, :4], state.strain * [1, 1, 1, 0.5], rtol=1e-6, atol=1e-12)


def test_differences_name_plastic_quantities(out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diff", str(out), str(out)]) == 0
    other = run(tmp_path / "other", -0.07)
    capsys.readouterr()
    assert main(["diff", str(out), str(other), "--tolerance", "1e-3"]) == 1
    words = capsys.readouterr().out
    for quantity in ("plastic dissipation", "equivalent plastic strain", "plastic strain"):
        assert quantity in words


def test_times_on_the_way_have_their_fields_and_others_their_energies(tmp_path: Path) -> None:
    model = sg.Model(
        sg.rectangle(width=2.0, nx=2),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3, plastic=sg.Plastic(4.0, hardening=50.0)))],
        supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))],
        loads=[sg.Load("right", traction=(6.0, 0))],
        steps=[sg.Step(at=(0.8, 0.9), increments=20)],
    )
    solution = sg.solve(model)
    solution.write(tmp_path / "way.pvd")
    (step,) = solution.steps
    for instant in step.instants:
        kept = instant.displacement is not None or instant is step.instants[-1]
        assert len(instant.plastic.state.equivalent) == (8 if kept else 0)
    peeq = [meshio.read(path).point_data["peeq"] for path in sorted((tmp_path / "fields").glob("*.vtu"))]
    assert [values.max() for values in peeq] == pytest.approx([(0.8 * 6 - 4) / 50, (0.9 * 6 - 4) / 50], rel=1e-7)
    works = [instant.plastic.dissipation for instant in step.instants]
    assert works == sorted(works)


def test_models_that_cannot_yield_have_nothing_of_it(tmp_path: Path) -> None:
    block = sg.rectangle(width=2.0, height=1.0)
    model = sg.Model(
        block,
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        supports=[sg.Support("left", u=(0, 0))],
        loads=[sg.Load("right", traction=(5.0, 0))],
    )
    solution = sg.solve(model)
    assert solution.last.plastic is None
    assert solution.last.yielding is None
    solution.write(tmp_path / "elastic.vtu")
    names = {"displacement", "stress", "strain", "von_mises", "principal_stress", "reaction", "contact_force", "node"}
    assert set(meshio.read(tmp_path / "elastic.vtu").point_data) == names
    assert "plastic" not in str(solution)


def test_plastic_strains_are_drawn(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(out), "--what", "peeq"]) == 0
    assert capsys.readouterr().out == f"{out / 'peeq.png'}\n"
    figure = sg.load(out).plot("peeq")
    assert "equivalent plastic strain" in {axes.get_ylabel() for axes in figure.axes}


def test_plastic_strains_in_space_are_drawn_on_the_skin() -> None:
    model = sg.Model(
        sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3, plastic=sg.Plastic(1.0, hardening=20.0)))],
        supports=[sg.Support("left", u=(0, 0, 0))],
        loads=[sg.Load("right", traction=(1.5, 0, 0))],
    )
    figure = sg.solve(model).plot("peeq")
    assert any("equivalent plastic strain on the skin" in axes.get_ylabel() for axes in figure.axes)


def test_elastic_bodies_have_no_plastic_strain_to_draw(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    example = Path(__file__).parents[2] / "examples" / "block_drag.toml"
    assert main(["run", str(example), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert main(["plot", str(tmp_path / "out"), "--what", "peeq"]) == 2
    assert "peeq: has no body that yields" in capsys.readouterr().err
