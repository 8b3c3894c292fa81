# SPDX-License-Identifier: BSD-3-Clause
"""``signorini diff``: two results side by side."""

from __future__ import annotations

import argparse
from pathlib import Path

from signorini.errors import InputError
from signorini.output.align import align
from signorini.output.archive import read_archive
from signorini.output.compare import compare
from signorini.output.folder import ARCHIVE
from signorini.solution.history import History


def diff(options: argparse.Namespace) -> int:
    """Print what differs; 0 if nothing does by more than the tolerance, otherwise 1."""
    if not options.tolerance >= 0.0:
        raise InputError(f"is {options.tolerance:g}; expected a number >= 0", where=("--tolerance",))
    first, second = _archive(options.first), _archive(options.second)
    differences, words = compare(first, second)
    apart = [d for d in differences if not d.relative <= options.tolerance]
    for line in words:
        print(line)
    if apart:
        rows = [("step", "quantity", "largest difference", "of", "relative", "node")]
        for d in sorted(apart, key=lambda d: -d.relative):
            node = "" if d.where is None else str(d.where)
            rows.append((d.step, d.quantity, f"{d.largest:.6g}", f"{d.size:.6g}", f"{d.relative:.2e}", node))
        print("\n".join(align(rows, right=(2, 3, 4, 5), indent="")))
    else:
        print(f"{len(differences)} quantities, none apart by more than {options.tolerance:g} of its size")
    return 1 if apart or words else 0


def _archive(name: str) -> History:
    path = Path(name)
    return read_archive(path / ARCHIVE if path.is_dir() else path)
