# SPDX-License-Identifier: BSD-3-Clause
"""What users of keyword decks expect back: .frd and .dat, with the numbers of the deck."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.deck import load_deck
from signorini.fem.space import make_space
from signorini.fem.stress import DeformedBodies, point_stresses
from signorini.output.ccx_contact import tangents
from signorini.output.dat import write_dat
from signorini.output.fields import Fields

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
            assert int(line[13:18]) in (1, 4, 6)
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
        # the normal is y, so that the first tangent is x as here; the shear stress is what the slave exerts
        assert shown["CONTACT"][contact.node, 4] == pytest.approx(-contact.traction, rel=1e-5, abs=1e-9)
        assert shown["CONTACT"][contact.node, 1] == pytest.approx(contact.slip, rel=1e-5, abs=1e-12)
        # what holds the base is what the supports report
        base = mesh.nodes["Base"]
        assert shown["FORC"][base, :2].sum(axis=0) == pytest.approx(step.reactions["Base"], rel=1e-4, abs=1e-3)


def test_dat_holds_the_tables_that_are_asked_for(folder: Path) -> None:
    text = (folder / "solution.dat").read_text()
    assert text.count("S T E P") == 2  # what the first step asks for, the second goes on with
    assert " displacements (vx,vy,vz) for set TOP and time  0.1000000E+01" in text
    block = text.split("displacements (vx,vy,vz) for set TOP and time  0.2000000E+01")[1].split("\n\n")[1]
    rows = [line.split() for line in block.splitlines()]
    assert [row[0] for row in rows] == ["14", "15", "16"]
    assert np.array(rows, float)[:, 1:3] == pytest.approx(np.tile([0.01, -0.001], (3, 1)))
    assert " contact stress (slave node,press,tang1,tang2) for all contact elements and time 0.2000000E+01" in text


def test_stresses_totals_and_contact_forces(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    text = (DECKS / "two_blocks.inp").read_text()
    asked = "*NODE PRINT, NSET=Base, TOTALS=ONLY\nRF\n*EL PRINT, ELSET=Upper\nS\n*CONTACT PRINT\nCF\n*END STEP"
    deck.write_text(text.replace("*END STEP", asked, 1))
    found = load_deck(deck)
    solution = sg.solve(found.model)
    assert found.prints is not None
    write_dat(solution, Fields(solution.model), found.prints, tmp_path / "x.dat")
    lines = (tmp_path / "x.dat").read_text().splitlines()

    def after(words: str) -> list[float]:
        at = next(i for i, line in enumerate(lines) if words in line)
        return [float(word) for word in lines[at + 2].split()]

    force = solution.steps[0].contacts[0].normal_force[1]
    assert after("total force (fx,fy,fz) for set BASE")[:2] == pytest.approx([0.0, force], abs=1e-4)
    assert after("total surface force")[:2] == pytest.approx([0.0, force], abs=1e-4)
    row = after("stresses (elem, integ.pnt.")
    model = solution.model
    deformed = DeformedBodies.of(make_space(model.mesh), model, solution.steps[0].displacement)
    stress = next(iter(point_stresses(deformed)))[1][2]
    assert row[0] == 30
    assert row[2:6] == pytest.approx(stress[0, :4], rel=1e-5, abs=1e-6)


def asked(folder: Path, name: str, keywords: str, *changes: tuple[str, str]) -> tuple[sg.Solution, str]:
    """Solution and ``.dat`` of a deck whose last step asks for tables."""
    text = (DECKS / name).read_text()
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    deck = folder / "deck.inp"
    head, _, _ = text.rpartition("*END STEP")
    deck.write_text(f"{head}{keywords}\n*END STEP\n")
    found = load_deck(deck)
    solution = sg.solve(found.model)
    assert found.prints is not None
    write_dat(solution, Fields(solution.model), found.prints, folder / "x.dat")
    return solution, (folder / "x.dat").read_text()


def rows_after(text: str, words: str) -> np.ndarray:
    """The last table under a heading."""
    block = text.rsplit(words, 1)[1].split("\n\n")[1]
    return np.array([[float(word) for word in line.split()] for line in block.splitlines()])


def test_tables_come_in_the_order_of_the_deck_and_forces_last(tmp_path: Path) -> None:
    """A step that asks for nodes anew keeps what was asked of contacts."""
    _, text = asked(
        tmp_path,
        "two_blocks.inp",
        "*CONTACT PRINT, SLAVE=Sslave, MASTER=Smaster\nCF, CDIS\n*NODE PRINT, NSET=Base, TOTALS=YES\nRF\n",
    )
    last = text.split("S T E P")[2]
    heads = [line.split("(")[0].strip() for line in last.splitlines() if "(" in line]
    assert heads[:4] == ["relative contact displacement", "forces", "total force", "total surface force"]
    assert "statistics for slave set SSLAVE, master set SMASTER and time  0.2000000E+01" in last


def test_contact_pairs_that_do_not_exist_are_refused(tmp_path: Path) -> None:
    with pytest.raises(sg.InputError, match=r"no contact pair of 'Smaster' and 'Sslave'"):
        asked(tmp_path, "two_blocks.inp", "*CONTACT PRINT, SLAVE=Smaster, MASTER=Sslave\nCF")


def test_energies_of_springs_add_up_to_those_of_the_interface(tmp_path: Path) -> None:
    soft = ("PRESSURE-OVERCLOSURE=HARD\n*FRICTION\n0.3", "PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n*FRICTION\n0.3, 2.E4")
    keywords = "*CONTACT PRINT, TOTALS=YES\nCELS, CDIS, CSTR\n"
    solution, text = asked(tmp_path, "two_blocks.inp", keywords, soft)
    energies = rows_after(text, "contact spring energy (slave node,energy)")
    assert energies[:, 1].sum() == pytest.approx(solution.last.interface_energy, rel=1e-5)
    assert rows_after(text, "total contact spring energy")[0, 0] == pytest.approx(energies[:, 1].sum(), rel=1e-5)
    moved, stress = (rows_after(text, words) for words in ("contact displacement (", "contact stress ("))
    assert stress[:, 1] == pytest.approx(-1e5 * moved[:, 1], rel=1e-5)  # overlap times stiffness


def test_shear_and_sliding_have_one_sign_whichever_way_a_surface_faces(tmp_path: Path) -> None:
    """CalculiX's axes: the upper block, dragged along x by more than it yields, exerts friction along x."""
    _, text = asked(tmp_path, "two_blocks.inp", "*CONTACT PRINT, SLAVE=Sslave, MASTER=Smaster\nCDIS, CSTR, CFN, CFS\n")
    moved, stress = (rows_after(text, words) for words in ("contact displacement (", "contact stress ("))
    assert (moved[:, 2] > 0.005).all()
    assert stress[:, 2] == pytest.approx(0.3 * stress[:, 1], rel=1e-5)
    assert (stress[:, 3] == 0.0).all()
    pressed = rows_after(text, "total normal surface force")[0]
    dragged = rows_after(text, "total shear surface force")[0]
    assert dragged[0] == pytest.approx(-0.3 * pressed[1], rel=1e-5)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, -1, 0), (0.6, 0.0, 0.8)])
