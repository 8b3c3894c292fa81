# SPDX-License-Identifier: BSD-3-Clause
"""``docs/inp.md`` names every keyword and parameter that is read, with tests that exist."""

import ast
import re
from pathlib import Path

from signorini.deck.inp import pairs, steps
from signorini.deck.inp.bonds import BOND_WORDS
from signorini.deck.inp.keywords import MODEL_WORDS, MODES_WORDS, PRINTED, STEP_WORDS, STRUCTURE

ROOT = Path(__file__).parents[3]
TABLE = re.findall(r"^\| (`\*.*) \| (.*) \| (`test_.*`) \|$", (ROOT / "docs" / "inp.md").read_text(), re.MULTILINE)


def words(column: int) -> set[str]:
    """What stands in a column between backticks."""
    return {word for row in TABLE for word in re.findall(r"`([^`]+)`", row[column])}


def test_every_keyword_has_its_line() -> None:
    read = {*MODEL_WORDS, *STEP_WORDS, *MODES_WORDS, *STRUCTURE, *PRINTED, *BOND_WORDS} - {
        "DISTRIBUTING"
    }  # known, to be refused with its reason
    assert {word.removeprefix("*") for word in words(0)} == read


def test_every_parameter_is_there() -> None:
    known = {*pairs.IGNORED, *steps.IGNORED}
    for path in Path(steps.__file__).parent.glob("*.py"):
        for call in ast.walk(ast.parse(path.read_text())):
            if isinstance(call, ast.Call) and getattr(call.func, "attr", "") == "refuse_unknown":
                known |= {node.value for node in ast.walk(call) if isinstance(node, ast.Constant)}
    assert len(known) > 60
    assert known <= {word.partition("=")[0] for word in words(1)}


def test_every_test_is_there() -> None:
    defined = {
        name for path in ROOT.glob("tests/**/test_*.py") for name in re.findall(r"def (test_\w+)", path.read_text())
    }
    assert words(2) <= defined
