# SPDX-License-Identifier: BSD-3-Clause
"""CalculiX, where it is installed: what it prints for a deck."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

_TABLE = re.compile(r"displacements \(vx,vy,vz\) for set \S+ and time +\S+\s*\n\s*\n((?:[ \d].*\n?)+)")

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")


def ccx_displacements(deck: Path) -> np.ndarray:
    """Displacements (tables, nodes, 3) that CalculiX prints, every table with the same nodes in ascending order."""
    subprocess.run(["ccx", "-i", deck.stem], cwd=deck.parent, capture_output=True, check=True, timeout=60)
    tables = _TABLE.findall(deck.with_suffix(".dat").read_text())
    found = [np.array([line.split() for line in table.splitlines()], float) for table in tables]
    return np.array([table[np.argsort(table[:, 0]), 1:] for table in found])
