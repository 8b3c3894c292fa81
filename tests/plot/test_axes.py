# SPDX-License-Identifier: BSD-3-Clause
"""Axes of pictures: units of the deck, arc length on sides that lean or bend, directions by their letters."""

import math
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.plot.curve import place_along
from signorini.plot.field import draw_field
from signorini.plot.history import draw_history
from signorini.plot.picture_data import PictureData
from signorini.plot.style import literal

BODY = sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))


def slope(angle, units):
    """A block pressed on a plane that leans."""
    mesh, turn = (
        sg.rectangle(width=2.0, nx=4, ny=2),
        np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]),
    )
    mesh = replace(mesh, points=mesh.points @ turn.T)
    plane = sg.Plane((0, 0), (-math.sin(angle), math.cos(angle)))
    contact = sg.Contact("bottom", plane, friction=0.3, name="slope, force")
    return sg.solve(
        sg.Model(mesh, bodies=[BODY], supports=[sg.Support("top", u=(0.01, -0.01))], contacts=[contact], units=units)
    )


def labels(figure):
    return {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}


@pytest.fixture(scope="module")
def leaning():
    return slope(0.5, "N, mm, MPa")


def test_axes_have_the_units_of_the_deck(leaning):
    place = "arc length along 'slope, force', undeformed, mm"  # a name is no quantity
    assert labels(leaning.plot()) == {place, "pressure and friction, MPa"}
    data = PictureData(leaning)
    history = labels(literal(draw_history(data), data.units))
    assert {place, "pressure, MPa", "force on the nonmortar body, N", "dissipated, N mm"} <= history
    assert {"x, mm", "y, mm", "von Mises stress, MPa"} <= labels(literal(draw_field(data, data.stress), data.units))


def test_without_units_the_quantity_is_said():
    assert labels(slope(0.0, "as given, consistent").plot()) == {
        "x along 'slope, force', undeformed",
        "pressure and friction, force per area",
    }


def test_a_side_that_leans_is_drawn_over_its_length(leaning):
    (line, *_) = leaning.plot().axes[0].get_lines()
    np.testing.assert_allclose(line.get_xdata(), [0.0, 0.5, 1.0, 1.5, 2.0], rtol=1e-12)


def test_a_bend_counts_where_sides_touch():
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 41)
    arc = np.column_stack([np.sin(turn), 1.0 - np.cos(turn)])
    near = np.abs(turn) < 0.2
    axis, s = place_along(arc, near)
    assert axis == "x"
    np.testing.assert_array_equal(s, arc[:, 0])
    axis, s = place_along(arc, np.ones(41, bool))
    assert axis == "arc length"
    assert np.ptp(s) == pytest.approx(np.pi, rel=1e-3)
    assert place_along(arc, np.zeros(41, bool))[0] == "arc length"


def test_steps_share_one_coordinate():
    """Pairs that touch at the end of any step decide, so that profiles of one picture lie over each other."""
    ball = sg.half_disk(radius=4.0, contact_length=2.0, contact_spacing=0.5)
    model = sg.Model(
        ball,
        bodies=[sg.Body("disk", sg.Elastic(E=10.0, nu=0.3))],
        supports=[sg.Support("cut", u=(0, -1.2), name="hand")],
        contacts=[sg.Contact("arc", sg.Plane((0, 0), (0, 1)))],
        steps=[sg.Step(scale={"hand": 0.02}), sg.Step(scale={"hand": 1.0})],
    )
    data = PictureData(sg.solve(model))
    (light,), (heavy,) = data.curves(1), data.curves(2)
    assert light.place == heavy.place
    np.testing.assert_array_equal(light.s, heavy.s)


def test_around_an_axis_places_are_radii():
    model = sg.Model(
        sg.rectangle(x=[0, 1, 2], y=[0, 1]),
        kind="axisymmetric",
        bodies=[BODY],
        loads=[sg.Load("top", pressure=1.0)],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)))],
    )
    (curve,) = PictureData(sg.solve(model)).curves()
    assert curve.place == "r along 'bottom', undeformed, length"


def test_friction_in_space_is_along_an_axis_by_its_letter():
    model = sg.Model(
        sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]),
        bodies=[BODY],
        supports=[sg.Support("top", u=(0.02, 0, -0.01))],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=0.3)],
    )
    figure = draw_history(PictureData(sg.solve(model)))
    words = {text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()}
    assert "friction force, along x" in words
