# SPDX-License-Identifier: BSD-3-Clause
"""The house, read from the source: who imports whom (inside functions and for types too), sizes, names and docstrings.

``python tests/test_architecture.py ROOM ...`` lists what breaks the rules of size, name and docstring in the rooms
named, in every room where none is.
"""

import ast
import collections
import functools
import gc
import graphlib
import itertools
import re
import sys
from pathlib import Path

import pytest

import signorini
from signorini.doors import DOORS

ROOT = Path(signorini.__file__).parent
FILES = sorted(ROOT.rglob("*.py"))
FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
HOUSE = Path(__file__).parents[1]

BASE = {
    "attempt",
    "errors",
    "arrays",
    "blas_threads",
    "checks",
    "clock",
    "compilation",
    "cores",
    "crew",
    "dense",
    "doors",
    "meshio_fixes",
    "hdf5",
    "memory",
    "outcome",
    "settings",
    "short",
    "sources",
    "sparse_rows",
    "turn",
    "_version",
}
CORE = {
    "law",
    "fatigue",
    "model",
    "meshing",
    "linalg",
    "lcp",
    "fem",
    "interface",
    "condense",
    "iterative",
    "distributed",
    "friction",
    "plasticity",
    "solution",
}
BELOW_CLI = (
    BASE
    | CORE
    | {"engine", "vibration", "derivative", "accuracy", "deck", "output", "plot", "inspection", "report", "reference"}
)

# folder or file: what it may import besides itself and the base
ALLOWED = {
    "fatigue": set(),
    "model": {"law", "fatigue"},
    "linalg": set(),
    "lcp": {"linalg"},
    "law": set(),
    "meshing": {"model"},
    "fem": {"model", "meshing"},
    "distributed": {"law", "linalg", "model", "fem", "interface", "iterative"},
    "interface": {"law", "meshing", "fem", "model"},
    "condense": {"linalg", "interface"},
    "iterative": {"law", "linalg", "interface"},
    "friction": {"law", "linalg", "lcp", "condense"},
    "plasticity": {"model", "fem"},
    "solution": {"law", "model", "fem", "interface", "plasticity"},
    "engine": CORE,
    "vibration": CORE | {"engine"},
    "accuracy": CORE | {"engine", "derivative"},
    "derivative": CORE | {"engine"},
    "deck": {"law", "fatigue", "model", "meshing", "fem"},
    "output": {"solution", "law", "fatigue", "model", "meshing", "fem", "plasticity", "distributed"},
    "plot": {"solution", "law", "model", "output"},
    "inspection": CORE | {"engine", "deck", "output"},
    "report": {"solution", "law", "model", "output", "plot", "inspection"},
    "reference": set(),
    "gallery": BELOW_CLI | {"api"},
    "verify": BELOW_CLI | {"api", "solved", "gallery"},
    "bench": BELOW_CLI | {"api", "gallery"},
    "history_moment": BELOW_CLI,
    "history_fields": BELOW_CLI | {"history_moment"},
    "solved": BELOW_CLI | {"history_fields"},
    "api": BELOW_CLI | {"solved"},
    "prepared": BELOW_CLI | {"api", "solved"},
    "study": BELOW_CLI,
    "__init__": BELOW_CLI | {"solved", "api", "prepared", "study", "gallery", "verify", "bench"},
    "cli": BELOW_CLI | {"api", "study", "gallery", "verify", "bench", "__init__"},
    "__main__": {"cli"},
}
# narrower than a folder: stresses are for pictures and files, assembly, supports and flow rules are not
FEM_FOR_OUTPUT = {"signorini.fem.space", "signorini.fem.stress", "signorini.plasticity.fields"}


@pytest.fixture(autouse=True, scope="module")
def _no_collection():
    """Millions of nodes of trees, none of which is garbage: collections among them take most of the time, here and in
    every test after."""
    gc.disable()
    yield
    for cache in (tree, statements, imports, names_in):
        cache.cache_clear()
    gc.enable()


def module_name(path):
    parts = ("signorini", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in FILES}


@functools.cache
def tree(path):
    return ast.parse(path.read_text())


@functools.cache
def statements(path):
    """Every statement of a file, wherever it stands, each with the class, function or module around it."""
    found, left = [], [(tree(path), None)]
    while left:
        node, around = left.pop()
        inside = node if isinstance(node, FUNCTION | ast.ClassDef | ast.Module) else around
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            children = [(child, inside) for child in getattr(node, part, ())]
            found += children
            left += children
    return found


@functools.cache
def imports(name):
    """Modules of ours that a module imports, wherever the import stands."""
    found = set()
    for node, _ in statements(MODULES[name]):
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


