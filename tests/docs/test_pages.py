# SPDX-License-Identifier: BSD-3-Clause
"""README and docs do what they show: their Python code runs as it stands, decks are read, commands are understood, and
those of README run. A block of another kind needs a comment above it that says why it is not run."""

import importlib.util
import re
import shlex
import tomllib
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.cli.parser import make_parser

ROOT = Path(__file__).parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
FENCES = {
    f"{page.relative_to(ROOT)}:{1 + page.read_text()[: found.start()].count(chr(10))}": found.groups()
    for page in PAGES
    for found in re.finditer(
        r"(<!-- not run: .+? -->\n)?^```(\w*)\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE
    )
}
"""Place to the reason why it is not run, the language, and the text."""


def blocks(language):
    return {place: text for place, (reason, kind, text) in FENCES.items() if kind == language and not reason}


BLOCKS = blocks("python")
COMMANDS = re.findall(r"^signorini ([^#\n]+)", (ROOT / "README.md").read_text(), re.MULTILINE)
SUITES = ("verify", "bench")  # minutes, with tests of their own
GIVEN = {"sg": sg, "M": np.diag([2.0, 3.0]), "q": np.array([-1.0, 1.0]), "start": np.zeros(2), "d": np.ones(2)}
"""What pages leave to their reader."""


@pytest.fixture(autouse=True)
def _beside_the_examples(tmp_path, monkeypatch):
    """A folder to write in that has the examples where README has them."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    mpl.use("agg")


LONG = ("docs/fatigue.md:", "docs/modes.md:", "docs/howto/sweeps.md:")  # pages whose first block takes seconds


@pytest.mark.parametrize(
    "place", [pytest.param(place, marks=[pytest.mark.slow] * place.startswith(LONG)) for place in BLOCKS]
)
def test_python_code_runs(place, tmp_path):
    if ".geo" in BLOCKS[place]:
        pytest.importorskip("gmsh")
    names = dict(GIVEN)
    exec(compile(BLOCKS[place], place, "exec"), names)
    for file in re.findall(r'(?:write|savefig)\("(.+?)"\)', BLOCKS[place]):
        assert (tmp_path / file).stat().st_size > 0
    if "solution" in names:
        assert getattr(names["solution"], "solved", True)


def test_the_code_of_readme_is_its_deck():
    """README: "The same as a deck"."""
    names = dict(GIVEN)
    exec(BLOCKS[next(place for place in BLOCKS if place.startswith("README"))].split("solution.write")[0], names)
    deck = sg.solve(sg.read("examples/hertz_two_bodies.toml"))
    np.testing.assert_allclose(names["pressure"], deck.contact("hertz").pressure, rtol=1e-12)


def test_commands_of_readme_run(capsys):
    names = {command.split()[0] for command in COMMANDS}
    assert names == {"check", "run", "sweep", "explain", "plot", "report", "doctor", *SUITES}
    for command in COMMANDS:
        if command.split()[0] not in SUITES:
            assert main(shlex.split(command)) == 0, capsys.readouterr()


@pytest.mark.parametrize("place", FENCES)
def test_every_block_is_of_a_kind_that_is_tried(place):
    reason, language, _ = FENCES[place]
    assert reason or language in ("python", "toml", "bash"), "say above it why: <!-- not run: ... -->"


@pytest.mark.parametrize("place", blocks("toml"))
def test_decks_are_read(place, tmp_path):
    text = blocks("toml")[place]
    if "[mesh]" not in text:  # a part of a deck, in TOML that can be read
        assert tomllib.loads(text)
        return
    (tmp_path / "deck.toml").write_text(text)
    assert sg.read("deck.toml").bodies


@pytest.mark.parametrize("place", blocks("bash"))
def test_commands_are_understood(place):
    for line in blocks("bash")[place].splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] == ["signorini"]:
            make_parser().parse_args(words[1:])
        elif words[1:2] == ["-m"]:
            assert importlib.util.find_spec(words[2]), words
        else:
            assert words[:1] == ["python3"], words
            assert (ROOT / words[1]).is_file()
