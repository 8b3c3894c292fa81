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

    for name in ("space_of", "body_stresses", "point_stresses"):
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
    assert calls == {"space_of": 1, "body_stresses": 3, "point_stresses": 3}


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
