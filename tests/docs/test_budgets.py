# SPDX-License-Identifier: BSD-3-Clause
"""The table of budgets says what the code does, and holds every search of the rooms that search."""

import ast
import importlib
import re
from pathlib import Path

import pytest

from signorini.settings import SolverSettings

ROOT = Path(__file__).parents[2]
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in (ROOT / "docs" / "budgets.md").read_text().splitlines()
    if line.startswith("|") and "`" in line
]
WHERE = [row[4].strip("`") for row in ROWS]
ROOMS = ("friction", "engine", "iterative")
NOT_SEARCHES = {
    "engine.validity_notes._PAIRS_ACROSS",  # layers of pairs that are counted
    "friction.history.space.no_rates_proof._TANGENTS",  # of a circle
    "iterative.aggregation._EIGENVALUE_STEPS",  # of an estimate, which a preconditioner is damped by
    "friction.space.sweeps._LOCAL_STEPS",  # of the fixed point of one pair, in a sweep whose residual is measured
}


def value(where):
    module, name = where.rsplit(".", 1)
    owner = SolverSettings() if module == "SolverSettings" else importlib.import_module(f"signorini.{module}")
    return getattr(owner, name)


@pytest.mark.parametrize("row", ROWS, ids=WHERE)
def test_a_row_says_what_the_code_does(row):
    assert len(row) == 6
    assert all(row[2:])
    found = value(row[4].strip("`"))
    said = [f"{number:g}" for number in found] if isinstance(found, tuple) else [f"{found:.12g}"]
    assert row[3] == ", ".join(said)


def test_every_setting_that_limits_a_search_is_a_row():
    known = {where.rsplit(".", 1)[1] for where in WHERE if where.startswith("SolverSettings")}
    assert set(SolverSettings.__dataclass_fields__) - known == {"tolerance", "many_pairs"}


def limits(path):
    """Constants of a module that loops end at: in ``range``, ``islice`` or a comparison of ``while``."""
    for node in ast.walk(ast.parse(path.read_text())):
        heads = []
        if isinstance(node, ast.For | ast.comprehension):
            heads = [node.iter] if isinstance(node.iter, ast.Call) else []
            heads = [head.args[:2][-1] for head in heads if getattr(head.func, "id", "") in ("range", "islice")]
        elif isinstance(node, ast.While):
            heads = [node.test]
        for head in heads:
            yield from (
                name.id for name in ast.walk(head) if isinstance(name, ast.Name) and re.fullmatch(r"_?[A-Z_]+", name.id)
            )


def test_loops_that_end_at_a_constant_are_in_the_table():
    """A new search comes with its row."""
    source, found = ROOT / "src" / "signorini", set()
    for path in (path for room in ROOMS for path in sorted((source / room).rglob("*.py"))):
        module = ".".join(path.relative_to(source).with_suffix("").parts)
        found |= {f"{module}.{name}" for name in limits(path)}
    assert len(found) > 10
    assert found - set(WHERE) - NOT_SEARCHES == set()
