# SPDX-License-Identifier: BSD-3-Clause
"""``signorini plot``: pictures from a result folder."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.errors import InputError
from signorini.output.archive import read_archive
from signorini.output.atomic_write import atomic_write
from signorini.output.picture import write_pixels
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.field import draw_mesh, draw_stress
from signorini.plot.history import draw_history
from signorini.plot.patch import draw_patches
from signorini.plot.result_folder import ResultFolder
from signorini.plot.solid import draw_solid_mesh, draw_solid_stress
from signorini.plot.style import literal
from signorini.plot.view import render_view

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
        write_pixels(render_view(folder), file)
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
    return draw_patches(folder.patches, folder.title) if folder.solid else draw_contacts(folder.steps[-1], folder.title)
