# SPDX-License-Identifier: BSD-3-Clause
"""``signorini plot``, ``report``, ``table`` and ``diff``: pictures, a page and columns of results, two compared."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from signorini.api import dressed
from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write
from signorini.output.compare import compare
from signorini.output.folder import read_folder, read_results
from signorini.output.sensitivities_file import of_this_run, read_sensitivities
from signorini.output.table import align
from signorini.plot.look import Look
from signorini.plot.pictures import VIEW, check_picture
from signorini.report.page import write_report

_FORMATS = (".png", ".pdf", ".svg")


def plot(options: argparse.Namespace) -> int:
    """Draw, write the picture and say where it is."""
    folder, what = Path(options.folder), options.what
    file = Path(options.file) if options.file else folder / f"{what}.png"
    formats = _FORMATS[:1] if what == VIEW else _FORMATS
    if file.suffix.lower() not in formats:
        raise InputError(f"is '{file}'; expected a name that ends in {', '.join(formats)}", where=("-o",))
    if options.file and not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    solution = dressed(read_folder(folder), raise_on_failure=False)
    moment = {"step": _step(options.step), "load": options.load}
    choices = {name: getattr(options, name) for name in ("component", "range", "zoom", "scale")}
    try:
        check_picture(what, solution, Look(**choices), moment, f"the results in '{folder}'")
        if what == VIEW:
            solution.view(file, **moment)
        else:
            with atomic_write(file) as aside:
                solution.plot(what, **moment, **choices).savefig(aside, dpi=150)
    except InputError as error:
        if error.where and error.where[0] in {*moment, *choices}:
            raise InputError(error.message, where=(f"--{error.where[0]}",)) from error
        raise
    print(file)
    return 0


def _step(given: str | None) -> int | str | None:
    """A number where it is one, otherwise a name."""
    return int(given) if given is not None and given.isdecimal() else given


def table(options: argparse.Namespace) -> int:
    """Write the columns and say where they are."""
    folder, moment = Path(options.folder), {"step": _step(options.step), "load": options.load}
    file = Path(options.file) if options.file else folder / f"{options.what}_table.csv"
    if not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    solution, asked = dressed(read_folder(folder), raise_on_failure=False), moment != {"step": None, "load": None}
    if options.what == "history":
        if asked:
            raise InputError("has all moments; expected --what contact with --step or --load", where=("--what",))
        solution.history.write(file)
    else:
        (solution.at(**moment) if asked else solution).contact_table().write(file)
    print(file)
    return 0


def report(options: argparse.Namespace) -> int:
    """Write the page and say where it is."""
    folder = Path(options.folder)
    file = Path(options.file) if options.file else folder / "report.html"
    if options.file and not file.parent.is_dir():
        raise InputError(f"there is no folder '{file.parent}'", where=("-o",))
    history, sensitivities = read_folder(folder), read_sensitivities(folder)
    if sensitivities is not None and not of_this_run(sensitivities, history):
        print(f"the sensitivities in '{folder}' are of another run; the report is without them", file=sys.stderr)
        sensitivities = None
    write_report(history, file, sensitivities=sensitivities)
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
