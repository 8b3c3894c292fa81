# SPDX-License-Identifier: BSD-3-Clause
"""The verification suite shared by processes."""

import subprocess
import sys

import pytest

from signorini.verify import bounded, one_node
from signorini.verify.rows import rows_of, shared_rows

CASES = (bounded.shear_limits, one_node.one_node)


@pytest.mark.slow
def test_processes_give_the_rows_in_the_order_of_one():
    told = []
    shared = list(shared_rows(f"{__name__}:CASES", lambda *words: told.append(words), processes=2))
    assert told == [("shear limits", 0, 2), ("one node", 1, 2)]
    assert shared == list(shared_rows(f"{__name__}:CASES", lambda *_: None, processes=1))
    assert len({row["case"] for row in shared}) > 1


def test_the_process_that_prints_imports_nothing_that_is_verified():
    asked = "import sys, signorini.verify.rows; print([m for m in sys.modules if m.startswith(('scipy', 'numba'))])"
    assert subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_what_a_case_raises_ends_the_suite():
    with pytest.raises(TypeError):
        list(rows_of((len,), lambda *_: None))  # no case: it wants an argument


def test_rows_of_a_case_come_one_by_one():
    def case():
        yield next(one_node.one_node())
        raise AssertionError("asked for before it is wanted")

    assert next(rows_of((case,), lambda *_: None))["passed"]
