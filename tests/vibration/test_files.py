"""Files, tables and pictures of modes and of what a joint damps."""

import csv

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.gallery.vibrating import bar_in_a_bed
from signorini.model.modes import JOINTS
from signorini.output.modes_files import write_damping, write_loops, write_modes, write_shapes
from signorini.output.modes_table import damping_table, modes_table
from signorini.plot.modes import draw_damping, draw_modes
from signorini.vibration.modes import modes_by_joint


def rows(path):
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def bar():
    model, exact = bar_in_a_bed(cells=6)
    solution = sg.solve(model)
    return solution, sg.joint_damping(solution, [exact.amplitude(share) for share in (0.3, 0.6)])


def test_files_of_modes_say_what_modes_are(tmp_path, bar):
    solution, _ = bar
    modes = modes_by_joint(solution.model, 3, JOINTS, solution.end)
    write_modes(modes, tmp_path / "modes.csv")
    found = rows(tmp_path / "modes.csv")
    assert [row["joint"] for row in found] == [joint for joint in JOINTS for _ in range(3)]
    assert float(found[1]["frequency"]) == modes["stuck"].frequencies[1]
    assert float(found[0]["effective_mass_x"]) == modes["stuck"].effective_masses[0, 0]
    write_shapes(solution.model, modes, tmp_path / "modes.vtu")
    grid = meshio.read(tmp_path / "modes.vtu")
    assert grid.point_data["slipping_2"][:, :2] == pytest.approx(modes["slipping"].shapes[1])
    words = modes_table(modes, "at rest")
    assert words.splitlines()[0] == "natural frequencies at rest, cycles per time"
    assert words.splitlines()[1].split() == ["mode", "stuck", "joint", "slipping", "joint", "open", "joint"]
    assert words.endswith("none is missing, by the inertia of K - sigma M")


def test_effective_masses_add_up_to_the_mass():
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=3, ny=2),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3, density=3.0))],
        supports=[sg.Support(at, u=u) for at, u in (((0.0, 0.0), (0, 0)), ((2.0, 0.0), (None, 0)))],
    )
    masses = sg.natural_modes(model, 21).effective_masses.sum(axis=0)
    assert (masses < 6.0).all()  # what is held does not move with any mode
    assert masses == pytest.approx(6.0, rel=0.2)


def test_files_of_damping_say_what_loops_are(tmp_path, bar):
    _, damping = bar
    write_damping(damping, tmp_path / "damping.csv")
    found = rows(tmp_path / "damping.csv")
    assert [float(row["damping_ratio"]) for row in found] == damping.ratios.tolist()
    assert found[0]["exponent"] == ""
    assert float(found[1]["exponent"]) == damping.exponents[0]
    write_loops(damping, tmp_path / "loops.csv")
    points = [float(row["modal_force"]) for row in rows(tmp_path / "loops.csv") if row["loop"] == "2"]
    assert points == damping.loops[1].force.tolist()
    words = damping_table(damping).splitlines()
    assert words[0].startswith("mode 1 of the stuck joint (2.507")
    assert words[3].split()[0] == f"{damping.amplitudes[1]:.4g}"


def test_pictures_show_every_joint_and_every_loop(bar):
    solution, damping = bar
    modes = modes_by_joint(solution.model, 2, JOINTS, solution.end)
    figure = draw_modes(solution.model, modes)
    assert [axes.get_title(loc="left").split(",")[0] for axes in figure.axes] == [j for j in JOINTS for _ in range(2)]
    drawn = draw_damping(damping, "bar").axes
    assert len(drawn[0].get_lines()) == 2 + 1  # and a line at 0
    assert drawn[2].get_lines()[0].get_ydata() == pytest.approx(damping.ratios)


def test_bodies_in_space_are_drawn():
    mesh = sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1])
    model = sg.Model(mesh, bodies=[sg.Body(name, sg.Elastic(E=1.0, nu=0.3, density=1.0)) for name in mesh.bodies])
    modes = sg.natural_modes(model, 8)
    figure = draw_modes(model, {"stuck": modes})
    assert len(figure.axes) == 6
    assert figure.axes[0].get_title(loc="left") == "0"
    assert np.isfinite(modes.frequencies).all()
