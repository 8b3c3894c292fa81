# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles in pictures are where bodies lie against them, within steps too."""

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet

import signorini as sg
from signorini.output.dataclasses_json import from_plain, to_plain
from signorini.output.summary import summary
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import picture
from signorini.plot.walls import walls_of

PUNCH = sg.Profile([(3.0, 3.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0)], fillet=0.2)


PLANE, ROUND = sg.Plane((0.0, 1.2), (0.0, -1.0)), sg.Circle((2.0, 3.0), 2.0)


@pytest.mark.parametrize(("shape", "u"), [(PLANE, (0.1, -0.25)), (PUNCH, (0.05, -0.1)), (ROUND, (-0.03, -0.2))])
def test_closed_nodes_lie_on_the_obstacle_where_it_is_drawn(shape, u):
    model = sg.Model(
        sg.rectangle(width=4, height=1, nx=32, ny=8),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("bottom", u=(0, 0))],
        obstacles=[sg.Rigid("tool", shape, u=u)],
        contacts=[sg.Contact("top", "tool", name="seat")],
    )
    solution = sg.solve(model)
    data = PictureData(solution)
    (wall,) = data.walls
    contact = solution.contact("seat")
    moved = (data.bodies.points + data.bodies.displacement)[contact.node]
    depth = wall.depth(moved, moved=True)
    allowed = (1e-9 if isinstance(shape, sg.Plane) else 0.1) * abs(u[1])  # gaps are linear in the displacements
    assert contact.closed.sum() > 5
    assert np.abs(depth[contact.closed]).max() < allowed
    assert depth.max() < allowed
    for what in ("mesh", "stress"):
        assert picture(data, what).axes[0].get_ylim()[1] > 1.0


def pressed(way, rigid):
    """A block that is free to widen, under a plate 0.2 above it."""
    return sg.solve(
        sg.Model(
            sg.rectangle(width=4, height=1, nx=4, ny=2),
            bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
            supports=[sg.Support("bottom", u=(None, 0)), sg.Support("left", u=(0, None))],
            obstacles=[sg.Rigid("plate", sg.Plane((0.0, 1.2), (0.0, -1.0)), **rigid)],
            contacts=[sg.Contact("top", "plate")],
            steps=[sg.Step(**way)],
        )
    )


def drawn(figure):
    """Height of the line at which an obstacle of a picture begins."""
    lines = [artist for artist in figure.axes[0].collections if isinstance(artist, QuadContourSet)]
    return float(np.mean(lines[-1].get_paths()[0].vertices[:, 1]))


WAYS = [{"path": "exact"}, {"at": [0.5]}, {"path": "exact", "at": "events"}, {"increments": 2}]


@pytest.mark.parametrize("way", WAYS)
def test_half_of_a_prescribed_motion_is_half_way(way):
    solution = pressed(way, {"u": (0.1, -0.3), "rotation": 0.0})
    moment = solution.at(load=0.5)
    np.testing.assert_allclose(moment.motions["plate"].displacement, [0.05, -0.15], rtol=1e-12)
    assert drawn(solution.plot("stress", load=0.5, scale=1.0)) == pytest.approx(1.2 - 0.15, abs=1e-9)
    assert drawn(solution.plot("stress", scale=1.0)) == pytest.approx(1.2 - 0.3, abs=1e-9)


@pytest.mark.parametrize("way", WAYS)
def test_an_obstacle_under_half_of_its_force_is_where_that_presses_it(way, tmp_path):
    """Pressure F / b on a block that is free to widen shortens it by p h (1 - nu^2) / E, after the plate fell on it."""
    solution = pressed(way, {"u": (0, None), "force": (None, -10.0)})
    fallen = 0.2 + 0.5 * 10.0 / 4.0 * (1.0 - 0.3**2) / 100.0
    assert drawn(solution.plot("stress", load=0.5, scale=1.0)) == pytest.approx(1.2 - fallen, abs=1e-9)
    solution.write(tmp_path / "all.h5")
    again = sg.load(tmp_path / "all.h5").at(load=0.5).motions["plate"]
    np.testing.assert_allclose(again.displacement, [0.0, -fallen], atol=1e-10)
    kept = [each for each in summary(solution, {})["steps"][0]["on_the_way"] if each["load_factor"] == 0.5]
    assert len(kept) == (way == {"at": [0.5]})
    for each in kept:
        assert each["what"] == "asked"
        assert each["motions"]["plate"]["displacement"] == pytest.approx([0.0, -fallen])


def test_a_rigid_body_within_a_step():
    """A hub turns a beam's end: half of the angle at half of the load."""
    model = sg.Model(
        sg.rectangle(width=4, height=1, nx=4, ny=1),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, 0)), sg.Support("hub", u=(None, None, 0.02))],
        rigid_bodies=[sg.RigidBody("hub", on="right", point=(4.0, 0.5))],
        steps=[sg.Step(at=[0.25, 0.5])],
    )
    step = sg.solve(model).steps[0]
    quarter, half = (instant.motions["hub"] for instant in step.instants[:2])
    assert (quarter.rotation, half.rotation, step.motions["hub"].rotation) == pytest.approx((0.005, 0.01, 0.02))
    np.testing.assert_allclose(2.0 * quarter.displacement, half.displacement, rtol=1e-9)


def test_archives_from_before_motions_were_kept_draw_what_they_know():
    """An instant without its obstacles' motions is read; no obstacle is drawn at a place that is not known."""
    solution = pressed({"at": [0.5]}, {"u": (0, -0.3)})
    instant = solution.steps[0].instants[0]
    arrays = {}

    def keep(path, array, _):
        arrays[path] = array
        return path

    plain = to_plain(instant, "instant", keep)
    del plain["of"]["motions"]
    older = from_plain(plain, arrays.__getitem__)
    assert older.motions is None
    assert walls_of(solution.model, older) == []
    assert len(walls_of(solution.model, instant)) == 1
