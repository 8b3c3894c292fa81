# SPDX-License-Identifier: BSD-3-Clause
"""``signorini plot`` and ``diff``: pictures from a result folder, and two results side by side."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.errors import InputError
from signorini.output.archive import read_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.compare import compare
from signorini.output.folder import ARCHIVE
from signorini.output.table import align
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.field import draw_mesh, draw_stress
from signorini.plot.history import draw_history
from signorini.plot.result_folder import ResultFolder
from signorini.plot.solid import draw_solid_mesh, draw_solid_stress
from signorini.plot.style import literal
from signorini.plot.view import write_view
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FORMATS = (".png", ".pdf", ".svg")


def plot(options: argparse.Namespace) -> int:
    """Draw, write the picture and say where it is."""
    folder = ResultFolder(path=Path(options.folder))
    file = Path(options.file) if options.file else folder.path / f"{options.what}.png"
    formats = _FORMATS[:1] if options.what == "view" else _FORMATS
    if file.suffix.lower() not in formats:
        raise InputError(f"is '{file}'; expected a name that ends in {', '.join(formats)}", where=("-o",))
    if options.file and not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    if options.what == "view":
        write_view(folder, file)
    else:
        figure = literal(_draw(folder, options.what))
        with atomic_write(file) as aside:
            figure.savefig(aside, dpi=150)
    print(file)
    return 0


def _draw(folder: ResultFolder, what: str) -> Figure:
    if what == "escape":
        return plot_escape(read_archive(folder.archive))
    if what == "stress":
        return draw_solid_stress(folder) if folder.solid else draw_stress(folder)
    if what == "mesh":
        return draw_solid_mesh(folder) if folder.solid else draw_mesh(folder)
    if not folder.rows:
        raise InputError(f"the results in '{folder.path}' have no contact to draw")
    if what == "history":
        return draw_history(folder)
    return draw_contacts(folder)


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
