# SPDX-License-Identifier: BSD-3-Clause
"""What users of keyword decks expect back: .frd and .dat, with the numbers of the deck."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.deck import load
from signorini.fem.space import make_space
from signorini.fem.stress import point_stresses
from signorini.output.dat import write_dat

DECKS = Path(__file__).parents[1] / "deck" / "inp" / "decks"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    assert main(["run", str(DECKS / "two_blocks.inp"), "-o", str(folder), "--quiet"]) == 0
    return folder


Numbered = dict[int, list[float]]


def read_frd(path: Path) -> tuple[Numbered, dict[int, list[int]], list[tuple[str, Numbered]]]:
    """Nodes, elements and the fields in order: columns are of fixed width, as programs that read .frd expect."""
    nodes: Numbered = {}
    elements: dict[int, list[int]] = {}
    fields: list[tuple[str, Numbered]] = []
    part = ""
    for line in path.read_text().splitlines():
        assert len(line) <= 132
        if line.startswith(("    2C", "    3C")):
            part, count = line[4], int(line[6:36])
        elif line.startswith("  100CL"):
            part, count = "R", int(line[24:36])
        elif line.startswith(" -4"):
            fields.append((line[5:13].strip(), {}))
            assert int(line[13:18]) in (4, 6)
        elif line.startswith(" -3"):
            assert count == {"2": len(nodes), "3": len(elements), "R": len(fields[-1][1]) if fields else 0}[part]
        elif line.startswith(" -1"):
            number = int(line[3:13])
            values = [float(line[i : i + 12]) for i in range(13, len(line), 12)] if part != "3" else []
            {"2": nodes, "R": fields[-1][1] if fields else {}}.get(part, {})[number] = values
            last = number
        elif line.startswith(" -2"):
            elements[last] = [int(line[i : i + 10]) for i in range(3, len(line), 10)]
    assert line == " 9999"
    return nodes, elements, fields


def test_frd_holds_every_step(folder: Path) -> None:
    nodes, elements, fields = read_frd(folder / "solution.frd")
    solution = sg.load(folder)
    mesh = solution.model.mesh
    assert list(nodes) == mesh.labels.tolist()
    assert np.array(list(nodes.values()))[:, :2] == pytest.approx(mesh.points)
    assert elements == {10: [1, 2, 5, 4], 20: [2, 3, 6, 5], 30: [11, 12, 15, 14], 40: [12, 13, 16, 15]}
    assert [name for name, _ in fields] == ["DISP", "FORC", "STRESS", "CONTACT"] * 2
    for k, step in enumerate(solution.steps):
        shown = {name: np.array(list(values.values())) for name, values in fields[4 * k : 4 * k + 4]}
        assert shown["DISP"][:, :2] == pytest.approx(step.displacement, rel=1e-5, abs=1e-12)
        contact = step.contacts[0]
        assert shown["CONTACT"][contact.node, 3] == pytest.approx(contact.pressure, rel=1e-5)
        assert shown["CONTACT"][contact.node, 4] == pytest.approx(contact.traction, rel=1e-5, abs=1e-9)
        # what holds the base is what the supports report
        base = mesh.nodes["Base"]
        assert shown["FORC"][base, :2].sum(axis=0) == pytest.approx(step.reactions["Base"], rel=1e-4, abs=1e-3)


def test_dat_holds_the_tables_that_are_asked_for(folder: Path) -> None:
    text = (folder / "solution.dat").read_text()
    assert text.count("S T E P") == 2  # what the first step asks for, the second goes on with
    assert " displacements (vx,vy,vz) for set TOP and time  1.0000000E+00" in text
    block = text.split("displacements (vx,vy,vz) for set TOP and time  2.0000000E+00")[1].split("\n\n")[1]
    rows = [line.split() for line in block.splitlines()]
    assert [row[0] for row in rows] == ["14", "15", "16"]
    assert np.array(rows, float)[:, 1:3] == pytest.approx(np.tile([0.01, -0.001], (3, 1)))
    assert "contact stress (slave node,press,tang1,tang2) for slave set Sslave, master set Smaster" in text


def test_stresses_totals_and_contact_forces(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    text = (DECKS / "two_blocks.inp").read_text()
    asked = "*NODE PRINT, NSET=Base, TOTALS=ONLY\nRF\n*EL PRINT, ELSET=Upper\nS\n*CONTACT PRINT\nCF\n*END STEP"
    deck.write_text(text.replace("*END STEP", asked, 1))
    found = load(deck)
    solution = sg.solve(found.model)
    assert found.tables is not None
    write_dat(solution, found.tables, tmp_path / "x.dat")
    lines = (tmp_path / "x.dat").read_text().splitlines()

    def after(words: str) -> list[float]:
        at = next(i for i, line in enumerate(lines) if words in line)
        return [float(word) for word in lines[at + 2].split()]

    force = solution.steps[0].contacts[0].normal_force[1]
    assert after("total force (fx,fy,fz) for set BASE")[:2] == pytest.approx([0.0, force], abs=1e-4)
    assert after("total surface force")[:2] == pytest.approx([0.0, force], abs=1e-4)
    row = after("stresses (elem, integ.pnt.")
    model = solution.model
    stress = next(iter(point_stresses(make_space(model.mesh), model, solution.steps[0].displacement)))[1][2]
    assert row[0] == 30
    assert row[2:6] == pytest.approx(stress[0, :4], rel=1e-5, abs=1e-6)
