# SPDX-License-Identifier: BSD-3-Clause
"""Fields of the bodies are computed once for all files of a run."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output import fields
from signorini.output.vtu import write_surfaces

DECK = """*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*ELEMENT, TYPE=CPE4, ELSET=BLOCK
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
100, 0.3
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
*BOUNDARY
1, 1, 2
2, 2
{steps}"""
STEP = """*STEP
*STATIC
*BOUNDARY
3, 2, 2, {u}
4, 2, 2, {u}
*NODE FILE
U
*EL FILE
S
*EL PRINT, ELSET=BLOCK
S
*EL PRINT, ELSET=BLOCK
S
*END STEP
"""


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often spaces and stresses are computed for files."""
    found: Counter[str] = Counter()

    def counted(name: str) -> Callable[..., object]:
        real = getattr(fields, name)

        def call(*given: object, **keys: object) -> object:
            found[name] += 1
            return real(*given, **keys)

        return call

    for name in ("space_of", "body_stresses", "body_tensors", "point_stresses"):
        monkeypatch.setattr(fields, name, counted(name))
    return found


def deck_of(tmp_path: Path) -> Path:
    """A block that is pressed in three steps."""
    deck = tmp_path / "press.inp"
    deck.write_text(DECK.format(steps="".join(STEP.format(u=u) for u in (-0.1, -0.2, -0.3))))
    return deck


