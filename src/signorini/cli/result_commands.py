# SPDX-License-Identifier: BSD-3-Clause
"""``signorini plot``, ``report`` and ``diff``: pictures and a page of a result folder, two results side by side."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write
from signorini.output.compare import compare
from signorini.output.folder import read_folder, read_results
from signorini.output.table import align
from signorini.plot.accuracy import draw_accuracy
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.fatigue import draw_fatigue
from signorini.plot.field import draw_mesh, draw_peeq, draw_stress
from signorini.plot.history import draw_history
from signorini.plot.picture_data import PictureData
from signorini.plot.solid import draw_solid_mesh, draw_solid_peeq, draw_solid_stress
from signorini.plot.style import literal
from signorini.plot.units import units_of
from signorini.plot.view import write_view
from signorini.plot.wear import draw_wear
from signorini.report.page import write_report
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FORMATS = (".png", ".pdf", ".svg")


def plot(options: argparse.Namespace) -> int:
    """Draw, write the picture and say where it is."""
    folder = Path(options.folder)
    file = Path(options.file) if options.file else folder / f"{options.what}.png"
    formats = _FORMATS[:1] if options.what == "view" else _FORMATS
    if file.suffix.lower() not in formats:
        raise InputError(f"is '{file}'; expected a name that ends in {', '.join(formats)}", where=("-o",))
    if options.file and not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    history = read_folder(folder)
    if options.what != "escape" and not history.steps:
        why = "" if history.solved else f": the run ended with '{history.status}': {history.message}"
        raise InputError(f"the results in '{folder}' hold no step{why}")
    if options.what in ("contact", "history") and not history.model.contacts:
        raise InputError(f"the results in '{folder}' have no contact to draw")
    if options.what == "view":
        write_view(PictureData(history), file)
    else:
        with atomic_write(file) as aside:
            literal(_draw(history, options.what), units_of(history.model.units)).savefig(aside, dpi=150)
    print(file)
    return 0


def _draw(history: History, what: str) -> Figure:
    if what == "escape":
        return plot_escape(history)
    data = PictureData(history)
    if what == "stress":
        return draw_solid_stress(data) if data.solid else draw_stress(data)
    if what == "peeq":
        return draw_solid_peeq(data) if data.solid else draw_peeq(data)
    if what == "mesh":
        return draw_solid_mesh(data) if data.solid else draw_mesh(data)
    if what == "wear":
        return draw_wear(data)
    if what == "accuracy":
        return draw_accuracy(data)
    if what == "fatigue":
        return draw_fatigue(data)
    return draw_history(data) if what == "history" else draw_contacts(data)


def report(options: argparse.Namespace) -> int:
    """Write the page and say where it is."""
    folder = Path(options.folder)
    file = Path(options.file) if options.file else folder / "report.html"
    if not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    write_report(read_folder(folder), file)
    print(file)
    return 0


def diff(options: argparse.Namespace) -> int:
    """Print what differs; 0 if nothing does by more than the tolerance, otherwise 1."""
    if not options.tolerance >= 0.0:
        raise InputError(f"is {options.tolerance:g}; expected a number >= 0", where=("--tolerance",))
    first, second = (read_results(Path(name)) for name in (options.first, options.second))
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
