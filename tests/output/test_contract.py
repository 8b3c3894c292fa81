# SPDX-License-Identifier: BSD-3-Clause
"""What ``signorini run`` leaves for other programs: every key, column and type, and the law of contact row by row."""

import csv
import json
import math
import tomllib
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from signorini.cli import main
from signorini.solution.certificate import TOLERANCE

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
NUMBER = (int, float)
TOP = {
    "signorini": str,
    "title": str,
    "status": str,
    "message": str,
    "kind": str,
    "units": str,
    "size": dict,
    "timings": dict,
    "backend": str,
    "peak_memory_bytes": int,
    "obstacles": list,
    "steps": list,
}
SIZE = dict.fromkeys(("nodes", "elements", "dofs", "contact_pairs"), int)
PHASES = "read assembly factorisation condensation complementarity recovery output total"
TIMINGS = dict.fromkeys(PHASES.split(), NUMBER)
STEP = {
    "name": str,
    "load_factor": NUMBER,
    "path": str,
    "increments": int,
    "reactions": dict,
    "strain_energy": NUMBER,
    "work": NUMBER,
    "notes": list,
    "certificate": dict,
    "contacts": list,
    "dissipation": NUMBER,
    "interface_energy": NUMBER,
    "energy_defect": NUMBER,
    "method": str,
}
FIVE = ("equilibrium", "penetration", "tension", "cone", "complementarity")
CONTACT = {
    "name": str,
    "normal_force": list,
    "tangential_force": list,
    "max_pressure": NUMBER,
    "max_pressure_at": list,
    "area": NUMBER,
    "open": int,
    "stick": int,
    "slip": int,
    "max_slip": NUMBER,
    "dissipation": NUMBER,
}
COLUMNS = "step,contact,node,x,y,z,area,gap,pressure,traction_1,traction_2,slip_1,slip_2,status"
NUMBERS = [column for column in COLUMNS.split(",") if column not in ("contact", "status")]


