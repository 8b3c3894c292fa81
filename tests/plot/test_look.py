# SPDX-License-Identifier: BSD-3-Clause
"""Pictures show the moment, component, range and part that are asked for, and refuse by name what they cannot."""

import numpy as np
import pytest
from matplotlib.quiver import Quiver

import signorini as sg
from signorini.cli import main
from signorini.cli.parser import PICTURES as NAMES
from signorini.clock import Clock
from signorini.output.fields import BodyFields
from signorini.output.folder import Publisher
from signorini.plot.components import colours_of, stress_component
from signorini.plot.look import Look
from signorini.plot.pictures import PICTURES


@pytest.fixture(scope="module")
def pushed():
    """A block that is pressed on the ground, then pushed along; the same in space."""
    steps = [sg.Step(name="press", scale={"press": 1, "push": 0}), sg.Step(name="push", scale={"push": 1})]
    loads = {2: [("top", (0, -4.0)), ("right", (-1.0, 0))], 3: [("top", (0, 0, -4.0)), ("right", (-1.0, 0, 0))]}
    found = {}
    for d, mesh in ((2, sg.rectangle(width=2.0, nx=4, ny=2)), (3, sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]))):
        (press, down), (push, along) = loads[d]
        found[d] = sg.solve(
            sg.Model(
                mesh,
                kind="plane strain" if d == 2 else "3d",
                bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
                supports=[
                    sg.Support("left", u=(0, None, None)[:d]),
                    *([sg.Support("front", u=(None, 0, None))] * (d == 3)),
                ],
                loads=[sg.Load(press, traction=down, name="press"), sg.Load(push, traction=along, name="push")],
                contacts=[
                    sg.Contact("bottom", sg.Plane(point=(0,) * d, normal=(0, 0, 1)[-d:]), friction=0.4, name="ground")
                ],
                steps=steps,
                units="mm, N, MPa",
            )
        )
    return found


def shown(figure):
    """Words of the title, of the colour bar, and its range."""
    bar = figure.axes[-1]
    return figure.get_suptitle(), bar.get_ylabel(), bar.get_ylim()


def test_a_moment_between_two_events(pushed):
    """Half of the way of the first step presses with half the pressure: all is linear before anything slips."""
    half = pushed[2].plot(step="press", load=0.5)
    whole = pushed[2].plot(step=1)
    first, last = (figure.axes[0].get_lines()[0].get_ydata() for figure in (half, whole))
    np.testing.assert_allclose(first, 0.5 * last, atol=1e-12)
    assert half.axes[0].get_title(loc="left") == "ground, step 'press' at 0.5 of it"
    assert whole.axes[0].get_title(loc="left") == "ground, end of step 'press'"


@pytest.mark.parametrize("d", [2, 3])
def test_a_component_of_the_stress_in_a_range(pushed, d):
    where = " on the skin" * (d == 3)
    title, words, ends = shown(pushed[d].plot("stress", component=["yy", "zz"][d - 2], range=(-3, 0.5), scale=0))
    assert title == "undeformed; end of step 'push'"
    assert words.startswith(f"stress {['yy', 'zz'][d - 2]}{where}, MPa (elsewhere ")
    assert ends == (-3, 0.5)
    _, words, _ = shown(pushed[d].plot("stress", component="principal"))
    assert words.startswith(f"largest principal stress{where}, MPa")


@pytest.mark.parametrize("d", [2, 3])
def test_displacements_are_drawn_as_large_as_is_asked(pushed, d):
    title, words, _ = shown(pushed[d].plot("displacement", component="x", scale=7))
    assert title == "deformed, displacements x 7; end of step 'push'"
    assert words == f"displacement along x{' on the skin' * (d == 3)}, mm"


def test_a_part_of_the_bodies(pushed):
    figure = pushed[2].plot("mesh", zoom=(0.2, 1.0, -0.1, 0.4))
    (axes,) = figure.axes
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.2, 1.0), (-0.1, 0.4))
    assert pushed[2].plot(zoom=(0.5, 1.5), range=(-1, 9)).axes[0].get_xlim() == (0.5, 1.5)
    whole, part = (pushed[3].plot("stress", zoom=zoom) for zoom in (None, (1.5, 2, 0, 1, 0, 1)))
    assert len(part.axes) < len(whole.axes) or np.ptp(part.axes[0].get_xlim()) < np.ptp(whole.axes[0].get_xlim())
    patch = pushed[3].plot(zoom=(0, 1, 0, 0.5), range=(0, 20))
    assert patch.axes[0].get_ylim() == (0, 0.5)
    assert patch.axes[-1].get_ylim() == (0, 20)


def test_colours_of_fields_of_one_and_two_signs():
    assert colours_of(np.array([-4.0, -1e-12]), None) == (-4.0, 0.0, "viridis_r")
    assert colours_of(np.array([-1.0, 4.0]), None) == (-4.0, 4.0, "RdBu_r")
    assert colours_of(np.zeros(3), None) == (0.0, 1.0, "viridis")
    assert colours_of(np.zeros(3), (-1.0, 2.0)).map == "RdBu_r"


