# SPDX-License-Identifier: BSD-3-Clause
"""The one-way architecture, read from the source: who imports whom (inside functions and for types too), and sizes."""

import ast
import functools
import graphlib
from pathlib import Path

import pytest

import signorini

ROOT = Path(signorini.__file__).parent
FILES = sorted(ROOT.rglob("*.py"))

BASE = {
    "errors",
    "arrays",
    "checks",
    "clock",
    "meshio_fixes",
    "hdf5",
    "memory",
    "bound",
    "pairstate",
    "short",
    "sources",
    "trace",
    "_version",
}
CORE = {"model", "linalg", "lcp", "fem", "interface", "condense", "iterative", "friction", "solution"}
BELOW_CLI = BASE | CORE | {"engine", "deck", "output", "plot", "reference"}

# folder or file: what it may import besides itself and the base
ALLOWED = {
    "model": set(),
    "linalg": set(),
    "lcp": {"linalg"},
    "fem": {"model"},
    "interface": {"fem", "model"},
    "condense": {"linalg", "interface"},
    "iterative": {"linalg", "interface"},
    "friction": {"linalg", "lcp", "condense"},
    "solution": {"model", "fem", "interface"},
    "engine": CORE,
    "deck": {"model", "fem"},
    "output": {"solution", "model", "fem"},
    "plot": {"solution", "model"},
    "reference": set(),
    "gallery": BELOW_CLI | {"api"},
    "verify": BELOW_CLI | {"api", "gallery"},
    "bench": BELOW_CLI | {"api", "gallery"},
    "api": BELOW_CLI,
    "__init__": BELOW_CLI | {"api", "gallery", "verify", "bench"},
    "cli": BELOW_CLI | {"api", "gallery", "verify", "bench", "__init__"},
    "__main__": {"cli"},
}
# narrower than a folder: stresses are for pictures and files, assembly and supports are not
FEM_FOR_OUTPUT = {"signorini.fem.space", "signorini.fem.stress"}


def module_name(path):
    parts = ("signorini", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in FILES}


@functools.cache
def imports(name):
    """Modules of ours that a module imports, wherever the import stands."""
    found = set()
    for node in ast.walk(ast.parse(MODULES[name].read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name} imports relatively, line {node.lineno}"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                found.add(whole if whole in MODULES else str(node.module))
    return {target for target in found if target.split(".")[0] == "signorini"}


def room(name):
    """The first part below the package: a folder or a file of its root."""
    parts = name.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


@pytest.mark.parametrize("name", MODULES)
def test_imports_go_one_way(name):
    here = room(name)
    assert here in BASE or here in ALLOWED, f"{name}: a new room; say in ALLOWED what it may import"
    allowed = {here} | BASE | ALLOWED.get(here, set())
    wrong = sorted(target for target in imports(name) if room(target) not in allowed)
    assert not wrong, f"{name} may not import {wrong}"
    if here in ("output", "plot"):
        assert {target for target in imports(name) if room(target) == "fem"} <= FEM_FOR_OUTPUT


def test_no_cycles():
    # a package and its modules are one step apart: importing the module runs the package first
    graph = {name: imports(name) & set(MODULES) - {name} for name in MODULES}
    graphlib.TopologicalSorter(graph).prepare()


def test_only_fem_knows_scikit_fem():
    # a benchmark or a verification may use it for a problem of its own, so that it measures nothing of ours
    knowing = {room(name) for name, path in MODULES.items() if "skfem" in path.read_text()}
    assert knowing <= {"fem", "bench", "verify"}


def body_lines(function):
    """Lines of a function without its signature and docstring."""
    body = function.body[1:] if ast.get_docstring(function, clean=False) is not None else function.body
    return function.end_lineno - body[0].lineno + 1 if body else 0


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_are_small_and_licensed(path):
    lines = path.read_text().splitlines()
    assert lines[0] == "# SPDX-License-Identifier: BSD-3-Clause"
    assert len(lines) < 500
    functions = [
        node
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    long = {f"{function.name} ({size})" for function in functions if (size := body_lines(function)) >= 60}
    assert not long
