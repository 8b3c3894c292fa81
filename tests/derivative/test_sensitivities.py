# SPDX-License-Identifier: BSD-3-Clause
"""The table of sensitivities: what dimensions alone say of it, and the command that prints it."""

import json
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.sensitivities_file import read_sensitivities, write_sensitivities
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


def test_space_has_them_too():
    found = sg.solve(ball_rig(increments=1), tape=True).sensitivities()
    assert all(holds.low < 0.0 < holds.high for holds in found.holds)
    scaled = row(found, "load.pull") + row(found, "E.pad") + row(found, "E.block")
    assert scaled == pytest.approx(np.ones(len(found.outputs)), abs=1e-6)


def test_the_command_prints_them(capsys, tmp_path):
    assert main(["sensitivities", "examples/zhu_cylinder.toml"]) == 0
    told = capsys.readouterr().out
    assert "peak pressure of 'foundation'" in told
    assert "friction.foundation" in told
    assert "what ends that" in told
    assert main(["sensitivities", "examples/zhu_cylinder.toml", "--json", "-o", str(tmp_path)]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [part["parameter"] for part in data["parameters"]][1] == "load.cut"
    assert data["parameters"][0]["holds_per_cent"]["low"] < 0.0
    assert json.loads((tmp_path / "sensitivities.json").read_text()) == data
    assert main(["sensitivities", "examples/indentation.toml"]) == 2
    assert "bodies that yield" in capsys.readouterr().err


def test_reports_have_a_section_of_them(tmp_path):
    """Of what was computed, with words of users as text, whatever signs they hold."""
    model = zhu_cylinder()
    contacts = [replace(model.contacts[0], name="<b>foundation")]
    solution = sg.solve(replace(model, contacts=contacts), tape=True)
    solution.report(tmp_path / "without.html")
    assert "Sensitivities" not in (tmp_path / "without.html").read_text()
    solution.sensitivities()
    solution.report(tmp_path / "with.html")
    page = (tmp_path / "with.html").read_text()
    assert "<h2>Sensitivities</h2>" in page
    assert "friction.&lt;b&gt;foundation" in page
    assert "<b>foundation" not in page


def test_a_folder_keeps_them_and_its_report_shows_those_of_its_run(found, tmp_path, capsys):
    solution = sg.solve(zhu_cylinder())
    solution.save_results(tmp_path)
    write_sensitivities(found, tmp_path)
    again = read_sensitivities(tmp_path)
    assert again.parameters == found.parameters
    assert again.holds == found.holds
    assert np.array_equal(again.per_cent, found.per_cent)
    assert (tmp_path / "sensitivities.csv").read_text().count("\n") == 1 + len(found.parameters)
    assert main(["report", str(tmp_path)]) == 0
    assert "<h2>Sensitivities</h2>" in (tmp_path / "report.html").read_text()
    write_sensitivities(replace(found, values=1.1 * found.values), tmp_path)
    assert main(["report", str(tmp_path)]) == 0
    assert "of another run" in capsys.readouterr().err
    assert "<h2>Sensitivities</h2>" not in (tmp_path / "report.html").read_text()
    (tmp_path / "sensitivities.json").write_text('{"outputs": 1}')
    assert main(["report", str(tmp_path)]) == 2
    assert "holds no sensitivities" in capsys.readouterr().err