def test_principal_stresses_of_a_known_state():
    one, stress = np.zeros((1, 2)), np.array([[1.0, 1.0, 5.0, 2.0, 0.0, 0.0]])
    shapes = {"node": np.zeros(1, np.int64), "families": (), "cells": (), "body": ()}
    fields = BodyFields(points=one, displacement=one, stress=stress, **shapes)
    for name, value in (("principal", 5.0), ("least_principal", -1.0), ("tt", 5.0), ("rz", 2.0)):
        assert stress_component(fields, "axisymmetric", name).values == pytest.approx(value)


WRONG = [
    ("stresses", {}, "what: unknown picture 'stresses'; did you mean 'stress'"),
    ("contact", {"component": "xx"}, "component: is no choice of the picture 'contact'; expected one of stress, displ"),
    ("history", {"step": 1}, "step: is no choice of the picture 'history'"),
    ("stress", {"component": "xz2"}, "component: unknown component of the stress 'xz2'; did you mean 'xz'"),
    ("displacement", {"component": "z"}, "component: unknown component of the displacement 'z'"),
    ("stress", {"zoom": (0, 1)}, "zoom: is 0 1; expected 4 numbers: x from and to, y from and to"),
    ("contact", {"zoom": (0, 1, 2, 3)}, "zoom: is 0 1 2 3; expected 2 numbers: along from and to"),
    ("stress", {"zoom": (1, 0, 0, 1)}, "zoom: is 1 0 0 1; expected each first number below its second"),
    ("stress", {"range": (2, 1)}, "range: is 2 1; expected each first number below"),
    ("stress", {"range": (np.nan, 1)}, "range: is nan 1; expected finite numbers"),
    ("stress", {"range": (1,)}, "range: has 1 numbers; expected the smallest and the largest"),
    ("stress", {"scale": -1.0}, "scale: is -1; expected a factor >= 0"),
    ("stress", {"step": 3}, "step: is 3; expected the number of a step, 1 to 2"),
    ("stress", {"step": "pull"}, "step: unknown step 'pull'"),
    ("stress", {"load": 1.5}, "load: is 1.5; expected"),
    ("peeq", {}, "peeq: has no body that yields"),
]


@pytest.mark.parametrize(("what", "choices", "words"), WRONG)
def test_what_cannot_be_drawn_is_refused_by_name(pushed, what, choices, words):
    with pytest.raises(sg.InputError) as refusal:
        pushed[2].plot(what, **choices)
    assert str(refusal.value).startswith(words)


def test_a_box_without_a_body(pushed):
    with pytest.raises(sg.InputError, match="zoom: holds no part of the surface of a body"):
        pushed[3].plot("stress", zoom=(5, 6, 5, 6, 5, 6))


def test_the_command_line_has_the_same_choices(pushed, tmp_path, capsys):
    assert set(NAMES) == set(PICTURES)
    Publisher(folder=tmp_path, clock=Clock(), started=0.0).publish(pushed[2])
    asked = ["--step", "1", "--load", "0.5", "--component", "xy", "--range", "-1", "1", "--scale", "10"]
    asked += ["--zoom", "0", "1", "0", "0.5"]
    for suffix in ("svg", "pdf"):
        assert main(["plot", str(tmp_path), "--what", "stress", *asked, "-o", str(tmp_path / f"a.{suffix}")]) == 0
    text = (tmp_path / "a.svg").read_text()
    assert "<svg" in text
    assert "stress xy, MPa" in text
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    capsys.readouterr()
    assert main(["plot", str(tmp_path), "--what", "stress", "--zoom", "0", "1"]) == 2
    assert capsys.readouterr().err == "signorini: --zoom: is 0 1; expected 4 numbers: x from and to, y from and to\n"
    assert main(["plot", str(tmp_path), "--step", "press", "--load", "2"]) == 2
    assert capsys.readouterr().err.startswith("signorini: --load: is 2; ")


def test_words_of_a_look():
    assert Look(range=(0, 1), scale=2.0).asked == ["range", "scale"]


@pytest.mark.parametrize("d", [2, 3])
def test_legends_are_below_the_axes_and_arrows_within_them(pushed, d):
    """What is drawn is neither hidden nor cut off."""
    figure = pushed[d].plot()
    figure.canvas.draw()
    axes = next(axes for axes in figure.axes if axes.get_legend())
    assert axes.get_legend().get_window_extent().y1 < axes.get_window_extent().y0
    if d == 3:
        (arrows,) = (artist for artist in axes.collections if isinstance(artist, Quiver))
        along = np.column_stack([arrows.U, arrows.V]) / arrows.scale
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        tips = arrows.get_offsets() + along
        assert np.abs(along).max() > 0.01 * (right - left)
        assert ((tips > (left, low)) & (tips < (right, high))).all()


def test_what_pyvista_renders_is_asked_for_by_its_own_name(pushed):
    with pytest.raises(sg.InputError, match=r"what: is 'view', .*expected solution.view\(path\)"):
        pushed[3].plot("view")
