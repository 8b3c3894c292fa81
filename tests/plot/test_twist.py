# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of bodies of revolution that twist: what goes around the axis is drawn, and named."""

from dataclasses import replace

import pytest

import signorini as sg
from signorini.gallery.twisted import fit_under_torque
from signorini.plot.animation import film_of
from signorini.plot.contact import draw_contacts
from signorini.plot.field import draw_field
from signorini.plot.history import draw_history
from signorini.plot.picture_data import PictureData
from signorini.report.curves import forces, hysteresis, reactions
from signorini.report.sketch import sketch_contact


@pytest.fixture(scope="module")
def twisted():
    return sg.solve(fit_under_torque(turn=0.003, pull=0.02, n=(2, 2)))


def labels(figure):
    return {line.get_label() for axes in figure.axes for line in axes.get_lines()}


def test_both_tractions_are_drawn(twisted):
    data = PictureData(twisted)
    drawn = labels(draw_contacts(data))
    assert {"friction traction, along the tangent", "friction traction, around the axis"} <= drawn
    assert "torque over the largest radius" in labels(draw_history(data))
    assert "friction around the axis" in sketch_contact(twisted.last.contacts[0])
    assert draw_field(data, data.stress).axes
    titles = {chart.title for chart in (*hysteresis(data), *forces(data), *reactions(data))}
    assert {"fit: torque over the largest radius over slip", "torque of held", "fit: forces"} <= titles
    with pytest.raises(sg.InputError, match="not around an axis"):
        film_of(twisted)


def test_what_runs_away_around_the_axis_is_drawn():
    model = fit_under_torque(n=(2, 2))
    model = replace(
        model,
        supports=[model.supports[0], sg.Support("core", u=(0.0, 0.0, None))],
        loads=[sg.Load("core", force=(None, None, 3e5), name="torque")],
        steps=[sg.Step(scale={"torque": 0.0}), sg.Step(scale={"torque": 1.0}, increments=2)],
    )
    with pytest.raises(sg.SolveFailed, match="turn about the axis") as caught:
        sg.solve(model)
    figure = caught.value.solution.plot_escape()
    assert "around the axis" in figure.get_suptitle()
