# SPDX-License-Identifier: BSD-3-Clause
"""Pictures from result folders."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import signorini as sg
from signorini.arrays import Array
from signorini.cli import main
from signorini.clock import Clock
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.fields import Fields
from signorini.output.folder import Publisher
from signorini.plot.curve import surface_coordinate
from signorini.plot.history import draw_history
from signorini.plot.picture_data import HistoryData
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


def same(one: Any, other: Any) -> bool:
    """Arrays to the last bit, and whatever holds them."""
    if isinstance(one, np.ndarray):
        return bool(np.array_equal(one, other))
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, Mapping):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    return same(vars(one), vars(other)) if hasattr(one, "__dataclass_fields__") else bool(one == other)


@pytest.mark.parametrize("deck", ["block_drag", "hertz_two_bodies", "ball_on_block"])
def test_pictures_show_the_same_from_memory_and_from_files(deck: str, tmp_path: Path) -> None:
    solution = sg.solve(sg.read(EXAMPLES / f"{deck}.toml"))
    Publisher(folder=tmp_path, clock=Clock(), started=0.0, deck="").publish(solution)
    memory, files = HistoryData(solution, Fields(solution.model)), ResultFolder(path=tmp_path)
    for part in ["solid", "title", "size", "dots", "walls", *(["patches", "skin"] if memory.solid else [])]:
        assert same(getattr(memory, part), getattr(files, part)), part
    for part in ("points", "displacement", "stress", "node"):
        assert same(getattr(memory.bodies, part), getattr(files.bodies, part)), part
    for part in ("cells", "body"):  # a file has the cells of one family that follow each other in one block
        assert same(*(np.concatenate(getattr(data.bodies, part)) for data in (memory, files))), part
    for number, step in enumerate(solution.steps, start=1):
        for contact in step.contacts:
            rows, read = memory.nodes_of(number, contact.name), files.nodes_of(number, contact.name)
            assert [{key: str(value) for key, value in row.items()} for row in rows] == read
        assert memory.solid or same(memory.curves(number), files.curves(number))
    for contact in solution.last.contacts:
        rows, read = memory.instants_of(contact.name), files.instants_of(contact.name)
        assert [{key: str(value) for key, value in row.items()} for row in rows] == read
    assert (draw_history(memory).axes[0].get_xlim()) == draw_history(files).axes[0].get_xlim()


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


def lines_of(solution: sg.Solution) -> dict[str, tuple[Array, Array]]:
    """What the picture of a history draws of the forces: load factors and values by name."""
    forces = draw_history(HistoryData(solution, Fields(solution.model))).axes[2]
    solid = [line for line in forces.get_lines() if line.get_marker() == "None" and len(line.get_xdata()) > 1]
    values = [(np.array(line.get_xdata()), np.array(line.get_ydata())) for line in solid]
    return dict(zip(("normal", "friction"), values, strict=False))


def test_the_history_in_space_draws_friction_where_it_is() -> None:
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
    load, friction = lines_of(sg.solve(model))["friction"]
    for at, value in ((0.0, 0.0), (1.0, 0.0), (1.5, -1000.0), (2.0, 1000.0)):
        assert friction[load == at] == pytest.approx(value, abs=1e-6)
    first = sg.solve(replace(model, steps=model.steps[:1]))
    again = sg.solve(replace(model, steps=model.steps[1:]), start=first)
    load, normal = lines_of(again)["normal"]
    assert (load[0], normal[0]) == (0.5, pytest.approx(8000.0))


def test_a_damaged_history_is_told_or_drawn(tmp_path: Path) -> None:
    solution = sg.solve(zhu_cylinder(steps=[sg.Step(name="press")]))
    Publisher(folder=tmp_path, clock=Clock(), started=0.0).publish(solution)
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