class Results:
    """A result folder, read with nothing of the package."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.summary: dict[str, Any] = json.loads((folder / "summary.json").read_text())
        self.solid = self.summary["kind"] == "3d"
        self.twists = self.summary["kind"] == "axisymmetric twist"
        text = (folder / "contact.csv").read_text()
        self.header = text.split("\n", 1)[0]
        rows = list(csv.DictReader(text.splitlines()))
        self.values = {name: np.array([float(row[name]) for row in rows]) for name in NUMBERS}
        self.contact = np.array([row["contact"] for row in rows])
        self.damage = np.array([float(row.get("damage", "nan")) for row in rows])
        self.status = np.array([row["status"] for row in rows])
        self.fields = meshio.read(folder / "solution.vtu")


_LONG = (
    "ball_on_block",
    "block_over_edge",
    "bolted_bracket",
    "bolted_joint",
    "fretting",
    "fretting_fatigue",
    "fretting_wear",
    "indentation",
    "wear",
)


def example(path: Path) -> Any:
    """A deck as a parameter; those that take a second are slow."""
    takes_long = path.stem in _LONG
    return pytest.param(path, id=path.stem, marks=[pytest.mark.slow] if takes_long else [])


@pytest.fixture(scope="module", params=map(example, EXAMPLES))
def results(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, dict[str, Any]]:
    """Every example of the repository, run, and its deck as plain data."""
    folder = tmp_path_factory.mktemp(request.param.stem)
    assert main(["run", str(request.param), "-o", str(folder), "--quiet"]) == 0
    return Results(folder), tomllib.loads(request.param.read_text())


def assert_types(where: str, found: dict[str, Any], expected: dict[str, Any]) -> None:
    for key, kind in expected.items():
        assert key in found, f"{where} has no {key}"
        assert isinstance(found[key], kind), f"{where}.{key} is {found[key]!r}"
        assert not isinstance(found[key], bool)


@pytest.mark.slow
def test_summary(results: tuple[Results, dict[str, Any]]) -> None:
    found, deck = results
    summary = found.summary
    assert_types("summary", summary, TOP)
    assert_types("size", summary["size"], SIZE)
    assert_types("timings", summary["timings"], TIMINGS)
    assert (summary["status"], summary["message"]) == ("solved", "")
    assert summary["timings"]["total"] >= 0.99 * sum(summary["timings"][key] for key in PHASES.split()[:-1])
    assert summary["peak_memory_bytes"] > 10_000_000
    assert len(summary["steps"]) == len(deck.get("step", [{}]))
    for number, step in enumerate(summary["steps"], start=1):
        assert_types(f"step {number}", step, STEP)
        assert step["load_factor"] == number
        assert set(step["reactions"]) == {support.get("name", support["on"]) for support in deck.get("support", [])}
        certificate = step["certificate"]
        assert certificate["passed"] is True
        assert all(0.0 <= certificate[key] <= TOLERANCE == 1e-8 for key in FIVE)
        for contact in step["contacts"]:
            assert_types(contact["name"], contact, CONTACT)


@pytest.mark.slow
def test_energy_is_accounted_for(results: tuple[Results, dict[str, Any]]) -> None:
    stored = 0.0
    for step in results[0].summary["steps"]:
        now = step["strain_energy"] + step["interface_energy"]
        flowed = 0.0 if step["plastic"] is None else step["plastic"]["dissipation"]
        defect = step["work"] - (now - stored) - step["dissipation"] - flowed - step["released"]
        assert step["energy_defect"] == pytest.approx(defect, abs=1e-12 * (abs(step["work"]) + now + stored))
        stored = now


def test_rows_obey_the_law_of_contact(results: tuple[Results, dict[str, Any]]) -> None:
    found, deck = results
    wears = any("wear" in contact for contact in deck["contact"])
    glued = {contact["name"]: contact["cohesion"] for contact in deck["contact"] if "cohesion" in contact}
    assert found.header == COLUMNS + (",depth,mortar_depth" if wears else "") + (",damage" if glued else "")
    value = found.values
    assert all(np.isfinite(column).all() for column in value.values())
    assert sorted(set(value["step"])) == list(range(1, len(found.summary["steps"]) + 1))
    assert (value["area"] > 0).all()
    if not found.solid:
        assert not value["z"].any()
        assert value["traction_2"].any() == found.twists
        assert value["slip_2"].any() == found.twists
    assert set(found.status) <= {"open", "stick", "slip"}
    friction = {contact.get("name", contact["nonmortar"]): contact.get("friction", 0.0) for contact in deck["contact"]}
    closures = {
        name: (contact.get("closure", {}).get("points"), "unloading" in contact.get("closure", {}))
        for name, contact in zip(friction, deck["contact"], strict=True)
    }
    tied = np.array([friction[name] == "tied" for name in found.contact])
    mu = np.array([np.inf if friction[name] == "tied" else friction[name] for name in found.contact])
    assert (found.status[tied] == "stick").all()
    p, t, peak = value["pressure"], np.hypot(value["traction_1"], value["traction_2"]), value["pressure"].max()
    size = max(np.abs(value[axis]).max() for axis in "xy")
    bonded = np.isin(found.contact, list(glued))
    assert p[~tied & ~bonded].min(initial=0.0) >= -1e-9 * peak
    supple = np.array([closures[name][0] is not None for name in found.contact])
    assert np.abs(value["gap"] * p)[~supple & ~bonded].max(initial=0.0) <= 1e-9 * peak * size
    assert value["gap"][~supple].min(initial=0.0) >= -1e-9 * size
    for name, (points, keeps) in closures.items():
        own = (found.contact == name) & (p > 0)
        closed = np.interp(p, *np.transpose(points)[::-1])[own] if points else []
        assert (-value["gap"][own] >= closed - 1e-9 * size).all() if points else True
        assert keeps or not points or (-value["gap"][own] <= closed + 1e-9 * size).all()
    assert (t <= mu * p + 1e-9 * peak)[~tied].all()
    assert not p[(found.status == "open") & ~bonded].any()
    for name, bond in glued.items():  # on the line of the damage, which is the largest opening over that of no tension
        own, opening = (found.contact == name) & (found.status == "open"), 2.0 * bond["energy"] / bond["strength"]
        damage = found.damage[own]
        tension = bond["strength"] * (1.0 - damage) / damage * value["gap"][own] / opening
        assert np.abs(p[own] + tension).max() <= 1e-8 * bond["strength"]
        assert p[found.contact == name].min() >= -(1.0 + 1e-9) * bond["strength"]
    slips = (found.status == "slip") & (mu > 0)
    assert np.abs(t - mu * p)[slips].max(initial=0.0) <= 1e-9 * peak


def test_summary_and_rows_say_the_same(results: tuple[Results, dict[str, Any]]) -> None:
    found, _ = results
    value = found.values
    for number, step in enumerate(found.summary["steps"], start=1):
        for contact in step["contacts"]:
            own = (value["step"] == number) & (found.contact == contact["name"])
            assert own.any()
            for status in ("open", "stick", "slip"):
                assert contact[status] == (found.status[own] == status).sum()
            pressed = (np.abs(value["pressure"]) * value["area"])[own].sum()  # what is tied may pull
            rubbed = (np.hypot(value["traction_1"], value["traction_2"]) * value["area"])[own]
            force = math.hypot(*contact["normal_force"])
            assert force <= pressed * (1.0 + 1e-12)  # equal on a plane, less where normals turn
            friction = list(contact["tangential_force"])
            if found.twists:  # a torque
                friction[2] /= value["x"][own].max()
            assert math.hypot(*friction) <= np.abs(rubbed).sum() + 1e-12 * pressed
            assert contact["max_pressure"] == value["pressure"][own].max()
            worst = np.flatnonzero(own)[value["pressure"][own].argmax()]
            assert contact["max_pressure_at"] == [value[axis][worst] for axis in ("xyz" if found.solid else "xy")]
            assert contact["area"] == pytest.approx(value["area"][own & (found.status != "open")].sum())
    assert found.summary["size"]["contact_pairs"] == (value["step"] == 1).sum()


def test_fields(results: tuple[Results, dict[str, Any]]) -> None:
    found, deck = results
    fields = found.fields
    count = len(fields.points)
    assert fields.point_data["displacement"].shape == (count, 3)
    assert fields.point_data["stress"].shape == (count, 6)
    assert fields.point_data["von_mises"].shape == (count,)
    bodies = np.concatenate(fields.cell_data["body"])
    assert set(bodies) == set(range(len(deck["body"])))
    assert len(bodies) == found.summary["size"]["elements"]
    # points of the bodies one after the other: no point belongs to two
    last = -1
    for body in range(len(deck["body"])):
        own = [block.data[part == body] for block, part in zip(fields.cells, fields.cell_data["body"], strict=True)]
        points = np.unique(np.concatenate([cells.ravel() for cells in own]))
        assert points.tolist() == list(range(last + 1, last + 1 + len(points)))
        last = int(points[-1])
    assert last == count - 1
    # rows and fields speak of the same nodes
    where = {int(node): point for node, point in zip(fields.point_data["node"], fields.points, strict=True)}
    for node, *point in zip(*(found.values[key] for key in ("node", "x", "y", "z")), strict=True):
        assert where[int(node)].tolist() == point


def test_series(results: tuple[Results, dict[str, Any]]) -> None:
    found, deck = results
    steps = len(found.summary["steps"])
    names = [f"solution_{number:04d}.vtu" for number in range(1, steps + 1)] if steps > 1 else []
    expected = {"summary.json", "contact.csv", "history.csv", "state.npz", "solution.vtu", "solution.h5", *names}
    expected |= {"contact.vtu"} | ({"solution.pvd", "contact.pvd", "fields"} if names else set())
    expected |= {"fatigue.csv"} if "fatigue" in deck else set()
    assert {file.name for file in found.folder.iterdir()} == expected
    if names:
        text = (found.folder / "solution.pvd").read_text()
        assert [text.index(f'file="{name}"') for name in names] == sorted(text.index(f'"{name}"') - 5 for name in names)
        last = meshio.read(found.folder / names[-1])
        assert (last.point_data["displacement"] == found.fields.point_data["displacement"]).all()


def test_cylinder_carries_its_load(results: tuple[Results, dict[str, Any]]) -> None:
    found, deck = results
    if "cylinder on a rigid" not in deck["title"]:
        pytest.skip("another example")
    assert found.summary["steps"][0]["contacts"][0]["normal_force"] == pytest.approx([0.0, 78.0], abs=1e-9)


def test_bracket_carries_its_bolt_and_its_cable(results: tuple[Results, dict[str, Any]]) -> None:
    """Forces and moment of the joint are those of the loads; it sticks and slips, and slip costs work."""
    found, deck = results
    if "bracket" not in deck["title"]:
        pytest.skip("another example")
    load = {load["name"]: load["force"] for load in deck["load"]}
    tighten, pull = (step["contacts"][0] for step in found.summary["steps"])
    joint = np.array([pull["normal_force"], pull["tangential_force"]]).sum(axis=0)
    assert joint[[0, 2]] == pytest.approx([-load["cable"][0], -load["bolt head"][2]], rel=1e-9)
    last = found.values["step"] == found.values["step"].max()
    x, force = found.values["x"][last], (found.values["pressure"] * found.values["area"])[last]
    assert x @ force == pytest.approx(load["cable"][0] * 40.0, rel=1e-3)  # the height of the eye
    assert pull["stick"] > 10
    assert pull["slip"] > 10
    assert 0.0 < tighten["dissipation"] < pull["dissipation"]
    assert abs(found.summary["steps"][1]["energy_defect"]) < 1e-3 * pull["dissipation"]