def test_imports_go_one_way():
    wrong = []
    for name in MODULES:
        here = room(name)
        assert here in BASE or here in ALLOWED, f"{name}: a new room; say in ALLOWED what it may import"
        allowed = {here} | BASE | ALLOWED.get(here, set())
        no_picture = {
            target for target in imports(name) if here in ("output", "plot") and room(target) in ("fem", "plasticity")
        }
        wrong += [
            f"{name} may not import {target}"
            for target in sorted(imports(name))
            if room(target) not in allowed or target in no_picture - FEM_FOR_OUTPUT
        ]
    assert not wrong, "\n" + "\n".join(wrong)


def test_no_cycles():
    # a package and its modules are one step apart: importing the module runs the package first
    graph = {name: imports(name) & set(MODULES) - {name} for name in MODULES}
    graphlib.TopologicalSorter(graph).prepare()


def test_doors_lead_somewhere():
    """Names of modules in text, which the graph of imports does not see."""
    for name, module in DOORS.items():
        assert name in names_in(module)
        assert room(module) in ("plot", "report")


def test_only_fem_knows_scikit_fem():
    # a benchmark or a verification may use it for a problem of its own, so that it measures nothing of ours
    knowing = {room(name) for name, path in MODULES.items() if "skfem" in path.read_text()}
    assert knowing <= {"fem", "gallery", "verify"}


OUTSIDE = sorted(path for folder in ("tests", "benchmarks", "examples") for path in (HOUSE / folder).rglob("*.py"))


