# SPDX-License-Identifier: BSD-3-Clause
"""Every mistake in a deck is told with file, line, key, what was found and what is expected."""

from pathlib import Path

import pytest

from signorini.cli import main
from signorini.deck import DeckError, read

DECK = """\
title = "Disk on a plane"
kind = "plane strain"

[mesh]
generator = "quarter_disk"
radius = 8.0
contact_length = 4.0
contact_spacing = 0.5

[material.soft]
E = 200.0
nu = 0.3

[[body]]
name = "disk"
material = "soft"

[[support]]
on = "axis"
u = [0.0, "free"]

[[load]]
on = "cut"
force = [0.0, -78.0]

[[contact]]
nonmortar = "arc"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = 0.4

[[step]]
name = "press"
increments = 1
"""

MISTAKES = {
    # what is replaced, by what, and what is said after "deck.toml"
    "unknown key": (
        "friction = 0.4",
        "fricton = 0.4",
        ":29: contact[0].fricton: unknown key; did you mean 'friction'? Known: name, between, nonmortar, mortar, "
        "plane, circle, profile, sphere, cylinder, cone, torus, surface, friction, shear_limit, adhesion, gap, "
        "interference, normal_compliance, tangential_compliance, coupling, side, "
        "search, adjust, friction_axis, facets, wear, sliding, closure, cohesion",
    ),
    "sides named twice": (
        'nonmortar = "arc"',
        'between = ["arc", "cut"]',
        ':27: contact[0].between: goes with no \'plane\'; expected two boundaries, as in ["a", "b"], and no other side',
    ),
    "unknown table": (
        "[[step]]",
        "[[stepp]]",
        ":31: stepp: unknown key; did you mean 'step'? Known: title, kind, thickness, units, mesh, material, "
        "solve, solver, modes, body, support, foundation, load, contact, obstacle, rigid_body, equation, "
        "cyclic_symmetry, bolt, fatigue, step",
    ),
    "unknown boundary": (
        'on = "axis"',
        'on = "axes"',
        ":19: support[0].on: unknown boundary or node set 'axes'; did you mean 'axis'? Known: arc, axis, cut",
    ),
    "unknown material": (
        'material = "soft"',
        'material = "sotf"',
        ":16: body[0].material: unknown material 'sotf'; did you mean 'soft'? Known: soft",
    ),
    "no material": (
        'material = "soft"\n',
        "",
        ":14: body[0]: has no 'material'; expected it",
    ),
    "wrong type": ("E = 200.0", 'E = "200"', ":11: material.soft.E: is '200'; expected a number > 0"),
    "E zero": ("E = 200.0", "E = 0.0", ":11: material.soft.E: is 0.0; expected a number > 0"),
    "E too large": (
        "E = 200.0",
        "E = 1e200",
        ":11: material.soft.E: is 1e+200; expected a number > 0 of at most 1e+100",
    ),
    "nu too large": ("nu = 0.3", "nu = 0.5", ":12: material.soft.nu: is 0.5; expected a number > -1 and < 0.5"),
    "friction negative": (
        "friction = 0.4",
        "friction = -0.1",
        ":29: contact[0].friction: is -0.1; expected a number >= 0",
    ),
    "empty contact": (
        'nonmortar = "arc"\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\nfriction = 0.4\n',
        "",
        ":26: contact[0]: has no 'nonmortar'; expected it",
    ),
    "rigid shape as a side": (
        "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n",
        "mortar = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }\n",
        ":28: contact[0].mortar: is a table; expected the name of a boundary or obstacle; a rigid shape stands in its "
        "place, as plane = { ... }",
    ),
    "contact with nothing": (
        "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n",
        "",
        ":26: contact[0]: has no other side; expected one of mortar, plane, circle, profile, sphere, cylinder, cone, "
        "torus, surface",
    ),
    "plane without direction": (
        "normal = [0.0, 1.0]",
        "normal = [0.0, 0.0]",
        ":28: contact[0].plane.normal: is zero; expected a direction",
    ),
    "plane turned over": (
        "normal = [0.0, 1.0]",
        "normal = [0.0, -1.0]",
        ":28: contact[0].plane: 'arc' faces away from the plane; its normal (0.0, -1.0) must point from the obstacle "
        "towards the body",
    ),
    "no such mesh file": (
        'generator = "quarter_disk"\nradius = 8.0\ncontact_length = 4.0\ncontact_spacing = 0.5',
        'file = "disk.msh"',
        ":5: mesh.file: there is no file '{folder}disk.msh'",
    ),
    "unknown generator": (
        '"quarter_disk"',
        '"quarterdisk"',
        ":5: mesh.generator: unknown generator 'quarterdisk'; did you mean 'quarter_disk'? Known: annulus, box, "
        "half_disk, "
        "quarter_disk, rectangle",
    ),
    "parameter missing": ("radius = 8.0\n", "", ":4: mesh: has no 'radius'; expected it"),
    "parameter wrong": (
        "contact_length = 4.0",
        "contact_length = 7.0",
        ":7: mesh.contact_length: is 7; expected at most 0.7 radius = 5.6",
    ),
    "kind of another dimension": ('"plane strain"', '"3d"', ":2: kind: is '3d', but the mesh has 2 coordinates"),
    "single brackets": (
        "[[load]]",
        "[load]",
        ":22: load: is a single table; expected [[load]], in double brackets, for each",
    ),
    "two loads in one": (
        "force = [0.0, -78.0]",
        "force = [0.0, -78.0]\npressure = 3.0",
        ":22: load[0]: has force and pressure; expected exactly one of force, nodal_forces, traction, pressure, "
        "bearing, body_force, gravity, centrifugal, temperature, torque",
    ),
    "no node there": (
        'on = "cut"',
        "on = [50.0, 0.0]",
        ":23: load[0].on: no node at (50.0, 0.0); the nearest is node 65 at (8.0, 8.0)",
    ),
    "unknown factor": (
        "increments = 1",
        "scale = { cat = 1.0 }",
        ":33: step[0].scale: unknown load or moving support 'cat'; did you mean 'cut'? Known: cut",
    ),
    "TOML": ("E = 200.0", "E = ", ":11: not valid TOML: Invalid value at column 5, in 'E ='"),
    "free motion": (
        '[[contact]]\nnonmortar = "arc"\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\nfriction = 0.4\n',
        "",
        ": body 'disk' can move along y: no support or contact holds it; add a support",
    ),
    "slides away": (
        '[[support]]\non = "axis"\nu = [0.0, "free"]\n\n[[load]]\non = "cut"\nforce = [0.0, -78.0]\n\n'
        '[[contact]]\nnonmortar = "arc"\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\nfriction = 0.4\n',
        '[[load]]\non = "cut"\nforce = [0.0, -78.0]\n\n'
        '[[contact]]\nnonmortar = "arc"\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n',
        ": body 'disk' can move along x: nothing but frictionless contact, which cannot resist; add a support or "
        "friction",
    ),
}


