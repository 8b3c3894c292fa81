# SPDX-License-Identifier: BSD-3-Clause
"""Series of fields at the ends of steps and at times asked for, read back."""

from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.clock import Clock
from signorini.engine import memory_check as planning
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output.folder import Publisher, open_folder
from signorini.output.series import frames, listed

HOT = sg.Elastic(E=100.0, nu=0.3, expansion=1e-3)


def block(steps, mesh=None, loads=None, friction=0.2):
    """Pressed on a rigid floor and heated: everything but the temperature's stress is proportional to the load."""
    mesh = mesh or sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    d = mesh.points.shape[1]
    floor = sg.Plane(point=(0,) * d, normal=(0,) * (d - 1) + (1,))
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", HOT)],
        supports=[sg.Support("left", u=(0, None, None)[:d]), *[sg.Support("front", u=(None, 0, None))] * (d - 2)],
        loads=loads or [sg.Load("top", pressure=3.0, name="press"), sg.Load("block", temperature=20.0, name="heat")],
        contacts=[sg.Contact("bottom", floor, friction=friction)],
        steps=steps,
    )


def read_series(path):
    """Times and files of a list."""
    entries = ElementTree.parse(path).getroot().iter("DataSet")
    return [(float(entry.get("timestep")), meshio.read(path.parent / entry.get("file"))) for entry in entries]


def written(solution, folder):
    return Publisher(folder=open_folder(folder), clock=Clock(), started=0.0).publish(solution)


BOX = {"mesh": sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 0.5, 1]), "friction": 0.0}


