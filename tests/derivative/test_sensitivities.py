# SPDX-License-Identifier: BSD-3-Clause
"""The table of sensitivities: what dimensions alone say of it, and the command that prints it."""

import json

import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.gallery.cylinder import zhu_cylinder
from tests.derivative.rig import ball_rig


@pytest.fixture(scope="module")
def found():
    return sg.solve(zhu_cylinder(), tape=True).sensitivities()


def row(found, parameter):
    return found.per_cent[found.parameters.index(parameter)]


def test_stresses_and_lengths_scale_as_their_dimensions(found):
    """All loads and moduli by one factor: pressures, forces and works by the same, lengths stay."""
    assert found.parameters == ("friction.foundation", "load.cut", "E.disk", "nu.disk")
    peak, normal, friction, width, taken = row(found, "load.cut") + row(found, "E.disk")
    assert [peak, normal, friction, taken] == pytest.approx([1.0] * 4, abs=1e-9)
    assert width == pytest.approx(0.0, abs=1e-9)
    assert row(found, "load.cut")[1] == pytest.approx(1.0, abs=1e-9)


def test_hertz_is_what_they_are_near(found):
    """p ~ (F E*)^1/2 and a ~ (F / E*)^1/2; the mesh is coarse."""
    assert row(found, "load.cut")[0] == pytest.approx(0.5, abs=0.03)
    assert row(found, "load.cut")[3] == pytest.approx(0.5, abs=0.08)
    assert all(holds.low < 0.0 < holds.high for holds in found.holds)


def test_space_has_them_without_intervals():
    found = sg.solve(ball_rig(increments=1), tape=True).sensitivities()
    assert set(found.holds) == {None}
    scaled = row(found, "load.pull") + row(found, "E.pad") + row(found, "E.block")
    assert scaled == pytest.approx(np.ones(len(found.outputs)), abs=1e-6)


def test_the_command_prints_them(capsys):
    assert main(["sensitivities", "examples/zhu_cylinder.toml"]) == 0
    told = capsys.readouterr().out
    assert "peak pressure of 'foundation'" in told
    assert "friction.foundation" in told
    assert "what ends that" in told
    assert main(["sensitivities", "examples/zhu_cylinder.toml", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [part["parameter"] for part in data["parameters"]][1] == "load.cut"
    assert data["parameters"][0]["holds_per_cent"]["low"] < 0.0
    assert main(["sensitivities", "examples/indentation.toml"]) == 2
    assert "bodies that yield" in capsys.readouterr().err