@pytest.mark.parametrize(("old", "new", "said"), MISTAKES.values(), ids=MISTAKES)
def test_message_and_exit_code(
    old: str, new: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert DECK.count(old) == 1
    path = tmp_path / "deck.toml"
    path.write_text(DECK.replace(old, new))
    assert main(["run", str(path), "-o", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == f"signorini: {path}{said.replace('{folder}', f'{tmp_path}/')}\n"
    assert not list((tmp_path / "out").glob("*"))


def test_the_deck_without_mistakes_is_right(tmp_path: Path) -> None:
    path = tmp_path / "deck.toml"
    path.write_text(DECK)
    model = read(path)
    assert [contact.friction for contact in model.contacts] == [0.4]
    assert [step.name for step in model.steps] == ["press"]
    assert model.title == "Disk on a plane"


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("deck.toml", None, "file not found"),
        ("deck.toml", b"\xff\xfe", "is not a text file (UTF-8); expected a deck, a TOML file"),
        ("deck.inp", b"*NODE", "has no *ELEMENT; expected one"),
        ("deck.toml", b"", "there is no mesh; expected [mesh] with a generator or a file"),
    ],
)
def test_files_that_are_no_deck(name: str, content: bytes | None, said: str, tmp_path: Path) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(DeckError) as caught:
        read(path)
    assert str(caught.value) == f"{path}: {said}"


def test_meshes_are_joined_under_their_names(tmp_path: Path) -> None:
    path = tmp_path / "deck.toml"
    path.write_text(
        '[[mesh]]\nname = "left"\ngenerator = "rectangle"\n\n[[mesh]]\nname = "right"\ngenerator = "rectangle"\n'
        'origin = [1.0, 0.0]\n\n[material.m]\nE = 1.0\nnu = 0.0\n\n[[body]]\nname = "left"\nmaterial = "m"\n\n'
        '[[body]]\nname = "right"\nmaterial = "m"\n\n[[support]]\non = "left.left"\nu = [0.0, 0.0]\n'
    )
    assert sorted(read(path).mesh.boundaries)[:2] == ["left.bottom", "left.left"]
    wrong = path.read_text().replace("origin = [1.0, 0.0]", "origin = [1.0]")
    path.write_text(wrong)
    with pytest.raises(DeckError, match=r"deck\.toml:8: mesh\[1\]\.origin: has 1 components"):
        read(path)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("x = " + "[" * 5000 + "]" * 5000, "nested too deeply"),
        ("x = 1" + "0" * 5000, "not valid TOML"),
        ("thickness = 1" + "0" * 400, r":1: thickness: is a number of more than 30 digits; expected a number > 0"),
        ("thickness = 0x" + "f" * 5000, r":1: thickness: is a number of more than 30 digits; expected a number > 0"),
    ],
)
def test_numbers_and_nesting_without_end(tmp_path, line, said):
    deck = tmp_path / "deck.toml"
    deck.write_text(f"{line}\n{DECK}")
    with pytest.raises(DeckError, match=said):
        read(deck)


LARGE = {
    "rectangle": ("nx = 1000000000\nny = 1000000000", "a grid of 1e\\+09 points takes 350 GB|mesh.nx: a grid of"),
    "quarter_disk": ("radius = 8.0\ncontact_length = 4.0\ncontact_spacing = 1e-320", "takes inf GB of memory"),
    "annulus": ("inner = 1.0\nouter = 2.0\nn_radial = 1000000000\nn_angular = 1000000000", "1e\\+18 points takes"),
    "box": (f"x = {list(range(3000))}\ny = {list(range(3000))}\nz = {list(range(3000))}", "2.7e\\+10 points takes"),
}


@pytest.mark.parametrize("generator", LARGE)
def test_grids_that_no_memory_holds(tmp_path, generator):
    keys, said = LARGE[generator]
    deck = tmp_path / "deck.toml"
    body = '[material.a]\nE = 1.0\nnu = 0.3\n[[body]]\nname = "a"\nmaterial = "a"\n'
    deck.write_text(f'[mesh]\ngenerator = "{generator}"\n{keys}\n{body}')
    with pytest.raises(DeckError, match=said):
        read(deck)


@pytest.mark.parametrize("key", ["repeat", "increments", "at"])
def test_steps_without_end(tmp_path, key):
    deck = tmp_path / "deck.toml"
    deck.write_text(DECK + f"[[step]]\n{key} = 1000000000\n")
    with pytest.raises(DeckError, match=rf"{key}: is 1000000000; expected a whole number >= 1 and <= 1000000"):
        read(deck)
