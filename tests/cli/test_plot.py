# SPDX-License-Identifier: BSD-3-Clause
"""Pictures from result folders."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array
from signorini.cli import main
from signorini.clock import Clock
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.folder import Publisher, read_folder
from signorini.plot.curve import surface_coordinate
from signorini.plot.history import draw_history
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import picture
from tests.helpers.lifted_block import DECK

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("drag")
    assert main(["run", str(EXAMPLES / "block_drag.toml"), "-o", str(path), "--quiet"]) == 0
    return path


@pytest.mark.slow
@pytest.mark.parametrize("what", ["contact", "stress", "mesh", "history"])
def test_pictures_are_written(what: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(folder), "--what", what]) == 0
    file = folder / f"{what}.png"
    assert capsys.readouterr().out == f"{file}\n"
    assert file.read_bytes().startswith(b"\x89PNG")
    assert file.stat().st_size > 20_000


def test_names_of_files(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(folder), "-o", str(tmp_path / "a.doc")]) == 2
    assert "expected a name that ends in .png, .pdf, .svg" in capsys.readouterr().err
    assert main(["plot", str(folder), "-o", str(tmp_path / "none" / "a.png")]) == 2


def ball_on_block() -> sg.Model:
    """A rigid ball, rubbed on a corner of a block in space: a small one of the example."""
    grid = np.array([0.0, 0.5, 1.0, 1.6, 2.5, 4.0])
    return sg.Model(
        sg.box(x=grid, y=grid, z=-grid[::-1]),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("bottom", u=(0, 0, 0))],
        obstacles=[sg.Rigid("ball", sg.Sphere((0, 0, 10.0), 10.0), u=(0.01, 0, -0.05))],
        contacts=[sg.Contact("top", "ball", friction=0.3)],
        steps=[sg.Step(increments=2)],
    )


SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("zhu_cylinder", "ball_on_block", "indentation")]


@pytest.mark.parametrize("name", ["block_drag", *SLOW])
def test_pictures_show_the_same_from_memory_and_from_a_folder(name: str, tmp_path: Path) -> None:
    model = ball_on_block() if name == "ball_on_block" else sg.read(EXAMPLES / f"{name}.toml")
    if name == "indentation":
        model = replace(model, steps=model.steps[:1])
    solution = sg.solve(model)
    Publisher(folder=tmp_path, clock=Clock(), started=0.0, deck="").publish(solution)
    memory, folder = PictureData(solution), PictureData(read_folder(tmp_path))
    for what in ("contact", "history", "stress", "mesh"):
        shown, again = (painted(picture(data, what)) for data in (memory, folder))
        assert len(np.unique(shown.view(np.uint32))) > 20, what
        assert np.array_equal(shown, again), what


def painted(figure: Figure) -> Array:
    """The pixels of a figure, at a size that is painted fast."""
    figure.set_dpi(50)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba())


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


def test_folders_say_what_they_lack(tmp_path: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def said(path: Path, what: str = "contact") -> str:
        assert main(["plot", str(path), "--what", what]) == 2
        return capsys.readouterr().err

    assert "there is no folder" in said(tmp_path / "none")
    assert main(["report", str(tmp_path / "none")]) == 2
    assert f"there is no folder '{tmp_path / 'none'}'; expected one that 'signorini run'" in capsys.readouterr().err
    assert f"the folder '{tmp_path}' has no 'summary.json'" in said(tmp_path)
    shutil.copy(folder / "summary.json", tmp_path)
    assert f"the folder '{tmp_path}' has no 'solution.h5'\n" in said(tmp_path)
    failed = {"status": "no_equilibrium", "message": "it leaves"}
    (tmp_path / "summary.json").write_text(json.dumps(failed))
    assert "has no 'solution.h5': the run ended with 'no_equilibrium': it leaves" in said(tmp_path)
    deck = tmp_path / "lift.toml"
    deck.write_text(DECK)
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 3
    assert f"the results in '{tmp_path / 'out'}' hold no step: the run ended with 'no_equilibrium'" in said(
        tmp_path / "out"
    )
    deck.write_text(DECK.partition("contact")[0] + 'support = [{on = "bottom", u = [0.0, 0.0]}]')
    assert main(["run", str(deck), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert "have no contact to draw" in said(tmp_path / "out", "history")


@pytest.mark.slow
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
    forces = draw_history(PictureData(solution)).axes[2]
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
