# SPDX-License-Identifier: BSD-3-Clause
"""What steps do: amplitudes, changes of friction and contact, temperatures, rotation."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError

DECKS = Path(__file__).parent / "decks"
TWO_BLOCKS = (DECKS / "two_blocks.inp").read_text()
HEAD = TWO_BLOCKS[: TWO_BLOCKS.index("*STEP")]


def read(folder: Path, steps: str, *, before: str = "") -> sg.Model:
    deck = folder / "deck.inp"
    deck.write_text(HEAD + before + steps)
    return sg.read(deck)


def test_an_amplitude_is_followed_turn_by_turn(tmp_path: Path) -> None:
    """It jumps at the beginning and turns inside the step; what has no amplitude goes on in a straight line."""
    model = read(
        tmp_path,
        "*STEP\n*STATIC\n1., 4.\n*BOUNDARY, AMPLITUDE=Zigzag\nTop, 2, 2, -0.001\n*CLOAD\n14, 1, 8.\n*END STEP\n"
        "*STEP\n*STATIC\n1., 2.\n*CLOAD\n14, 1, 4.\n*END STEP\n",
        before="*AMPLITUDE, NAME=Zigzag\n0., 0.5, 1., 1.0, 3., 0.2\n",
    )
    moves, force = "Top u2", "forces on single nodes"
    first, second = (dict(step.scale or {}) for step in model.steps)
    assert first[moves] == pytest.approx((0.5, 1.0, 0.2, 0.2))
    assert first[force] == pytest.approx((0.0, 0.25, 0.75, 1.0))
    # times of the step end with it: what a later step does not set stays as it is
    assert (second[moves], second[force]) == pytest.approx((0.2, 0.5))


def test_total_time_goes_on(tmp_path: Path) -> None:
    step = "*STEP\n*STATIC\n1., 1.\n*BOUNDARY, AMPLITUDE=Ramp\nTop, 2, 2, -0.001\n*END STEP\n"
    ramp = "*AMPLITUDE, NAME=Ramp, TIME=TOTAL TIME\n0., 0., 2., 1.\n"
    model = read(tmp_path, step + step, before=ramp)
    assert [(step.scale or {})["Top u2"] for step in model.steps] == pytest.approx([0.5, 1.0])


def test_steps_can_hold_their_loads(tmp_path: Path) -> None:
    model = read(tmp_path, "*STEP, AMPLITUDE=STEP\n*STATIC\n*BOUNDARY\nTop, 2, 2, -0.001\n*END STEP\n")
    assert (model.steps[0].scale or {})["Top u2"] == (1.0, 1.0)


def test_friction_and_pairs_change(tmp_path: Path) -> None:
    press = "*STEP\n*STATIC\n*BOUNDARY\nTop, 2, 2, -0.001\n*END STEP\n"
    model = read(
        tmp_path,
        press
        + "*STEP\n*STATIC\n*CHANGE FRICTION, INTERACTION=Rub\n*FRICTION\n0.1\n*BOUNDARY\nTop, 1, 1, 0.01\n*END STEP\n"
        + "*STEP\n*STATIC\n*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSslave, Smaster\n*END STEP\n"
        + "*STEP\n*STATIC\n*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nSslave, Smaster\n*END STEP\n",
    )
    _, changed, removed, added = model.steps
    assert dict(changed.friction) == {"Sslave": 0.1}
    assert (removed.inactive, added.active) == (("Sslave",), ("Sslave",))
    second = sg.solve(model).steps[1].contacts[0]
    assert second.tangential_force[0] == pytest.approx(-0.1 * second.normal_force[1])


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("*CHANGE FRICTION, INTERACTION=Rab\n*FRICTION\n0.1", "unknown surface interaction 'Rab'; did you mean 'Rub'"),
        ("*CHANGE FRICTION, INTERACTION=Rub\n*FRICTION\n0.1, 80.", "changes the stick slope"),
        ("*FRICTION\n0.1", r"without \*CHANGE FRICTION"),
        ("*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nLower", "TYPE=ELEMENT is not supported"),
        ("*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSmaster, Sslave", "there is no contact pair"),
    ],
)
def test_other_changes_are_refused(tmp_path: Path, lines: str, said: str) -> None:
    with pytest.raises(DeckError, match=said):
        read(tmp_path, f"*STEP\n*STATIC\n{lines}\n*END STEP\n")


RING = """*NODE, NSET=N
1, 1., 0.
2, 2., 0.
3, 2., 1.
4, 1., 1.
*ELEMENT, TYPE=CAX4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
2.
*EXPANSION
1.D-3
*SOLID SECTION, ELSET=E, MATERIAL=M
*INITIAL CONDITIONS, TYPE=TEMPERATURE
N, 20.
*BOUNDARY
1, 2
2, 2
*STEP
*STATIC
{}
*END STEP
"""


def test_a_free_ring_grows_with_its_temperature(tmp_path: Path) -> None:
    deck = tmp_path / "ring.inp"
    deck.write_text(RING.format("*TEMPERATURE\nN, 120."))
    moved = sg.solve(sg.read(deck)).last.displacement
    points = sg.read(deck).mesh.points
    assert moved == pytest.approx(0.1 * points, abs=1e-12)  # alpha times 100 degrees


def test_gravity_and_rotation_are_those_of_the_package(tmp_path: Path) -> None:
    deck = tmp_path / "ring.inp"
    deck.write_text(RING.format("*DLOAD\nE, CENTRIF, 9., 0., 0., 0., 0., 1., 0.\nE, GRAV, 5., 0., -1., 0."))
    model = sg.read(deck)
    spun, heavy = (next(load for load in model.loads if getattr(load, key)) for key in ("centrifugal", "body_force"))
    assert spun.centrifugal == 3.0
    assert heavy.body_force == (0.0, -10.0)
    weight = 10.0 * np.pi * (4.0 - 1.0)
    reactions = sg.solve(model).last.reactions
    assert sum(force[1] for force in reactions.values()) == pytest.approx(weight)
    deck.write_text(RING.format("*DLOAD\nE, CENTRIF, 9., 0., 0., 0., 0., 0., 1."))
    with pytest.raises(DeckError, match="expected the y axis"):
        sg.read(deck)


def test_supports_come_and_go(tmp_path: Path) -> None:
    """What ``OP=NEW`` does not name lets go; what is new is taken from where it is to its value."""
    step = "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\nBase, 1, 2\n"
    model = read(
        tmp_path,
        f"{step}Top, 2, 2, -0.001\n*END STEP\n{step}Top, 1, 2\n*END STEP\n{step}Top, 2, 2\n*END STEP\n",
    )
    by_name = {support.label: support for support in model.supports}
    first, second, third = model.steps
    (sideways,) = first.release  # that of the second step
    assert by_name[sideways].u == (0.0, None)
    assert (second.restore, third.release) == ((sideways,), (sideways,))
    assert (second.scale or {})["Top u2"] == 0.0  # it is held all along
    history = sg.solve(model)
    top = model.mesh.nodes_of("Top")
    middle, last = history.steps[1:]
    np.testing.assert_allclose(middle.displacement[top], 0.0, atol=1e-15)
    np.testing.assert_allclose(last.displacement, 0.0, atol=1e-12)


def test_friction_has_a_largest_traction(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text(TWO_BLOCKS.replace("*FRICTION", "*FRICTION, TAUMAX=2.5"))
    (contact,) = sg.read(deck).contacts
    assert (contact.friction, contact.shear_limit) == (0.3, 2.5)
    deck.write_text(TWO_BLOCKS.replace("*FRICTION", "*FRICTION, TAUMAX=0."))
    with pytest.raises(DeckError, match=r"\*FRICTION: TAUMAX=0.: expected a traction > 0"):
        sg.read(deck)


@pytest.mark.parametrize(
    ("rows", "points"),
    [
        (".4,,2.\n.3,0.,5.\n.2,,10.", ([2.0, 5.0, 10.0], [0.4, 0.3, 0.2])),
        (".4,,0.\n.3,,4.\n.2,,8.", ([2.0, 4.0, 8.0], [0.35, 0.3, 0.2])),  # up to half the way to the second point
        (".3,,5.", 0.3),
    ],
)
def test_friction_over_pressure(tmp_path: Path, rows: str, points: tuple[list[float], list[float]] | float) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text(TWO_BLOCKS.replace("*FRICTION\n0.3", f"*FRICTION\n{rows}"))
    assert sg.read(deck).contacts[0].friction == (points if isinstance(points, float) else sg.TabularFriction(*points))


@pytest.mark.parametrize(
    ("words", "rows", "told"),
    [
        ("", ".4,,2.\n.3,1.,5.", "a coefficient that depends on the slip rate is not supported"),
        ("", ".4,,2.\n.3,,5.,20.", "a coefficient that depends on temperature is not supported"),
        ("", ".4,,2.\n.3", "has 1 fields; expected the pressure in field 3"),
        ("", ".1,,2.\n.3,,5.", "FRICTION: coefficients: is 0.3 at 5, up to which friction grows faster"),
        ("", ".1,,2.\n-.3,,5.", "the coefficient is -0.3; expected a number >= 0"),
        (", TAUMAX=2.", ".4,,2.\n.3,,5.", "expected a traction > 0, and no ROUGH or table over pressure"),
    ],
)
def test_friction_over_pressure_that_is_none(tmp_path: Path, words: str, rows: str, told: str) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text(TWO_BLOCKS.replace("*FRICTION\n0.3", f"*FRICTION{words}\n{rows}"))
    with pytest.raises(DeckError, match=told):
        sg.read(deck)


PULL = "*STEP\n*STATIC\n*BOUNDARY\nTop, 2, 2, -0.001\n*CLOAD\n16, 1, 40.\n*END STEP\n"


def test_fixed_nodes_stay_where_they_are_and_go_on_from_there(tmp_path: Path) -> None:
    """Node 13 is free, frozen, and taken on to a displacement; its load is gone meanwhile."""
    model = read(
        tmp_path,
        PULL.replace("16, 1", "13, 1")
        + "*STEP\n*STATIC\n*BOUNDARY, FIXED\n13, 1\n*CLOAD, OP=NEW\n*END STEP\n"
        + "*STEP\n*STATIC\n*BOUNDARY\n13, 1, 1, 2.E-4\n*END STEP\n"
        + "*STEP\n*STATIC\n*BOUNDARY, FIXED\n13, 1, 1\n*BOUNDARY\nTop, 2, 2, -0.0015\n*END STEP\n",
    )
    free, frozen, moved, stays = (step.displacement for step in sg.solve(model).steps)
    row = int(np.flatnonzero(model.mesh.labels == 13)[0])
    assert free[row, 0] != 0.0
    assert frozen[row, 0] == pytest.approx(free[row, 0], rel=1e-10)
    assert moved[row, 0] == pytest.approx(2e-4, rel=1e-10)
    assert stays[row, 0] == pytest.approx(2e-4, rel=1e-10)
    held = sg.solve(model).steps[1].reactions
    assert any(abs(force[0]) > 1.0 for name, force in held.items() if name not in ("Base", "Top"))


def test_fixed_keeps_what_an_amplitude_has_reached(tmp_path: Path) -> None:
    """Also where the same card takes all other supports away."""
    model = read(
        tmp_path,
        "*STEP\n*STATIC\n*BOUNDARY, AMPLITUDE=Half\nTop, 2, 2, -0.001\n*END STEP\n"
        "*STEP\n*STATIC\n*BOUNDARY, OP=NEW, FIXED\nBase, 1, 2\nTop, 1, 2\n*END STEP\n",
        before="*AMPLITUDE, NAME=Half\n0., 0., 1., 0.5\n",
    )
    assert [(step.scale or {})["Top u2"] for step in model.steps] == pytest.approx([0.5, 0.5])
    first, second = sg.solve(model).steps
    np.testing.assert_allclose(second.displacement, first.displacement, atol=1e-15)
    assert not any(step.hold or step.release for step in model.steps)


@pytest.mark.parametrize(
    ("card", "said"),
    [
        ("*BOUNDARY, FIXED\nTop, 2, 2, 0.1", "FIXED goes with no displacement, 0.1"),
        ("*BOUNDARY, FIXED, AMPLITUDE=A\nTop, 2", "FIXED goes with no AMPLITUDE"),
    ],
)
def test_fixed_has_no_value(tmp_path: Path, card: str, said: str) -> None:
    with pytest.raises(DeckError, match=said):
        read(tmp_path, f"{PULL}*STEP\n*STATIC\n{card}\n*END STEP\n", before="*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n")


def test_fixed_as_calculix_has_it(tmp_path: Path) -> None:
    """A cube pulled, frozen, taken on, then held by what OP=NEW freezes: the last table of ccx 2.20."""
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    nodes = "".join(f"{k}, {x}., {y}., {z}.\n" for k, (x, y, z) in enumerate(corners, start=1))
    steps = (
        "*BOUNDARY\n5, 3, 3, 0.002\n*CLOAD\n7, 1, 10.\n6, 2, 3.",
        "*BOUNDARY, FIXED\nHEAD, 1, 1\n5, 3, 3\n*CLOAD, OP=NEW\n6, 2, 1.",
        "*BOUNDARY\n7, 1, 1, 0.02",
        "*BOUNDARY, OP=NEW, FIXED\nBASE, 1, 3\n7, 1, 2\n*CLOAD, OP=NEW\n6, 3, 1.",
    )
    deck = tmp_path / "cube.inp"
    deck.write_text(
        f"*NODE\n{nodes}*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=BASE\n1, 2, 3, 4\n"
        "*NSET, NSET=HEAD\n5, 6, 7, 8\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
        "*BOUNDARY\nBASE, 1, 3\n" + "".join(f"*STEP\n*STATIC\n{step}\n*END STEP\n" for step in steps)
    )
    expected = [
        [-1.163051e-03, 9.827500e-03, 1.855409e-03],
        [-4.676990e-03, -5.216645e-03, 3.789408e-03],
        [2.000000e-02, -6.643350e-03, -5.782905e-03],
        [1.200954e-02, 8.203944e-03, 2.498264e-03],
    ]
    np.testing.assert_allclose(sg.solve(sg.read(deck)).last.displacement[4:], expected, atol=1e-8)
