# SPDX-License-Identifier: BSD-3-Clause
"""Every module has a place where one finds its test: the table of ``tests/README.md`` (see `tests.map`)."""

from tests import map as places


def test_every_module_is_run_by_some_test():
    table = places.table()
    lacking = sorted(module for module in places.modules() if not table.get(module))
    assert lacking == [], "python -m tests.map --write FILES adds the modules that these test files call"
    gone = sorted({file for files in table.values() for file in files if not (places.HERE / file).is_file()})
    assert gone == [], "python -m tests.map --write measures anew"
