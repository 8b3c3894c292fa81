# SPDX-License-Identifier: BSD-3-Clause
"""Decks with ``NLGEOM`` whose bodies slide and turn as wholes, beside CalculiX, where it is installed."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from tests.helpers.calculix import ccx_displacements, needs_ccx

NODES = 68  # of both bodies


def layer(first: int, element: int, across: np.ndarray, low: float) -> tuple[list[str], list[str], list[int]]:
    """Lines of the nodes and bricks of a square layer, and the nodes at its bottom and top."""
    n = len(across)
    places = [(x, y, low + k) for k in (0, 1) for y in across for x in across]
    nodes = [f"{first + i},{x:g},{y:g},{z:g}" for i, (x, y, z) in enumerate(places)]
    corners = first + np.array([0, 1, n + 1, n, n * n, n * n + 1, n * n + n + 1, n * n + n])
    cells = [
        ",".join(map(str, [element + (n - 1) * j + i, *(corners + i + n * j)]))
        for j in range(n - 1)
        for i in range(n - 1)
    ]
    return nodes, cells, list(range(first, first + 2 * n * n))


def deck(folder: Path, motion: str) -> Path:
    """A block that a rigid head presses on a bed and then moves over it."""
    bed, block = layer(1, 1, np.linspace(0.0, 4.0, 5), 0.0), layer(101, 101, np.linspace(1.25, 2.75, 3), 1.0)
    lines = [
        *("*NODE,NSET=ALL", *bed[0], *block[0], "*NODE", "201,2.,2.,2.", "202,0.,0.,0."),
        *("*ELEMENT,TYPE=C3D8,ELSET=EA", *bed[1], "*ELEMENT,TYPE=C3D8,ELSET=EB", *block[1]),
        *("*NSET,NSET=BASE", *map(str, bed[2][:25]), "*NSET,NSET=HEAD", *map(str, block[2][9:])),
        *("*SURFACE,NAME=MA", "EA,S2", "*SURFACE,NAME=SL", "EB,S1", "*MATERIAL,NAME=M", "*ELASTIC", "1000.,.3"),
        *("*SOLID SECTION,ELSET=EA,MATERIAL=M", "*SOLID SECTION,ELSET=EB,MATERIAL=M"),
        *("*RIGID BODY,NSET=HEAD,REF NODE=201,ROT NODE=202", "*SURFACE INTERACTION,NAME=I"),
        *("*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", "1.E6", "*FRICTION", ".3,1.E5"),
        *("*CONTACT PAIR,INTERACTION=I,TYPE=SURFACE TO SURFACE", "SL,MA"),
        *("*BOUNDARY", "BASE,1,3", "201,1,2", "202,1,3"),
    ]
    for increments, what in ((1, "201,3,3,-.002"), (20, motion)):
        lines += ["*STEP,NLGEOM,INC=100", "*STATIC,DIRECT", f"{1.0 / increments:g},1.", "*BOUNDARY", what]
        lines += ["*NODE PRINT,NSET=ALL,FREQUENCY=100", "U", "*END STEP"]
    path = folder / "deck.inp"
    path.write_text("\n".join(lines) + "\n")
    return path


# what moves it, the largest difference as a part of the largest displacement, and that of the bed as a part of its own,
# which coarse elements leave: a little more than was measured
CASES = {"slides": ("201,1,1,.3\n201,2,2,.1", 6e-4, 0.25), "turns": ("202,3,3,.5", 3e-4, 0.08)}


@pytest.mark.slow
@needs_ccx
@pytest.mark.parametrize("case", CASES)
def test_bodies_that_slide_and_turn_are_where_calculix_has_them(tmp_path: Path, case: str) -> None:
    """A head turns by its finite angle, and the bed gives way alike."""
    motion, largest, beneath = CASES[case]
    path = deck(tmp_path, motion)
    printed = ccx_displacements(path)[-1][:NODES]
    step = sg.solve(sg.read(path)).steps[-1]
    assert np.abs(step.displacement[:NODES] - printed).max() < largest * np.abs(printed).max()
    assert np.abs(step.displacement[25:50] - printed[25:50]).max() < beneath * np.abs(printed[25:50]).max()
    # pairs begin to slip within increments, which need be no shorter than a quarter of a stride
    assert abs(step.energy_defect) < 2e-5 * abs(step.work)
    assert abs(step.released) < 1e-6 * abs(step.work)


@pytest.mark.slow
def test_a_rigid_head_turns_by_its_finite_angle(tmp_path: Path) -> None:
    """Its nodes stay as far apart, without CalculiX too."""
    solution = sg.solve(sg.read(deck(tmp_path, "202,3,3,.5")))
    points, moved = solution.model.mesh.points[59:68], solution.steps[-1].displacement[59:68]
    turn = np.array([[np.cos(0.5), -np.sin(0.5), 0.0], [np.sin(0.5), np.cos(0.5), 0.0], [0.0, 0.0, 1.0]])
    middle = np.array([2.0, 2.0, 2.0])
    assert moved == pytest.approx((points - middle) @ turn.T + middle - points + [0.0, 0.0, -0.002], abs=1e-12)


def test_closures_go_with_pairs_that_follow_the_bodies(tmp_path: Path) -> None:
    path = deck(tmp_path, "201,1,1,.3")
    table = "PRESSURE-OVERCLOSURE=TABULAR\n0.,0.\n1.,1.E-4\n30.,2.E-4"
    path.write_text(path.read_text().replace("PRESSURE-OVERCLOSURE=LINEAR\n1.E6", table))
    (contact,) = sg.read(path).contacts
    assert contact.slides
    assert contact.closure == sg.Closure([(0.0, 0.0), (1e-4, 1.0), (2e-4, 30.0)])
