# SPDX-License-Identifier: BSD-3-Clause
"""What a terminal shows while something is solved."""

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from signorini.cli.main import main
from signorini.linalg.multifrontal import compiled
from signorini.linalg.registry import factorise

DECK = Path(__file__).parents[2] / "examples" / "zhu_cylinder_frictionless.toml"


@pytest.mark.parametrize("known", [True, False])
def test_the_first_solve_says_once_that_it_compiles(known, monkeypatch, capsys, tmp_path):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.setattr("signorini.cli.run_deck.compiled", lambda: known)
    assert main(["run", str(DECK), "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().err.count("compiling takes half a minute, once") == (not known)


def test_a_factorisation_leaves_compiled_loops_behind():
    factorise(sp.csr_array(np.eye(3)), np.empty(0, int), nodes=np.arange(3), points=np.eye(3), backend="multifrontal")
    assert compiled()