def test_tangents_of_calculix(normal: tuple[float, ...]) -> None:
    """Unit vectors with the normal right-handed, the first along x where the surface allows."""
    n = np.array(normal, float)
    first, second = tangents(n[None])[0]
    assert np.stack([first, second, n]) @ np.stack([first, second, n]).T == pytest.approx(np.eye(3))
    assert np.cross(first, second) == pytest.approx(n)
    assert first[2] == 1.0 if abs(n[0]) == 1.0 else first[0] > 0.0


def test_a_node_of_rotation_shows_rotation_and_moment(tmp_path: Path) -> None:
    changes = [("99, 1., 3.", "99, 1., 3.\n98, 1., 3."), ("REF NODE=99", "REF NODE=99, ROT NODE=98")]
    solution, text = asked(tmp_path, "rigid.inp", "*NODE PRINT, NSET=Nall, TOTALS=YES\nU, RF", *changes)
    (body,) = solution.last.rigid_bodies.values()
    moved, forces = (
        {int(row[0]): row[1:] for row in rows_after(text, words)} for words in ("displacements (vx", " forces (fx")
    )
    assert moved[98] == pytest.approx([0.0, 0.0, body.rotation], rel=1e-5)
    assert moved[99] == pytest.approx([*body.displacement, 0.0], rel=1e-5, abs=1e-12)
    assert forces[98] == pytest.approx([0.0, 0.0, 0.5])
    assert forces[99][:2] == pytest.approx(body.force, abs=1e-6)
    total = rows_after(text, "total force")[0]
    assert total == pytest.approx([0.0, 0.0, 0.0], abs=1e-5)  # a moment is no part of it


