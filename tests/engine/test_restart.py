# SPDX-License-Identifier: BSD-3-Clause
"""A history that goes on from the end of another is the whole one, through a file too; what does not fit is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.gallery.cylinder import zhu_cylinder

FIRST = [sg.Step(name="press"), sg.Step(name="off", scale={"cut": 0.4})]
SECOND = [sg.Step(name="again", scale={"cut": [0.9, 0.2]})]


def cylinder(steps, **changes):
    return zhu_cylinder(refine=2, steps=steps, **changes)


@pytest.mark.parametrize("number", [None, 3])
def test_two_runs_are_one(tmp_path: Path, number) -> None:
    first, second = ([replace(step, increments=number) for step in steps] for steps in (FIRST, SECOND))
    whole = sg.solve(cylinder(first + second))
    before = sg.solve(cylinder(first))
    before.save_state(tmp_path / "state.npz")
    assert [file.name for file in tmp_path.iterdir()] == ["state.npz"]
    for start in (before, tmp_path / "state.npz"):
        after = sg.solve(cylinder(second), start=start)
        (found,), (expected,) = after.last.contacts, whole.last.contacts
        for name in ("pressure", "traction", "slip", "gap", "sliding"):
            one, two = getattr(found, name), getattr(expected, name)
            np.testing.assert_allclose(one, two, rtol=0, atol=1e-10 * np.abs(two).max())
        assert after.last.work == pytest.approx(whole.last.work, rel=1e-9)
        assert abs(after.last.energy_defect - whole.last.energy_defect) < 1e-10 * abs(after.last.work)
        assert after.last.dissipation == pytest.approx(whole.last.dissipation, rel=1e-9)


def test_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    before = sg.solve(cylinder(FIRST))
    model = cylinder(SECOND)
    stiffer = replace(model, bodies=[sg.Body("disk", sg.Elastic(E=300.0, nu=0.3))])
    renamed = replace(model, contacts=[replace(model.contacts[0], name="floor")])
    unloaded = replace(model, loads=[replace(model.loads[0], name="top")], steps=[sg.Step()])
    for wrong, message in (
        (zhu_cylinder(refine=1), r"^start: was computed on another mesh \(\d+ dofs; the model has 186\)"),
        (renamed, r"^start: has the contacts foundation; the model has floor"),
        (unloaded, r"^start: carries 'cut' at factor 0.4, which the model has not"),
        (stiffer, r"^start: is not in equilibrium in this model"),
    ):
        with pytest.raises(sg.InputError, match=message):
            sg.solve(wrong, start=before)
    (tmp_path / "torn.npz").write_bytes(b"PK")
    with pytest.raises(sg.InputError, match="is no state that a run has written"):
        sg.solve(model, start=tmp_path / "torn.npz")
    with pytest.raises(sg.InputError, match="there is no file"):
        sg.solve(model, start=tmp_path / "none.npz")


def test_the_command_line_goes_on(tmp_path: Path) -> None:
    deck = (Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml").read_text()
    deck = deck[: deck.index("[[step]]")]
    for name, factors in (("one", "0.5"), ("two", "1.0"), ("whole", "[0.5, 1.0]")):
        (tmp_path / f"{name}.toml").write_text(f"{deck}\n[[step]]\nscale = {{ cut = {factors} }}\n")
    run = ["run", "--quiet", "-o"]
    assert main([*run, str(tmp_path / "a"), str(tmp_path / "one.toml")]) == 0
    assert main([*run, str(tmp_path / "b"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "a")]) == 0
    assert main([*run, str(tmp_path / "c"), str(tmp_path / "whole.toml")]) == 0
    pressures = []
    for name in "bc":
        rows = (tmp_path / name / "contact.csv").read_text().splitlines()
        column = rows[0].split(",").index("pressure")
        pressures.append([float(row.split(",")[column]) for row in rows[1:]])
    np.testing.assert_allclose(*pressures, rtol=0, atol=1e-9)
    assert main([*run, str(tmp_path / "d"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "one.toml")]) == 2
