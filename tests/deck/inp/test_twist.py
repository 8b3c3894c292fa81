# SPDX-License-Identifier: BSD-3-Clause
"""Decks of elements that twist, CGAX: direction 5 is the angle around the axis, its force a torque."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck.error import DeckError
from signorini.gallery.twisted import STEEL
from signorini.model.kind import TWIST
from signorini.reference.torsion import shaft_twist

SHAFT = """*NODE, NSET=ALL
1, 5., 0.
2, 10., 0.
3, 10., 8.
4, 5., 8.
*ELEMENT, TYPE={}, ELSET=E
1, 1, 2, 3, 4
*NSET, NSET=END
3, 4
*MATERIAL, NAME=M
*ELASTIC
210e3, .3
*DENSITY
8e-9
*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
1, 2
2, 2
1, 5
2, 5
*STEP
*STATIC
{}
*END STEP
"""
FIT = """*NODE, NSET=ALL
1, 5., 0.
2, 10.01, 0.
3, 10.01, 4.
4, 5., 4.
11, 10., 0.
12, 20., 0.
13, 20., 4.
14, 10., 4.
99, 0., 0.
*ELEMENT, TYPE=CGAX4, ELSET=SHAFT
1, 1, 2, 3, 4
*ELEMENT, TYPE=CGAX4R, ELSET=HUB
2, 11, 12, 13, 14
*NSET, NSET=GRIP
1, 4
*MATERIAL, NAME=M
*ELASTIC
210e3, .3
*SOLID SECTION, ELSET=SHAFT, MATERIAL=M
*SOLID SECTION, ELSET=HUB, MATERIAL=M
*RIGID BODY, NSET=GRIP, REF NODE=99
*SURFACE, NAME=OUT
SHAFT, S2
*SURFACE, NAME=IN
HUB, S4
*SURFACE INTERACTION, NAME=DRY
*FRICTION
.2
*CONTACT PAIR, INTERACTION=DRY
IN, OUT
*BOUNDARY
12, 2
13, 2
12, 5
13, 5
*STEP
*STATIC
*BOUNDARY
99, 2
99, 5
*END STEP
*STEP
*STATIC
{}
*END STEP
"""


def read(folder: Path, text: str) -> sg.Model:
    path = folder / "twist.inp"
    path.write_text(text)
    return sg.read(path)


@pytest.mark.parametrize("kind", ["CGAX4", "CGAX4R", "CGAX4H"])
def test_angles_and_torques(tmp_path: Path, kind: str) -> None:
    """An angle of all nodes of the end, and the torques on them that cause it."""
    turned = read(tmp_path, SHAFT.format(kind, "*BOUNDARY\nEND, 5, 5, 1e-3"))
    assert turned.kind == TWIST
    found = sg.solve(turned).last
    torque = 1e-3 / shaft_twist(torque=1.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
    np.testing.assert_allclose(found.displacement[2:, 2], [1e-2, 5e-3], rtol=1e-12)
    assert sum(force[2] for name, force in found.reactions.items() if name == "END u5") == pytest.approx(torque)
    nodal = found.external[2:, 2] * [10.0, 5.0]
    loads = "\n".join(f"{number}, 5, {value!r}" for number, value in zip((3, 4), nodal.tolist(), strict=True))
    loaded = sg.solve(read(tmp_path, SHAFT.format(kind, f"*CLOAD\n{loads}"))).last
    np.testing.assert_allclose(loaded.displacement[2:, 2], [1e-2, 5e-3], rtol=1e-9)


def test_weight_goes_along_the_axis(tmp_path: Path) -> None:
    model = read(tmp_path, SHAFT.format("CGAX4", "*DLOAD\nE, GRAV, 9810., 0., -1., 0."))
    weight = 8e-9 * 9810.0 * np.pi * 75.0 * 8.0
    assert sum(force[1] for force in sg.solve(model).last.reactions.values()) == pytest.approx(weight)


def test_a_press_fit_slips_under_torque_and_force(tmp_path: Path) -> None:
    model = read(tmp_path, FIT.format("*BOUNDARY\n99, 2, 2, .02\n99, 5, 5, .003"))
    assert model.kind == TWIST
    solution = sg.solve(model)
    fit = solution.last.contacts[0]
    held = [force for name, force in solution.last.reactions.items() if "rigid" not in name]
    pull, torque = (sum(force[i] for force in held) for i in (1, 2))
    assert np.hypot(torque / 10.0, pull) == pytest.approx(0.2 * fit.pressure @ fit.area, rel=2e-3)
    assert fit.torque == pytest.approx(-torque, rel=1e-9)
    assert solution.last.rigid_bodies["rigid GRIP"].rotation == pytest.approx(0.003)


def test_a_torque_on_the_hub(tmp_path: Path) -> None:
    """The sides overlap as they are drawn, at two radii: all of the torque goes through nevertheless."""
    model = read(tmp_path, FIT.format("*BOUNDARY, OP=NEW\n99, 2\n12, 2, 2\n13, 2, 2\n12, 5\n13, 5\n*CLOAD\n99, 5, 2e4"))
    found = sg.solve(model).last
    assert found.contacts[0].torque == pytest.approx(2e4, rel=1e-9)
    held = (force for name, force in found.reactions.items() if "rigid" not in name)
    assert sum(force[2] for force in held) == pytest.approx(-2e4, rel=1e-9)


@pytest.mark.parametrize("kind", ["CGAX4", "CAX4"])
def test_files_of_bodies_that_yield_beside_a_node_of_no_cell(tmp_path: Path, kind: str) -> None:
    """The reference node of a hub belongs to no cell: fields of flow are written nevertheless."""
    text = FIT.format("*BOUNDARY\n99, 2, 2, .02").replace("210e3, .3\n", "210e3, .3\n*PLASTIC\n40., 0.\n400., .1\n")
    if kind == "CAX4":
        for line in ("12, 5\n", "13, 5\n", "99, 5\n"):
            text = text.replace(line, "")
    solution = sg.solve(read(tmp_path, text.replace("CGAX4R", kind).replace("CGAX4", kind)))
    assert solution.last.yielding.largest > 0.0
    solution.write(tmp_path / "flow.vtu")
    assert (tmp_path / "flow.vtu").is_file()


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("*CLOAD\n3, 3, 1.", r"\*CLOAD: direction 3; expected 1, 2 or 5"),
        ("*BOUNDARY\n3, 4, 4, 1.", r"\*BOUNDARY: direction 4 moves by 1; expected 1, 2 or 5"),
    ],
)
def test_other_directions_are_refused(tmp_path: Path, lines: str, said: str) -> None:
    with pytest.raises(DeckError, match=said):
        read(tmp_path, SHAFT.format("CGAX4", lines))


def test_what_has_no_radius_bears_no_torque(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match="is a torque on node 4, which is on the axis"):
        read(tmp_path, SHAFT.format("CGAX4", "*CLOAD\n4, 5, 1.").replace("4, 5., 8.", "4, 0., 8."))
    linked = SHAFT.format("CGAX4", "").replace(
        "*BOUNDARY\n1, 2", "*EQUATION\n2\n3, 5, 1., 4, 5, -1.\n*BOUNDARY\n1, 2", 1
    )
    with pytest.raises(DeckError, match="direction 5; expected 1 to 2"):
        read(tmp_path, linked)
    with pytest.raises(DeckError, match="CAX4 is axisymmetric, but CGAX4"):
        read(tmp_path, FIT.format("").replace("CGAX4R", "CAX4"))
