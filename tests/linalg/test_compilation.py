# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops: what an earlier version left on disk does no harm, and parts are called by compiled loops alone."""

import ast
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

import pytest

import signorini

ROOT = Path(signorini.__file__).parent

LOOP = """\
from typing import NamedTuple
import numpy as np
from signorini.compilation import kernel

class {name}(NamedTuple):
    values: np.ndarray

@kernel()
def total(of):
    return of.values.sum()

if __name__ == "__main__":
    import loops
    print(loops.total(loops.{name}(np.ones(3))), sum(loops.total.stats.cache_hits.values()))
"""


def ran(folder: Path, name: str) -> str:
    (folder / "loops.py").write_text(LOOP.format(name=name))
    asked = [sys.executable, "loops.py"]
    path = os.pathsep.join([str(Path(__file__).parents[2] / "src"), str(folder)])
    found = subprocess.run(
        asked, cwd=folder, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=False
    )
    return found.stdout.strip() or found.stderr


@pytest.mark.slow
def test_a_class_that_is_gone_is_compiled_anew(tmp_path):
    assert ran(tmp_path, "Earlier") == "3.0 0"
    assert ran(tmp_path, "Earlier") == "3.0 1"
    (index,) = (tmp_path / "__pycache__").glob("loops.total-*.nbi")
    assert b"Earlier" in index.read_bytes()
    assert ran(tmp_path, "Later") == "3.0 0"
    index.write_bytes(pickle.dumps("other") + b"cut off")
    assert ran(tmp_path, "Later") == "3.0 0"


def decorators(function: ast.FunctionDef) -> set[str]:
    calls = [each.func if isinstance(each, ast.Call) else each for each in function.decorator_list]
    return {each.id for each in calls if isinstance(each, ast.Name)}


def functions(tree: ast.AST) -> list[ast.FunctionDef]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]


def test_python_calls_no_part_of_a_kernel():
    """Parts have no wrapper: a call from Python would end the process without a word."""
    trees = {".".join(("signorini", *p.relative_to(ROOT).with_suffix("").parts)): p for p in ROOT.rglob("*.py")}
    parsed = {module: ast.parse(path.read_text()) for module, path in trees.items()}
    parts = {module: {f.name for f in functions(tree) if "part" in decorators(f)} for module, tree in parsed.items()}
    assert sum(map(len, parts.values())) > 50
    wrong = []
    for module, tree in parsed.items():
        imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
        known = parts[module] | {n.name for each in imports for n in each.names if n.name in parts.get(each.module, ())}
        for function in functions(tree):
            asked = re.findall(r"^ *>>> .*?(?<![\w.])(\w+)\(", ast.get_docstring(function) or "", re.MULTILINE)
            called = (
                set()
                if decorators(function) & {"kernel", "part", "njit", "overload"}
                else {node.id for node in ast.walk(function) if isinstance(node, ast.Name)}
            )
            wrong += [f"{module}.{function.name}: {name}" for name in sorted(known & (called | set(asked)))]
    assert wrong == []


BRIEF = """\
import sys
import numpy as np
from signorini import compilation
from signorini.compilation import kernel

compilation.PATIENCE = float(sys.argv[1])

@kernel(brief=True)
def last(values, weight):
    total = 0.0
    for value in values:
        total += weight / value
    return total

values = np.linspace(0.0, 3.0, int(sys.argv[2]))
print(last(values, 0.1).hex(), last(values, 0.1).hex(), len(last.overloads))
"""


@pytest.mark.slow
def test_a_brief_loop_is_interpreted_until_that_takes_as_long_as_to_compile(tmp_path):
    """With the same digits: on little data, while there is patience; and not where it is on disk."""
    (tmp_path / "brief.py").write_text(BRIEF)

    def told(*asked: str) -> list[str]:
        command = [sys.executable, "-W", "error", "brief.py", *asked]
        run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return run.stdout.split()

    interpreted = told("10", "1000")
    many, again = told("10", "60000"), told("10", "1000")
    assert [interpreted[2], many[2], again[2]] == ["0", "1", "1"]
    for index in (tmp_path / "__pycache__").glob("brief*"):
        index.unlink()
    impatient = told("-1", "1000")
    assert impatient[2] == "1"
    assert len({*interpreted[:2], *again[:2], *impatient[:2]}) == 1
