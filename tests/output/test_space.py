# SPDX-License-Identifier: BSD-3-Clause
"""Results of models in space as files and pictures."""

import csv
import json

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.output.folder import read_folder
from signorini.plot.picture_data import PictureData

DECK = """
title = "Ball on a block"

[mesh]
generator = "box"
x = [0, 0.25, 0.5, 0.75, 1, 1.5, 2.5, 4]
y = [0, 0.25, 0.5, 0.75, 1, 1.5, 2.5, 4]
z = [-4, -2, -1, -0.5, -0.25, 0]
cells = "{cells}"

[material.soft]
E = 1000.0
nu = 0.3

[[body]]
name = "block"
material = "soft"

[[support]]
on = "bottom"
u = [0, 0, 0]

[[obstacle]]
name = "ball"
sphere = {{ centre = [0.1, 0.0, 10], radius = 10 }}
u = [0.01, 0, "free"]
rotation = 0
force = ["free", "free", -40]

[[contact]]
nonmortar = "top"
mortar = "ball"
friction = 0.3

[[step]]
increments = 2
"""


@pytest.fixture(scope="module", params=["hexahedron", "tetra10"])
def results(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("space")
    deck = folder / "deck.toml"
    deck.write_text(DECK.format(cells=request.param))
    assert main(["run", str(deck), "-o", str(folder / "out")]) == 0
    return folder / "out"


def test_rows_sum_to_the_forces_of_the_summary(results):
    (step,) = json.loads((results / "summary.json").read_text())["steps"]
    (contact,) = step["contacts"]
    with (results / "contact.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    area, pressure, gap = (np.array([float(row[key]) for row in rows]) for key in ("area", "pressure", "gap"))
    shear = np.array([[float(row["traction_1"]), float(row["traction_2"])] for row in rows])
    assert (area > 0).all()
    assert (np.linalg.norm(shear, axis=1) <= 0.3 * pressure + 1e-9 * pressure.max()).all()
    assert (np.minimum(gap, pressure / pressure.max()) <= 1e-9).all()
    assert step["obstacles"]["ball"]["force"][2] == pytest.approx(-40, rel=1e-9)
    total = np.array(contact["normal_force"]) + contact["tangential_force"]
    assert total[2] == pytest.approx(-40, rel=1e-9)
    closed = [row["status"] for row in rows if float(row["pressure"]) > 0]
    assert set(closed) <= {"stick", "slip"}


def test_the_way_and_the_summary_speak_of_one_slip(results):
    (step,) = json.loads((results / "summary.json").read_text())["steps"]
    (contact,) = step["contacts"]
    with (results / "history.csv").open(newline="") as file:
        *_, last = csv.DictReader(file)
    assert contact["max_slip"] > 0
    assert float(last["max_slip"]) == contact["max_slip"]


def test_the_surface_file_holds_vectors(results):
    found = meshio.read(results / "contact.vtu")
    data = found.point_data
    forces = data["area"][:, None] * (data["pressure"][:, None] * data["normal"] + data["traction"])
    assert forces.sum(axis=0)[2] == pytest.approx(-40, rel=1e-9)
    assert set(np.unique(data["status"])) <= {0, 1, 2}
    np.testing.assert_allclose(np.sum(data["traction"] * data["normal"], axis=1), 0.0, atol=1e-12)
    np.testing.assert_array_equal(found.points[:, 2], 0.0)


@pytest.mark.slow
def test_pictures(results, tmp_path):
    (patch,) = PictureData(read_folder(results)).patches
    assert patch.chart.labels == ("x", "y")
    assert main(["plot", str(results), "-o", str(tmp_path / "map.png")]) == 0
    assert (tmp_path / "map.png").stat().st_size > 10_000
    for what in ("stress", "mesh"):
        assert main(["plot", str(results), "--what", what, "-o", str(tmp_path / f"{what}.png")]) == 0
        assert (tmp_path / f"{what}.png").stat().st_size > 30_000


def test_a_solution_draws_itself():
    model = sg.Model(
        sg.box(x=[0, 1, 2], y=[0, 1, 2], z=[0, 1]),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))],
        supports=[sg.Support("left", u=(0, None, None)), sg.Support("front", u=(None, 0, None))],
        loads=[sg.Load("top", pressure=0.1)],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)))],
    )
    solution = sg.solve(model)
    np.testing.assert_allclose(solution.contact("bottom").pressure, 0.1, rtol=1e-12)
    assert len(solution.plot().axes) == 3
    with pytest.raises(sg.InputError, match=r"in space open solution\.pvd"):
        solution.animate("film.gif")
