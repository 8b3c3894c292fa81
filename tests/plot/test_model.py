# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a model before it is solved, and the units on axes."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.quiver import Quiver

import signorini as sg
from signorini.plot.units import units_of

EXAMPLES = Path(__file__).parents[2] / "examples"
BLOCK = sg.Body("block", sg.Elastic(E=100.0, nu=0.0, expansion=1e-5))


def arrows(model):
    (axes,) = model.plot().axes
    return [(np.array(q.get_offsets()), np.column_stack([q.U, q.V])) for q in axes.findobj(Quiver)]


def block(**more):
    return sg.Model(sg.rectangle(width=2.0, nx=2), bodies=[BLOCK], **more)


def test_arrows_point_to_what_is_held_and_the_way_that_loads_push():
    support, load = arrows(
        block(supports=[sg.Support("left", u=(0, None))], loads=[sg.Load("top", pressure=3.0)], units="mm, N")
    )
    tips = support[0] + support[1]
    assert np.allclose(tips[:, 0], 0.0)
    assert set(tips[:, 1].tolist()) == {0.0, 1.0}
    assert (support[1][:, 0] > 0).all()
    assert np.allclose(support[1][:, 1], 0.0)
    assert np.allclose((load[0] + load[1])[:, 1], 1.0)
    assert (load[1][:, 1] < 0).all()  # a pressure pushes on the body
    pulled = arrows(block(loads=[sg.Load("right", force=(5.0, None))]))[0]
    assert (pulled[1][:, 0] > 0).all()
    assert np.allclose(pulled[1][:, 1], 0.0)


def test_boundaries_and_bodies_are_named_and_what_has_no_arrow_is_said():
    hot = block(
        loads=[sg.Load("block", temperature=5.0, name="sun"), sg.Load("block", body_force=(0, -9.81))], title="a $b$"
    )
    figure = hot.plot()
    (axes,) = figure.axes
    names = {text.get_text() for text in axes.texts}
    assert names == {"left", "right", "top", "bottom"}
    assert {text.get_text() for text in figure.legends[0].get_texts()} == {"block", "loads"}
    assert "not drawn: sun (temperature)" in figure.get_suptitle()
    assert figure.get_suptitle().startswith("a $b$\n")
    assert axes.get_xlabel() == "x"


def test_names_stand_in_the_middle_of_their_boundaries_however_fine_the_mesh_is_at_one_end():
    x = np.concatenate([np.linspace(0.0, 0.1, 30), np.linspace(0.2, 2.0, 10)])
    (axes,) = sg.Model(sg.rectangle(x=x, y=[0.0, 1.0]), bodies=[BLOCK]).plot().axes
    (top,) = [text for text in axes.texts if text.get_text() == "top"]
    assert abs(top.get_position()[0] - 1.0) < 0.11


@pytest.mark.parametrize("name", ["bolted_joint", "ball_on_block", "wear"])
def test_examples_are_drawn(name, tmp_path):
    figure = sg.read(EXAMPLES / f"{name}.toml").plot()
    figure.savefig(tmp_path / "model.png", dpi=40)
    assert (tmp_path / "model.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("words", "length", "pressure", "work"),
    [
        ("N, mm, MPa", "mm", "MPa", "N mm"),
        ("mm, N, MPa, t", "mm", "MPa", "N mm"),
        ("SI: m, N", "m", "Pa", "N m"),
        ("as given, consistent", "length", "force per area", "work"),
        ("mm or m", "length", "force per area", "work"),  # two lengths: none is meant
    ],
)
def test_units_are_those_that_are_named(words, length, pressure, work):
    units = units_of(words)
    assert (units.length, units.pressure, units.work) == (length, pressure, work)
