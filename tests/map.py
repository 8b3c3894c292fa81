# SPDX-License-Identifier: BSD-3-Clause
"""Which tests run the functions of which module: the table of ``tests/README.md``.

``pytest $(python -m tests.map fem/links.py)`` runs the tests of a module. ``python -m tests.map --write`` runs
every fast test and writes the table again (minutes); with test files behind it only those, for modules that the
table lacks.
"""

from __future__ import annotations

import ast
import collections
import re
import sys
from pathlib import Path

import pytest

import signorini

HERE, SOURCE = Path(__file__).parent, Path(signorini.__file__).parent
PAGE = HERE / "README.md"
HEAD = "| module | run by |\n|---|---|\n"
FILES_PER_MODULE = 3
PARAMETERS_PER_TEST = 3  # further ones call the same functions


def modules():
    """{path below ``src/signorini``: names of its functions}, of modules that define any; `verify` is a test itself."""
    found = {}
    for path in sorted(SOURCE.rglob("*.py")):
        functions = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)]
        if functions and path.parent.name != "verify":
            found[str(path.relative_to(SOURCE))] = {node.name for node in functions}
    return found


class Calls:
    """A plugin of pytest that records which of our functions the tests of a file call.

    Attributes
    ----------
    of : {test file below ``tests``: {(module, function)}}
    """

    def __init__(self):
        self.of = collections.defaultdict(set)

    def pytest_collection_modifyitems(self, items):
        count = collections.Counter()
        for item in list(items):
            test = item.nodeid.split("[")[0]
            count[test] += 1
            many = count[test] > PARAMETERS_PER_TEST and not item.get_closest_marker("suite")
            if many or item.get_closest_marker("slow"):
                items.remove(item)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item):
        codes = set()
        sys.setprofile(lambda frame, event, _: codes.add(frame.f_code) if event == "call" else None)
        try:
            return (yield)
        finally:
            sys.setprofile(None)
            if item.path.is_relative_to(HERE):
                self.of[str(item.path.relative_to(HERE))] |= {
                    (str(Path(code.co_filename).relative_to(SOURCE)), code.co_name)
                    for code in codes
                    if code.co_filename.startswith(f"{SOURCE}/")
                }


def homes(calls):
    """{module: its test files}: each adds most of the functions that those before do not call, the closest first.

    That is the file named after the module, then those of its room, then others; of equals that which calls the fewest
    modules. Calls of compiled functions cannot be seen: their modules are where those are that import them.
    """
    breadth = {file: len({module for module, _ in called}) for file, called in calls.items()}
    found = {}
    for module in modules():
        left, files = {call for called in calls.values() for call in called if call[0] == module}, []

        def rank(file, *, module=Path(module), left=left):
            adds = len(calls[file] & left)
            same = Path(file).stem == f"test_{module.stem}", Path(file).parts[0] == module.parts[0]
            return *(adds and near for near in same), adds, -breadth[file]

        while left and len(files) < FILES_PER_MODULE:
            files.append(max(calls, key=rank))
            left -= calls[files[-1]]
        found[module] = files
    for module in [module for module, files in found.items() if not files]:
        name = module.removesuffix(".py").replace("/", ".")
        users = [user for user in found if f"signorini.{name} import" in (SOURCE / user).read_text()]
        found[module] = list(dict.fromkeys(file for user in users for file in found[user]))[:FILES_PER_MODULE]
    return found


def table():
    """{module: its test files} of the page."""
    rows = re.findall(r"^\| `(.+\.py)` \| (.*) \|$", PAGE.read_text(), re.MULTILINE)
    return {module: re.findall(r"`(.+?)`", files) for module, files in rows}


def write(found):
    """Write the page's table again, of modules that are there."""
    rows = [f"| `{module}` | {', '.join(f'`{file}`' for file in found.get(module, []))} |\n" for module in modules()]
    PAGE.write_text(PAGE.read_text().split(HEAD)[0] + HEAD + "".join(rows))


def main(arguments):
    """Print the tests of modules, or measure and write."""
    if not arguments:
        sys.exit(__doc__)
    if arguments[0] == "--write":
        calls = Calls()
        code = pytest.main(["-p", "no:cacheprovider", *(arguments[1:] or [str(HERE)])], plugins=[calls])
        new = homes(calls.of)
        write({**new, **{module: files for module, files in table().items() if files}} if arguments[1:] else new)
        sys.exit(code)
    known = table()
    wanted = [
        str(Path(name).resolve()).removeprefix(f"{SOURCE}/") if Path(name).exists() else name for name in arguments
    ]
    print(*dict.fromkeys(f"tests/{file}" for name in wanted for file in known.get(name) or (Path(name).parts[0],)))


if __name__ == "__main__":
    main(sys.argv[1:])
