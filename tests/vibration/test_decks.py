"""Modes of decks: the command, the table ``[modes]``, and ``*FREQUENCY`` beside CalculiX."""

import re
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.deck import load_deck
from signorini.model.modes import JOINTS, ModesRequest
from tests.helpers.bar_deck import BAR_ON_A_FLOOR
from tests.helpers.calculix import ccx_frequencies, needs_ccx

BRICKS = sg.box(x=np.linspace(0.0, 4.0, 7), y=[0.0, 0.5, 1.0], z=[0.0, 0.4, 0.8])

BAR = f"""{BAR_ON_A_FLOOR}
[modes]
number = 3
"""


def toml(folder: Path, *changes: tuple[str, str], text: str = BAR) -> Path:
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = folder / "bar.toml"
    path.write_text(text)
    return path


def inp(folder: Path, steps: str) -> Path:
    """A cantilever of bricks, held where x = 0."""
    nodes = "\n".join(f"{k},{x:.10g},{y:.10g},{z:.10g}" for k, (x, y, z) in enumerate(BRICKS.points, start=1))
    bricks = enumerate(BRICKS.cells["hexahedron"], start=1)
    cells = "\n".join(f"{k}," + ",".join(map(str, cell + 1)) for k, cell in bricks)
    held = "\n".join(str(node + 1) for node in np.flatnonzero(BRICKS.points[:, 0] == 0.0))
    tip = int(np.argmax(BRICKS.points.sum(axis=1))) + 1
    path = folder / "beam.inp"
    path.write_text(
        f"*NODE,NSET=ALL\n{nodes}\n*ELEMENT,TYPE=C3D8,ELSET=E\n{cells}\n*NSET,NSET=HELD\n{held}\n*NSET,NSET=TIP\n{tip}\n"
        "*MATERIAL,NAME=M\n*ELASTIC\n1000.,.3\n*DENSITY\n2.\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
        f"*BOUNDARY\nHELD,1,3\n{steps}"
    )
    return path


FREQUENCY = "*STEP\n*FREQUENCY\n6\n*NODE FILE\nU\n*END STEP\n"
STATIC = "*STEP\n*STATIC\n*CLOAD\nTIP,3,.01\n*END STEP\n"


