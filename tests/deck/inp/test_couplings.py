# SPDX-License-Identifier: BSD-3-Clause
"""``*COUPLING`` with ``*KINEMATIC``."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from tests.helpers.two_cells import two_cells

MESH = two_cells("99,0.7,2.") + "*SURFACE,NAME=STOP\nE,S3\n"
LOADS = "*CLOAD\n99,1,0.3\n99,2,-1.\n99,6,0.5\n"
CUBE = """*NODE
1,0,0,0
2,1,0,0
3,1,1,0
4,0,1,0
5,0,0,1
6,1,0,1
7,1,1,1
8,0,1,1
99,0.3,0.4,2.
*ELEMENT,TYPE=C3D8,ELSET=E
1,1,2,3,4,5,6,7,8
*SURFACE,NAME=STOP
1,S2
*MATERIAL,NAME=M
*ELASTIC
100.,0.3
*SOLID SECTION,ELSET=E,MATERIAL=M
*BOUNDARY
1,1,3
2,1,3
3,1,3
4,1,3
"""


def deck(folder: Path, coupling: str, inside: str, mesh: str = MESH) -> Path:
    path = folder / "deck.inp"
    path.write_text(f"{mesh}{coupling}*STEP\n*STATIC\n{inside}*END STEP\n")
    return path


@pytest.mark.parametrize("directions", ["", "1,2\n", "1,6\n", "1\n2\n"])
def test_all_directions_are_a_rigid_body(tmp_path: Path, directions: str) -> None:
    coupling = f"*COUPLING, CONSTRAINT NAME=C, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n{directions}"
    ours = sg.solve(sg.read(deck(tmp_path, coupling, LOADS))).last
    same = sg.solve(sg.read(deck(tmp_path, "*RIGID BODY, NSET=TOP, REF NODE=99\n", LOADS))).last
    np.testing.assert_allclose(ours.displacement, same.displacement, rtol=0.0, atol=1e-15)
    assert ours.rigid_bodies["rigid STOP"].rotation == pytest.approx(same.rigid_bodies["rigid TOP"].rotation)


@pytest.mark.parametrize(
    ("axis", "held", "moments"),
    [
        (0, "99,2,5\n", (0.0, 0.0, -0.3)),
        (1, "99,1\n99,3,5\n", (0.0, 0.0, 0.2)),
        (2, "99,1,2\n99,6\n", (0.2, -0.3, 0.0)),
    ],
)
def test_one_direction_in_space(tmp_path: Path, axis: int, held: str, moments: tuple[float, ...]) -> None:
    """Only that displacement follows ``u + theta x r``; the rest of the reference node is held, for it is loose."""
    coupling = f"*COUPLING, CONSTRAINT NAME=C, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n{axis + 1}\n"
    turned = "".join(f"99,{4 + k},{moment}\n" for k, moment in enumerate(moments) if moment)
    model = sg.read(deck(tmp_path, coupling, f"*BOUNDARY\n{held}*CLOAD\n99,{axis + 1},1.\n{turned}", CUBE))
    step = sg.solve(model).last
    body = step.rigid_bodies["rigid STOP"]
    u, theta = np.array(body.displacement), np.array(body.rotation)
    follow = (u + np.cross(theta, model.mesh.points[4:8] - model.mesh.points[8]))[:, axis]
    np.testing.assert_allclose(step.displacement[4:8, axis], follow, rtol=0.0, atol=1e-13 * abs(u).max())
    others = [k for k in range(3) if k != axis]
    assert np.ptp(step.displacement[4:8][:, others], axis=0).max() > 1e-3 * abs(u).max()
    assert step.strain_energy == pytest.approx((u[axis] + np.dot(moments, theta)) / 2.0)


def test_what_nothing_follows_needs_no_support(tmp_path: Path) -> None:
    """Of the reference node of one direction three displacements and rotations are held as if by the deck."""
    coupling = "*COUPLING, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n1,1\n"
    load_words = "*BOUNDARY\n99,5\n*CLOAD\n99,1,1.\n99,6,-0.3\n"
    found, held = (
        sg.solve(sg.read(deck(tmp_path, coupling, f"{more}{load_words}", CUBE))).last
        for more in ("", "*BOUNDARY\n99,2,4\n")
    )
    np.testing.assert_allclose(found.displacement, held.displacement, rtol=0.0, atol=1e-15)
    assert not np.any(found.reactions["rigid STOP idle"])
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*CLOAD: acts on 'y' of the reference node of line \d+"):
        load_deck(deck(tmp_path, coupling, "*CLOAD\n99,2,1.\n", CUBE))


@pytest.mark.parametrize(
    ("coupling", "words"),
    [
        ("*COUPLING, REF NODE=99, SURFACE=STOP\n*DISTRIBUTING\n", r"\*DISTRIBUTING: is not supported"),
        ("*COUPLING, REF NODE=99, SURFACE=STOP\n", r"\*COUPLING: expected \*KINEMATIC behind it"),
        ("*KINEMATIC\n1\n", r"\*KINEMATIC: stands without \*COUPLING"),
        ("*COUPLING, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n3,3\n", "couples no displacement"),
        ("*COUPLING, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n2,1\n", "directions 2 to 1"),
        ("*COUPLING, REF NODE=99, SURFACE=SBOT\n*KINEMATIC\n", "unknown surface 'SBOT'"),
        ("*COUPLING, REF NODE=99, SURFACE=STOP, ORIENTATION=O\n*KINEMATIC\n", "ORIENTATION is not supported"),
        ("*RIGID BODY, NSET=TOP, REF NODE=99\n*COUPLING, REF NODE=99, SURFACE=STOP\n*KINEMATIC\n", "node in common"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, coupling: str, words: str) -> None:
    with pytest.raises(DeckError, match=words):
        load_deck(deck(tmp_path, coupling, LOADS))
