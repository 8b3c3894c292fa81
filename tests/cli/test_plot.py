# SPDX-License-Identifier: BSD-3-Clause
"""Pictures from result folders."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.arrays import Array
from signorini.cli import main
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.folder import write_drawn
from signorini.output.history_csv import write_history
from signorini.plot.curve import curves_of, surface_coordinate
from signorini.plot.history import draw_history
from signorini.plot.result_folder import ResultFolder

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("drag")
    assert main(["run", str(EXAMPLES / "block_drag.toml"), "-o", str(path), "--quiet"]) == 0
    return path


@pytest.mark.parametrize("what", ["contact", "stress", "mesh", "history"])
def test_pictures_are_written(what: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(folder), "--what", what]) == 0
    file = folder / f"{what}.png"
    assert capsys.readouterr().out == f"{file}\n"
    assert file.read_bytes().startswith(b"\x89PNG")
    assert file.stat().st_size > 20_000


def test_vector_formats_and_names(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(folder), "-o", str(tmp_path / "a.svg")]) == 0
    text = (tmp_path / "a.svg").read_text()
    assert "<svg" in text
    assert main(["plot", str(folder), "-o", str(tmp_path / "a.doc")]) == 2
    assert "expected a name that ends in .png, .pdf, .svg" in capsys.readouterr().err
    assert main(["plot", str(folder), "-o", str(tmp_path / "none" / "a.png")]) == 2


def test_curves_from_files_are_those_of_the_solution(folder: Path) -> None:
    solution = sg.solve(sg.read(EXAMPLES / "block_drag.toml"))
    for step, found in zip(solution.steps, ResultFolder(path=folder).steps, strict=True):
        (curve,), (other,) = curves_of(solution, step), found
        assert (curve.contact, curve.step, curve.axis) == (other.contact, other.step, other.axis)
        assert curve.friction == other.friction == 0.3
        for key in ("s", "pressure", "traction", "status"):
            assert (getattr(curve, key) == getattr(other, key)).all()


def test_solution_draws_itself() -> None:
    figure = sg.solve(sg.read(EXAMPLES / "zhu_cylinder.toml")).plot()
    (axes,) = figure.axes
    line = next(line for line in axes.get_lines() if line.get_label() == "pressure p")
    assert max(line.get_ydata()) == pytest.approx(38.0163, abs=1e-3)


def test_a_ring_is_drawn_over_the_angle() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    axis, angle = surface_coordinate(np.column_stack([3.0 + np.cos(turn), np.sin(turn)]))
    assert axis == "angle in degrees"
    assert np.allclose(np.sort(angle.round(9) % 360.0), np.degrees(turn))


def test_folders_without_results_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(tmp_path / "none")]) == 2
    assert "there is no folder" in capsys.readouterr().err
    assert main(["plot", str(tmp_path)]) == 2
    assert f"the folder '{tmp_path}' has no 'summary.json'" in capsys.readouterr().err


def test_the_film_of_a_path(tmp_path: Path) -> None:
    from PIL import Image

    model = zhu_cylinder(steps=[sg.Step(name="press"), sg.Step(name="off", scale={"cut": 0.2})])
    solution = sg.solve(model)
    solution.animate(tmp_path / "path.gif", frames=4)
    with Image.open(tmp_path / "path.gif") as film:
        assert film.n_frames == 4
    with pytest.raises(sg.InputError, match="unknown contact 'floor'"):
        solution.animate(tmp_path / "path.gif", contact="floor")


def lines_of(solution: sg.Solution, path: Path) -> dict[str, tuple[Array, Array]]:
    """What the picture of a history draws of the forces: load factors and values by name."""
    write_drawn(solution, path)
    write_history(solution, path / "history.csv")
    forces = draw_history(ResultFolder(path=path)).axes[2]
    solid = [line for line in forces.get_lines() if line.get_marker() == "None" and len(line.get_xdata()) > 1]
    values = [(np.array(line.get_xdata()), np.array(line.get_ydata())) for line in solid]
    return dict(zip(("normal", "friction"), values, strict=False))


def test_the_history_in_space_draws_friction_where_it_is(tmp_path: Path) -> None:
    """From the unloaded beginning, along its own direction with its sign; a run that goes on begins where it begins."""
    x = np.linspace(0.0, 2.0, 3)
    model = sg.Model(
        sg.box(x=x, y=x, z=np.linspace(0.0, 1.0, 2)),
        bodies=[sg.Body("block", sg.Elastic(E=1e5, nu=0.3))],
        loads=[
            sg.Load("top", force=(0.0, 0.0, -8000.0), name="press"),
            sg.Load("top", force=(-600.0, 800.0, 0.0), name="push"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), friction=0.5)],
        steps=[sg.Step(scale={"press": 1.0, "push": 0.0}), sg.Step(scale={"press": 1.0, "push": [1.0, -1.0]})],
    )
    load, friction = lines_of(sg.solve(model), tmp_path)["friction"]
    for at, value in ((0.0, 0.0), (1.0, 0.0), (1.5, -1000.0), (2.0, 1000.0)):
        assert friction[load == at] == pytest.approx(value, abs=1e-6)
    first = sg.solve(replace(model, steps=model.steps[:1]))
    again = sg.solve(replace(model, steps=model.steps[1:]), start=first)
    load, normal = lines_of(again, tmp_path)["normal"]
    assert (load[0], normal[0]) == (0.5, pytest.approx(8000.0))


def test_a_damaged_history_is_told_or_drawn(tmp_path: Path) -> None:
    solution = sg.solve(zhu_cylinder(steps=[sg.Step(name="press")]))
    lines_of(solution, tmp_path)
    table = [line.split(",") for line in (tmp_path / "history.csv").read_text().splitlines()]
    told = {}
    for k, column in enumerate(table[0]):
        damaged = [row[:k] + ["?"] + row[k + 1 :] if i == 2 else row for i, row in enumerate(table)]
        (tmp_path / "history.csv").write_text("\n".join(map(",".join, damaged)))
        try:
            draw_history(ResultFolder(path=tmp_path))
        except sg.InputError as error:
            told[column] = error.message
    assert told.keys() >= {"load_factor", "max_pressure", "open", "stick", "slip", "dissipation", "normal_force_y"}
    assert all(f"line 3 has '?' under {column}" in message for column, message in told.items())