@pytest.mark.slow
def test_the_command_writes_and_tells(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    asked = ["--amplitudes", "2e-5", "--joint", "stuck", "--joint", "open"]
    assert main(["modes", str(toml(tmp_path)), "-o", str(folder), *asked]) == 0
    said = capsys.readouterr().out
    assert "natural frequencies about the end of step 'load', cycles per time" in said
    assert "mode  stuck joint  open joint" in said
    assert "mode 1 of the stuck joint" in said
    names = {"modes.csv", "modes.vtu", "modes.png", "damping.csv", "loops.csv", "damping.png"}
    assert {path.name for path in folder.iterdir()} >= names
    assert (folder / "modes.csv").read_text().count("\n") == 1 + 2 * 3
    assert (folder / "damping.csv").read_text().count("\n") == 1 + 1
    assert main(["modes", str(toml(tmp_path)), "-o", str(folder), "-n", "2", "--quiet"]) == 0
    assert not (folder / "damping.csv").exists()  # of the command before
    assert (folder / "modes.csv").read_text().count("\n") == 1 + 3 * 2
    assert main(["run", str(toml(tmp_path)), "-o", str(folder), "--quiet"]) == 0
    assert not (folder / "modes.csv").exists()  # of a command before


def test_modes_of_bodies_as_they_are_drawn_need_no_supports(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    free = BAR.split("[[contact]]")[0] + "[modes]\npreload = false\n"
    path = toml(tmp_path, text=free)
    assert main(["modes", str(path), "-o", str(tmp_path / "out"), "-n", "4"]) == 0
    said = capsys.readouterr().out
    assert "natural frequencies of the bodies as they are drawn" in said
    assert re.search(r"     3 +0\n     4 +[1-9]", said)
    assert main(["run", str(path), "-o", str(tmp_path / "other")]) == 2
    assert "asks for natural modes of bodies as they are drawn: use 'signorini modes'" in capsys.readouterr().err
    assert main(["check", str(path)]) == 2
    assert "bodies as they are drawn: 'signorini modes' checks them too" in capsys.readouterr().err
    assert main(["check", str(toml(tmp_path))]) == 0
    assert "3 natural modes about the end of the steps are asked for" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "number = 3",
            "numbr = 3",
            "numbr: unknown key; did you mean 'number'? Known: number, joints, preload, mode, ",
        ),
        ("number = 3", "number = 0", "number: is 0; expected a whole number >= 1 and <= 1000"),
        ("number = 3", 'joints = "stuck"', "joints: are 'stuck'; expected a list of states"),
        (
            "number = 3",
            'joints = ["shut"]',
            "joints[0]: unknown state of the joints 'shut'. Known: open, slipping, stuck",
        ),
        ("number = 3", "preload = 1", "preload: is 1; expected true or false"),
        ("number = 3", "amplitudes = [2, 1]", "amplitudes: are [2.0, 1.0]; expected them to ascend"),
        ("number = 3", "amplitudes = 2", "amplitudes: are 2; expected a list of lengths"),
        (
            "number = 3",
            "preload = false\namplitudes = [1.0]",
            "amplitudes: are those of loops about a preload; expected preload = true",
        ),
    ],
)
def test_wrong_tables_are_named(
    old: str, new: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = toml(tmp_path, (old, new))
    assert main(["modes", str(path), "-o", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert f": modes.{said}" in error
    assert error.startswith(f"signorini: {path}:")


def test_wrong_options_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = toml(tmp_path)
    assert main(["modes", str(path), "-o", str(tmp_path / "out"), "-n", "0"]) == 2
    assert capsys.readouterr().err == "signorini: --number: is 0; expected a whole number >= 1 and <= 1000\n"
    light = toml(tmp_path, ("density = 1.0\n", ""))
    assert main(["modes", str(light), "-o", str(tmp_path / "out")]) == 2
    assert "body[0]: 'block' has no density; modes need one in its material" in capsys.readouterr().err


def test_a_frequency_step_asks_for_modes(tmp_path: Path) -> None:
    alone = load_deck(inp(tmp_path, FREQUENCY))
    assert alone.modes == ModesRequest(number=6, preload=False)
    behind = load_deck(inp(tmp_path, STATIC + FREQUENCY.replace("*STEP", "*STEP,PERTURBATION")))
    assert behind.modes == ModesRequest(number=6, joints=JOINTS)
    assert len(behind.model.steps) == 1
    assert any("PERTURBATION, is not in them" in note for note in behind.notes)
    assert load_deck(inp(tmp_path, STATIC)).modes is None
    modes = [
        sg.natural_modes(alone.model, 6).frequencies,
        sg.natural_modes(sg.solve(behind.model), 6).frequencies,
    ]
    assert modes[0] == pytest.approx(modes[1], rel=1e-10)


@needs_ccx
def test_frequencies_are_those_of_calculix(tmp_path: Path) -> None:
    path = inp(tmp_path, FREQUENCY)
    found = sg.natural_modes(load_deck(path).model, 6).frequencies
    assert found == pytest.approx(ccx_frequencies(path), rel=2e-6)


@pytest.mark.parametrize(
    ("steps", "said"),
    [
        (FREQUENCY + STATIC, "*STEP: follows a *FREQUENCY step; expected that to be the last step"),
        (
            FREQUENCY.replace("6\n", "6,0.,100.\n"),
            "has an upper limit or more; expected the number of modes, and a lower",
        ),
        (FREQUENCY.replace("6\n", "0\n"), "is 0; expected a whole number >= 1 and <= 1000"),
        (
            FREQUENCY.replace("*NODE FILE\nU\n", "*CLOAD\nTIP,1,1.\n"),
            "*CLOAD: is not supported inside a *FREQUENCY step",
        ),
        (
            STATIC + FREQUENCY.replace("*NODE FILE\nU\n", "*BOUNDARY\nTIP,1,1\n"),
            "*BOUNDARY: stands in a *FREQUENCY step behind others; expected it in a static step",
        ),
    ],
)
def test_frequency_steps_that_ask_for_more_are_named(steps: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(sg.InputError) as error:
        load_deck(inp(tmp_path, steps))
    assert said in str(error.value)


def test_a_deck_that_is_converted_asks_for_the_same_modes(tmp_path: Path) -> None:
    path = inp(tmp_path, STATIC + FREQUENCY)
    assert main(["convert", str(path), "-o", str(tmp_path / "made.toml")]) == 0
    assert load_deck(tmp_path / "made.toml").modes == load_deck(path).modes
    loops = toml(tmp_path, ("number = 3", "number = 3\namplitudes = [0.1, 0.2]\njoints = ['open']"))
    assert main(["convert", str(loops), "-o", str(tmp_path / "made.toml")]) == 0
    assert load_deck(tmp_path / "made.toml").modes == load_deck(loops).modes