@functools.cache
def names_in(module):
    """What a module defines and imports, wherever that stands."""
    found = set(signorini.__all__) if module == "signorini" else set()
    for node, _ in statements(MODULES[module]):
        if isinstance(node, ast.Import | ast.ImportFrom):
            found |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, FUNCTION | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found |= {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    return found


def is_there(name):
    """Whether a dotted name of ours leads to a module, or to something in one."""
    parts = name.split(".")
    depth = max(count for count in range(1, len(parts) + 1) if ".".join(parts[:count]) in MODULES)
    return depth == len(parts) or parts[depth] in names_in(".".join(parts[:depth]))


def test_what_others_import_is_there():
    """Also in functions, and where a test replaces something by its name."""
    wrong = []
    for path in OUTSIDE:
        asked = set(re.findall(r'setattr\(\s*"(signorini[\w.]*)"', path.read_text()))
        for node, _ in statements(path):
            if isinstance(node, ast.Import):
                asked |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                asked |= {f"{node.module}.{alias.name}" for alias in node.names}
        ours = sorted(name for name in asked if name.split(".")[0] == "signorini")
        wrong += [f"{path.relative_to(HOUSE)}: there is no {name}" for name in ours if not is_there(name)]
    assert not wrong, "\n" + "\n".join(wrong)


def body_lines(function):
    """Lines of a function without its signature and docstring."""
    body = function.body[1:] if ast.get_docstring(function, clean=False) is not None else function.body
    return function.end_lineno - body[0].lineno + 1 if body else 0


LARGEST_FILE = 400  # lines
LARGEST_FUNCTION = 59  # lines without signature and docstring
MOST_PARAMETERS = 9
NAMED_FROM = 3  # parameters on which a public function names all of them
NO_NOUN = re.compile(r"(The same|That|Those|These|Them)\b")
"""Beginnings of a docstring that refer to what stands above it, until someone moves it."""
SAYS_NOTHING = re.compile(
    "ABOUT|ACROSS|ALONG|APART|AROUND|BARELY|BELOW|BESIDE|BETWEEN|BEYOND|CLEARLY|CLOSE|COARSER|COLDER|"
    "ENOUGH|FAR|FARTHEST|FAST|FEW|FEWEST|FINE|FINER|FLAT|HARDLY|INEXACT|LARGE|LARGEST|LATE|LEAST|LIGHT|"
    "LITTLE|LONG|LONGEST|LOOSE|MANY|MORE|MOST|NARROWEST|NEAR|NEARLY|NEVER|NONE|NOTHING|OBLIQUE|ROUGH|"
    "ROUND|ROUNDED|ROUNDING|SAME|SHARP|SHORTEST|SLIGHT|SMALL|SMALLEST|SOFT|SOFTEST|STEEP|STICKY|STIFF|"
    "STIFFISH|STRONGEST|THIN|THINNEST|TOGETHER|TRUSTED|UNEVEN|WEAK|WIDEST|WRONG"
)
"""Words that are no name of a number: they say neither of what nor how it is meant."""


def parameters(function, parent):
    """Names of a function's parameters, without self, cls and stars."""
    names = [arg.arg for arg in (*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs)]
    return names[1:] if isinstance(parent, ast.ClassDef) and names[:1] in (["self"], ["cls"]) else names


def public(node, parent=None):
    """Public functions, methods and classes below a node, each with its parent."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, FUNCTION | ast.ClassDef):
            if child.name.startswith("_"):
                continue
            yield child, node
            if isinstance(child, ast.ClassDef):
                yield from public(child, node)
        elif not isinstance(child, ast.expr):
            yield from public(child, parent)


def numbers(path):
    """Names of module constants that are numbers, each with its line."""
    for node in tree(path).body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            both = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
            for name, value in zip(target.elts, node.value.elts, strict=True) if both else [(target, node.value)]:
                if isinstance(name, ast.Name) and name.id.isupper() and not isinstance(value, ast.Dict | ast.Call):
                    yield name.id, node.lineno


def long_files():
    for path in FILES:
        if (lines := len(path.read_text().splitlines())) > LARGEST_FILE:
            yield path, lines, f"has {lines} lines; expected at most {LARGEST_FILE}"


def many_parameters():
    for path in FILES:
        for node, parent in statements(path):
            if isinstance(node, FUNCTION) and (count := len(parameters(node, parent))) > MOST_PARAMETERS:
                yield path, node.lineno, f"{node.name} has {count} parameters; give some of them a value with a name"


def docstrings_without_noun():
    for path in FILES:
        for node in (tree(path), *(node for node, _ in statements(path))):
            if isinstance(node, FUNCTION | ast.ClassDef | ast.Module):
                words = ast.get_docstring(node) or ""
                if NO_NOUN.match(words):
                    line = getattr(node, "lineno", 1)
                    yield path, line, f"docstring begins with {words.splitlines()[0][:40]!r}; name what it is"


def silent_parameters():
    for path in FILES:
        for node, parent in public(tree(path)):
            if isinstance(node, FUNCTION) and len(names := parameters(node, parent)) >= NAMED_FROM:
                words = ast.get_docstring(node) or ""
                silent = [name for name in names if not re.search(rf"\b{name}\b", words)]
                if silent:
                    yield path, node.lineno, f"{node.name}: docstring does not name {', '.join(silent)}"


def classes_of_one_name():
    homes = collections.defaultdict(list)
    for path in FILES:
        for node, _ in public(tree(path)):
            if isinstance(node, ast.ClassDef):
                homes[node.name].append((path, node.lineno))
    for name, found in homes.items():
        for path, line in found if len(found) > 1 else ():
            others = ", ".join(str(other.relative_to(ROOT)) for other, _ in found if other != path)
            yield path, line, f"class {name} is also in {others}"


def constants_without_meaning():
    for path in FILES:
        for name, line in numbers(path):
            if SAYS_NOTHING.fullmatch(name.strip("_")):
                yield path, line, f"{name} says neither of what nor what for"


def constants_without_comment():
    """Module constants of one number beside, above or below which no word says of what it is and why."""
    for path in FILES:
        lines, said = path.read_text().splitlines(), 0
        body = [*tree(path).body, None]
        for node, after in itertools.pairwise(body):
            if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
                continue
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            number = isinstance(node.value, ast.Constant) and isinstance(node.value.value, int | float)
            number |= isinstance(node.value, ast.UnaryOp | ast.BinOp) and not isinstance(node.value.op, ast.BitOr)
            written = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
            around = lines[max(node.lineno - 2, 0) : node.end_lineno]
            # what is said of one holds for those that follow at once
            if written or node.lineno == said + 1 or "#" in "".join(around):
                said = node.end_lineno
            elif number and isinstance(target, ast.Name) and target.id.isupper():
                yield path, node.lineno, f"{target.id}: no comment says of what it is, in which unit and why"


RULES = {
    "files": long_files,
    "signatures": many_parameters,
    "nouns": docstrings_without_noun,
    "parameters": silent_parameters,
    "classes": classes_of_one_name,
    "constants": constants_without_meaning,
    "comments": constants_without_comment,
}


@functools.cache
def broken(rule):
    """What breaks a rule, by room: ``file:line: what``."""
    found = collections.defaultdict(list)
    for path, line, words in RULES[rule]():
        found[room(module_name(path))].append(f"src/signorini/{path.relative_to(ROOT)}:{line}: {words}")
    return found


@pytest.mark.parametrize("rule", RULES)
def test_rooms_keep_the_rules(rule):
    wrong = [line for lines in broken(rule).values() for line in lines]
    assert not wrong, "\n" + "\n".join(wrong)


def test_no_module_has_the_name_of_what_is_asked_of_the_package():
    """Imported it would take its place: ``sg.moment`` of a file moment.py."""
    assert not {path.stem for path in ROOT.glob("*.py")} & set(signorini.__all__)


def test_files_are_licensed_and_functions_short():
    wrong = []
    for path in FILES:
        if not path.read_text().startswith("# SPDX-License-Identifier: BSD-3-Clause\n"):
            wrong.append(f"{path}: expected the licence in the first line")
        for node, _ in statements(path):
            if isinstance(node, FUNCTION) and (lines := body_lines(node)) > LARGEST_FUNCTION:
                wrong.append(
                    f"{path}:{node.lineno}: {node.name} has {lines} lines; expected at most {LARGEST_FUNCTION}"
                )
    assert not wrong, "\n" + "\n".join(wrong)


if __name__ == "__main__":
    for rule in RULES:
        for name, lines in broken(rule).items():
            if name in sys.argv[1:] or len(sys.argv) == 1:
                print(*lines, sep="\n")