def test_a_run_makes_one_space_and_the_stresses_of_every_step_once(
    tmp_path: Path, calls: Counter[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """For the last state, the series, ``.frd`` and ``.dat``, where two tables ask for the stresses of each step."""
    monkeypatch.setattr("signorini.output.folder._MAX_KEEP_SHARE", -1.0)  # nothing is written before the end
    out = tmp_path / "out"
    assert main(["run", str(deck_of(tmp_path)), "-o", str(out), "--quiet"]) == 0
    names = {file.name for file in out.iterdir()}
    assert names >= {"solution.vtu", "solution_0003.vtu", "solution.pvd", "solution.frd", "solution.dat"}
    assert calls == {"space_of": 1, "body_tensors": 3, "point_stresses": 3}


def test_stresses_are_kept_where_several_files_need_them_and_of_the_last_state(
    tmp_path: Path, calls: Counter[str]
) -> None:
    """A long history whose files need each state once must not hold the stresses of all."""
    solution = sg.solve(sg.read(deck_of(tmp_path)))
    first, second, third = solution.steps
    for shared, count in (((), 4), ((first, second), 3)):
        calls.clear()
        found = fields.Fields(solution.model, shared=shared)
        for step in (first, second, third, third, second):
            found.stresses(step)
        assert calls["body_stresses"] == count


def test_contact_lines_of_the_plane_say_what_the_contact_says(tmp_path):
    solution = sg.solve(zhu_cylinder(friction=0.4))
    contact = solution.last.contacts[0]
    write_surfaces(solution.model, solution.last.contacts, tmp_path / "contact.vtu")
    found = meshio.read(tmp_path / "contact.vtu")
    (lines,) = found.cells
    assert (lines.type, len(lines.data)) == ("line", len(contact.node) - 1)
    assert found.points[:, :2].tolist() == contact.points.tolist()
    assert found.point_data["force"][:, :2].sum(axis=0) == pytest.approx([contact.tangential_force[0], 78.0])
    length = np.linalg.norm(np.diff(found.points[lines.data], axis=1)[:, 0], axis=1)
    way = found.point_data["arc_length"][lines.data]
    assert np.abs(np.diff(way, axis=1)[:, 0]) == pytest.approx(length)
    assert found.point_data["slip_amplitude"].tolist() == (0.5 * contact.slip_range).tolist()
    assert found.point_data["dissipation_per_area"] @ contact.area == pytest.approx(contact.dissipation)


def test_a_contact_whose_nodes_have_no_lines_is_points(tmp_path):
    solution = sg.solve(zhu_cylinder(friction=0.4))
    write_surfaces(solution.model, [replace(solution.last.contacts[0], nonmortar="nodes")], tmp_path / "contact.vtu")
    (points,) = meshio.read(tmp_path / "contact.vtu").cells
    assert (points.type, points.data.tolist()) == ("vertex", [[i] for i in range(11)])


@pytest.mark.parametrize("kind", ["plane stress", "plane strain", "axisymmetric"])
def test_files_have_strains_principal_stresses_and_forces(kind, tmp_path):
    """A heated block that is pressed: uniform, so that strains are known, and nodal forces balance."""
    axial = kind == "axisymmetric"
    steel = sg.Elastic(E=200.0, nu=0.3, expansion=1e-3)
    model = sg.Model(
        sg.rectangle(width=2.0, nx=4, ny=2),
        kind=kind,
        bodies=[sg.Body("block", steel)],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", pressure=3.0), sg.Load("block", temperature=10.0)],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), name="floor")],
    )
    solution = sg.solve(model)
    solution.write(tmp_path / "block.vtu")
    found = meshio.read(tmp_path / "block.vtu")
    across = -3.0 * 0.3 + 200.0 * -0.01 if kind == "plane strain" else 0.0  # nothing moves out of that plane
    stress = np.array([0.0, -3.0, across])
    strain = (stress - 0.3 * (stress.sum() - stress)) / 200.0 + 0.01
    assert found.point_data["strain"][:, :3] == pytest.approx(np.tile(strain, (15, 1)), abs=1e-12)
    assert found.point_data["principal_stress"] == pytest.approx(np.tile(np.sort(stress)[::-1], (15, 1)), abs=1e-11)
    for name in ("stress", "strain"):
        (in_cells,) = found.cell_data[name]
        assert in_cells == pytest.approx(np.tile(found.point_data[name][0], (8, 1)), abs=1e-11)
    force = found.point_data["contact_force"]
    on_floor = found.points[:, 1] == 0.0
    assert force[on_floor, 1].sum() == pytest.approx(3.0 * (4.0 * np.pi if axial else 2.0))
    assert not force[~on_floor].any()
    assert found.point_data["reaction"][:, 0].sum() == pytest.approx(solution.last.reactions["left"][0], abs=1e-11)
    assert not found.point_data["reaction"][found.points[:, 0] > 0.0].any()


def test_contact_forces_act_on_both_sides_and_balance(tmp_path):
    """Two blocks whose meshes do not match, also on the way, where forces are found anew."""
    low = sg.rectangle(width=3.0, nx=5, ny=2)
    mesh = sg.join({"low": low, "high": sg.rectangle(width=2.0, nx=4, ny=2, origin=(0.5, 1.0))})
    model = sg.Model(
        mesh,
        bodies=[sg.Body(name, sg.Elastic(E=100.0, nu=0.3)) for name in ("low", "high")],
        supports=[sg.Support("low.bottom", u=(0, 0)), sg.Support("high.left", u=(0, None))],
        loads=[sg.Load("high.top", pressure=3.0)],
        contacts=[sg.Contact("high.bottom", "low.top", friction=0.1, name="joint")],
        steps=[sg.Step(path="exact")],
    )
    solution = sg.solve(model)
    solution.at(load=0.4).write(tmp_path / "then.vtu")
    solution.write(tmp_path / "end.vtu")
    for name, part in (("then.vtu", 0.4), ("end.vtu", 1.0)):
        found = meshio.read(tmp_path / name)
        force, high = found.point_data["contact_force"], found.points[:, 1] >= 1.0
        high &= np.arange(len(high)) >= len(low.points)
        assert force.sum(axis=0) == pytest.approx(0.0, abs=1e-12)
        assert force[high, 1].sum() == pytest.approx(6.0 * part)
        assert found.point_data["reaction"][:, 1].sum() == pytest.approx(6.0 * part)
