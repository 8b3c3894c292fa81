# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops that an earlier version of the package has left on disk do no harm."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

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