@pytest.mark.parametrize("given", [{"friction": 0.0}, BOX], ids=["plane", "space"])
def test_fields_at_times_asked_for_are_proportional_to_the_load(given, tmp_path):
    """One step, frictionless: at the part t of the step displacements and stresses are t times those of the end."""
    solution = sg.solve(block([sg.Step(at=[0.25, 0.6])], **given))
    names = [file.relative_to(tmp_path).as_posix() for file in written(solution, tmp_path)]
    assert {"fields/solution_0001_0001.vtu", "fields/solution_0001_0002.vtu", "solution_0001.vtu"} <= set(names)
    there = [file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*") if file.is_file()]
    assert sorted(names) == sorted(there)
    series = read_series(tmp_path / "solution.pvd")
    assert [time for time, _ in series] == [0.25, 0.6, 1.0]
    end = series[-1][1].point_data
    assert np.abs(end["stress"]).max() > 1.0
    for time, found in series:
        for key in ("displacement", "stress"):
            scale = np.abs(end[key]).max()
            np.testing.assert_allclose(found.point_data[key], time * end[key], atol=1e-9 * scale)
    last = meshio.read(tmp_path / "solution.vtu").point_data
    np.testing.assert_array_equal(last["stress"], end["stress"])


def test_contact_surfaces_have_a_series_too(tmp_path):
    solution = sg.solve(block([sg.Step(name="press", scale={"press": 1.0}), sg.Step(at=2)], **BOX))
    written(solution, tmp_path)
    series = read_series(tmp_path / "contact.pvd")
    assert [time for time, _ in series] == [1.0, 1.5, 2.0]
    for _, found in series:
        data = found.point_data
        assert data["area"] @ data["pressure"] == pytest.approx(6.0)
    assert (tmp_path / "contact.vtu").is_file()


def test_stresses_between_are_those_of_the_loads_there(tmp_path):
    """Held all around and heated, nothing moves: the stress is the temperature's, at its factor at that time."""
    rectangle = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
    model = sg.Model(
        rectangle,
        bodies=[sg.Body("block", HOT)],
        supports=[sg.Support(side, u=(0, 0)) for side in ("left", "right", "bottom", "top")],
        loads=[sg.Load("block", temperature=20.0, name="heat")],
        steps=[sg.Step(scale={"heat": [1.0, 0.5]}, at=4, increments=2)],
    )
    solution = sg.solve(model)
    solution.write(tmp_path / "held.pvd")
    series = read_series(tmp_path / "held.pvd")
    assert [time for time, _ in series] == [0.25, 0.5, 0.75, 1.0]
    pressure = 100.0 / (1 - 2 * 0.3) * 1e-3 * 20.0
    for (_, found), factor in zip(series, [0.5, 1.0, 0.75, 0.5], strict=True):
        np.testing.assert_allclose(found.point_data["stress"][:, :3], -factor * pressure, rtol=1e-9)


def test_events_are_states_of_the_series_at_increasing_times():
    solution = sg.solve(zhu_cylinder(friction=0.4, steps=[sg.Step(at="events"), sg.Step(scale={"cut": 0.5})]))
    states = frames(solution)
    kept = [instant for instant in solution.steps[0].instants if instant.displacement is not None]
    assert len(states) == len(kept) + 1 > 5
    assert (np.diff([state.time for state in states]) > 0).all()
    assert [state.last for state in states] == [False] * (len(kept) - 1) + [True, True]
    assert states[-1].state.displacement is solution.last.displacement
    for state in states[:-1]:
        assert state.state.factors["cut"] == pytest.approx(state.time, abs=1e-5)


def test_a_time_at_the_end_of_a_segment_is_kept_and_nothing_that_was_not_asked_for():
    """With and without temperatures, whose work needs every displacement while the step is solved."""
    for name in ("press", "heat"):
        step = sg.Step(scale={name: [1.0, 0.5, 1.0, 0.2]}, at=[0.1, 0.5, 1.0], increments=2)
        states = frames(sg.solve(block([sg.Step(), step])))
        assert [state.time for state in states] == [1.0, 1.1, 1.5, 2.0]


def test_a_run_without_times_leaves_no_fields_of_an_earlier_one(tmp_path):
    out = tmp_path / "out"
    written(sg.solve(block([sg.Step(at=3)])), out)
    assert len(list((out / "fields").iterdir())) == 2 + 3  # of bodies on the way, of the contact at the end, too
    (out / "fields" / "mine.vtu").write_text("mine")
    written(sg.solve(block([sg.Step()])), out)
    assert [file.name for file in (out / "fields").iterdir()] == ["mine.vtu"]
    assert not (out / "solution.pvd").exists()
    (out / "fields" / "mine.vtu").unlink()
    written(sg.solve(block([sg.Step()])), out)
    assert not (out / "fields").exists()


def test_a_series_that_cannot_be_finished_leaves_the_earlier_one_whole(tmp_path, monkeypatch):
    from signorini.output import series

    written(sg.solve(block([sg.Step(at=3)])), tmp_path)
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    write, count = series.write_bodies, []

    def broken(*given, **asked):
        count.append(1)
        if len(count) == 3:
            raise OSError("no space left on device")
        write(*given, **asked)

    monkeypatch.setattr(series, "write_bodies", broken)
    with pytest.raises(OSError, match="no space"):
        written(sg.solve(block([sg.Step(at=4)])), tmp_path)
    assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before


def test_a_deck_asks_for_times(tmp_path, capsys):
    example = Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml"
    deck = tmp_path / "deck.toml"
    deck.write_text(example.read_text() + "at = 5\n")
    assert main(["run", str(deck), "-o", str(tmp_path / "out")]) == 0
    assert "9 files in fields in" in capsys.readouterr().out.replace("\n", " ")
    series = read_series(tmp_path / "out" / "solution.pvd")
    assert [time for time, _ in series] == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    top = [found.point_data["displacement"][:, 1].min() for _, found in series]
    assert (np.diff(top) < 0).all()


def test_more_fields_than_fit_are_refused_before_the_solve(monkeypatch):
    monkeypatch.setattr(planning, "available_memory", lambda: 20_000_000)
    mesh = sg.rectangle(width=2.0, height=1.0, nx=100, ny=30)  # 50 kB a field
    with pytest.raises(sg.InputError, match=r"step\[1\]\.at: asks for 198 fields .* room for 197 in all"):
        sg.solve(block([sg.Step(scale={"press": 1.0}), sg.Step(at=198)], mesh=mesh))


@pytest.mark.parametrize("wrong", [0, -3, True, 1.5, [1.5], "ends"])
def test_times_that_are_none_are_refused(wrong):
    with pytest.raises(sg.InputError, match="at"):
        sg.Step(at=wrong)


def test_names_are_safe_in_a_list():
    assert 'file="a&amp;b.vtu"' in listed([(1.0, "a&b.vtu")])