@pytest.mark.parametrize("kind", ["C3D8", "C3D8I", "CPS4", "CPE4", "CAX4"])
def test_strains_are_elastic_thermal_and_plastic_ones_together(tmp_path: Path, kind: str) -> None:
    """Of cells that heat stretches evenly beyond yield: what nodes say, and what no stress resists."""
    solid = kind.startswith("C3D")
    corners = [(1, 0), (2, 0), (2, 1), (1, 1)]
    points = [(x, y, z) for z in ((0, 1) if solid else (0,)) for x, y in corners]
    nodes = "".join(f"{i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(points, start=1))
    plane = "BOT,2,2\n" if kind == "CAX4" else "LEFT,1,1\nBOT,2,2\n"
    law = "" if kind == "C3D8I" else "*PLASTIC\n1.,0.\n2.,.1\n"
    (tmp_path / "deck.inp").write_text(
        f"*NODE\n{nodes}*ELEMENT,TYPE={kind},ELSET=E\n1,{','.join(map(str, range(1, len(points) + 1)))}\n"
        f"*NSET,NSET=LEFT\n1,4{',5,8' if solid else ''}\n*NSET,NSET=BOT\n1,2{',5,6' if solid else ''}\n"
        f"*NSET,NSET=TOP\n3,4{',7,8' if solid else ''}\n*NSET,NSET=BACK\n1,2,3,4\n*NSET,NSET=ALL\nLEFT,BOT,TOP\n"
        f"*MATERIAL,NAME=M\n*ELASTIC\n100.,.3\n*EXPANSION\n1.E-3\n{law}*SOLID SECTION,ELSET=E,MATERIAL=M\n"
        f"*BOUNDARY\n{plane}{'BACK,3,3' if solid else ''}\n*STEP\n*STATIC\n*TEMPERATURE\nALL,2.\n"
        "*BOUNDARY\nTOP,2,2,.03\n*EL PRINT,ELSET=E\nE,S\n*END STEP\n".replace("\n\n", "\n")
    )
    found = load_deck(tmp_path / "deck.inp")
    history = sg.solve(found.model)
    write_dat(history, Fields(found.model), found.prints, tmp_path / "x.dat")
    strains, stresses = (tmp_path / "x.dat").read_text().split(" stresses (elem")
    assert " strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) for set E and time" in strains
    rows = [
        np.array([line.split()[2:] for line in text.splitlines() if line[:10].strip() == "1"], float)
        for text in (strains, stresses)
    ]
    E, S = rows
    u = history.last.displacement
    stretch = (u[2] - u[3])[0]
    np.testing.assert_allclose(E[:, 1], 0.03, rtol=1e-6)
    np.testing.assert_allclose(E[:, 3:], 0.0, atol=1e-9)
    if kind != "CAX4":
        np.testing.assert_allclose(E[:, 0], stretch, rtol=1e-6)
    if solid:
        np.testing.assert_allclose(E[:, 2], (u[4] - u[0])[2], rtol=1e-6)
    elif kind == "CPE4":
        np.testing.assert_allclose(E[:, 2], 0.0, atol=1e-9)
    elif kind == "CPS4":  # flow keeps the volume, heat and pressure change it
        pressure = -S[:, :3].sum(axis=1) / 3.0
        np.testing.assert_allclose(E[:, :3].sum(axis=1), 3.0 * 2e-3 - pressure * 3.0 * 0.4 / 100.0, rtol=1e-5)
