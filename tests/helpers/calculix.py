# SPDX-License-Identifier: BSD-3-Clause
"""CalculiX, where it is installed: what it prints for a deck."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

_PRINTED = r" for set \S+ and time +\S+\s*\n\s*\n((?:[ \d].*\n?)+)"
_DISPLACEMENTS = re.compile(r"displacements \(vx,vy,vz\)" + _PRINTED)
_STRESSES = re.compile(r"stresses \(elem, integ\.pnt\.,[\w,]*\)" + _PRINTED)
_MODE = re.compile(r" +\d+( +\S+){4,5}$")  # of sectors with the nodal diameters first

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")


def ccx_displacements(deck: Path) -> np.ndarray:
    """Displacements (tables, nodes, 3) that CalculiX prints, every table with the same nodes in ascending order."""
    return np.array([table[np.argsort(table[:, 0]), 1:] for table in _tables(deck, _DISPLACEMENTS)])


def ccx_stresses(deck: Path) -> np.ndarray:
    """Stresses (tables, points, 6) that CalculiX prints: xx, yy, zz, xy, xz, yz."""
    return np.array([table[:, 2:] for table in _tables(deck, _STRESSES)])


def ccx_frequencies(deck: Path) -> np.ndarray:
    """Frequencies (modes,) that CalculiX prints, cycles per time."""
    subprocess.run(["ccx", "-i", deck.stem], cwd=deck.parent, capture_output=True, check=True, timeout=60)
    printed = deck.with_suffix(".dat").read_text().partition("P A R T I C I P A T I O N")[0]
    return np.array([line.split()[-2] for line in printed.splitlines() if _MODE.match(line)], float)


def _tables(deck: Path, kind: re.Pattern[str]) -> list[np.ndarray]:
    subprocess.run(["ccx", "-i", deck.stem], cwd=deck.parent, capture_output=True, check=True, timeout=60)
    tables = kind.findall(deck.with_suffix(".dat").read_text())
    return [np.array([line.split() for line in table.splitlines()], float) for table in tables]
