# SPDX-License-Identifier: BSD-3-Clause
"""What a terminal shows while something is solved."""

import numpy as np
import pytest
import scipy.sparse as sp

from signorini.cli import progress as module
from signorini.linalg.multifrontal import compiled
from signorini.linalg.registry import factorise


@pytest.mark.parametrize("known", [True, False])
def test_the_first_solve_says_that_it_compiles(known, monkeypatch, capsys):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.setattr("signorini.linalg.multifrontal.compiled", lambda: known)
    with module.progress(quiet=False) as clock, clock.phase("read"):
        pass
    assert ("compiling takes half a minute, once" in capsys.readouterr().err) is not known


def test_a_factorisation_leaves_compiled_loops_behind():
    factorise(sp.csr_array(np.eye(3)), np.empty(0, int), nodes=np.arange(3), points=np.eye(3), backend="multifrontal")
    assert compiled()
