# SPDX-License-Identifier: BSD-3-Clause
"""A result folder: all files of a run appear in it together, and none of an earlier run stays."""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from signorini.clock import Clock
from signorini.errors import InputError
from signorini.model.prints import Prints
from signorini.output.archive import write_archive
from signorini.output.checkpoint import write_checkpoint
from signorini.output.dat import write_dat
from signorini.output.frd import write_frd
from signorini.output.instants import write_history
from signorini.output.replacing import replacing
from signorini.output.rows import write_rows
from signorini.output.series import FIELDS, frames, write_series
from signorini.output.summary import summary
from signorini.output.surface import write_surfaces
from signorini.output.vtu import write_step
from signorini.solution.history import History

_OURS = re.compile(
    r"(summary\.json|(contact|history)\.csv|state\.npz|solution(_\d{4,})?\.vtu|contact\.(vtu|pvd)|"
    r"solution\.(pvd|h5|frd|dat)|"
    r"(contact|stress|mesh|view|history)\.png)"
)
_FIELD = re.compile(r"(solution|contact)_\d{4,}_\d{4,}\.vtu")

ARCHIVE = "solution.h5"
"""The whole history, in a result folder."""

SURFACES = "contact.vtu"
"""The contact surfaces of a model in space."""


def open_folder(path: Path) -> Path:
    """Make the folder if need be, and find out before a long solve whether it can be written to.

    Raises
    ------
    InputError
        If it cannot.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        raise InputError(f"cannot write to the folder '{path}': {error.strerror}") from error
    return path


def publish(
    history: History, folder: Path, clock: Clock, *, started: float, prints: Prints | None = None
) -> list[Path]:
    """Write a history, finished or not, in place of whatever an earlier run left in the folder.

    Everything is written aside first; then earlier results go, and the new files come under their names, the summary
    last: a summary in the folder means that the files beside it belong to it and are complete.

    Parameters
    ----------
    history : with no step at all, a summary is written, which says why, and an archive with the motion of bodies that
        run away
    folder : that :func:`open_folder` opened
    clock : its seconds go into the summary, and those of the output are added to it
    prints : what a deck of keywords asks for: what its users expect is written too, ``.frd`` and, if there are tables,
        ``.dat``
    started : ``time.perf_counter()`` at the beginning of the run

    Returns
    -------
    The files, in the order of their appearance
    """
    with tempfile.TemporaryDirectory(dir=folder, prefix=".writing-") as name:
        aside = Path(name)
        with clock.phase("output"):
            names = _write_fields(history, aside, prints)
        seconds = clock.seconds | {"total": time.perf_counter() - started}
        write_summary(history, aside / "summary.json", seconds)
        _clear(folder)
        for file in [*names, "summary.json"]:
            (folder / file).parent.mkdir(exist_ok=True)
            os.replace(aside / file, folder / file)
    return [folder / file for file in [*names, "summary.json"]]


def _clear(folder: Path) -> None:
    """Remove what an earlier run has left, and nothing else."""
    for old in folder.iterdir():
        if _OURS.fullmatch(old.name):
            old.unlink()
    fields = folder / FIELDS
    if fields.is_dir():
        for old in fields.iterdir():
            if _FIELD.fullmatch(old.name):
                old.unlink()
        if not any(fields.iterdir()):
            fields.rmdir()


def write_drawn(history: History, folder: Path) -> None:
    """Write into a folder what pictures are drawn from: the last state, contacts and the summary."""
    write_rows(history, folder / "contact.csv")
    write_step(history.model, history.last, folder / "solution.vtu")
    if history.model.dimension == 3 and history.model.contacts:
        write_surfaces(history.model, history.last.contacts, folder / SURFACES)
    write_summary(history, folder / "summary.json", history.timings)


def write_summary(history: History, path: Path, seconds: Mapping[str, float]) -> None:
    """Write ``summary.json``; see :func:`signorini.output.summary.summary`."""
    words = json.dumps(summary(history, seconds), indent=2, allow_nan=False, ensure_ascii=False)
    with replacing(path) as aside:
        aside.write_text(words + "\n", encoding="utf-8")


def _write_fields(history: History, folder: Path, prints: Prints | None) -> list[str]:
    """Rows and fields of the steps; their names."""
    if not history.steps:
        if history.escape is None:
            return []
        write_archive(history, folder / ARCHIVE)
        return [ARCHIVE]
    write_rows(history, folder / "contact.csv")
    names = ["contact.csv"]
    model, states = history.model, frames(history)
    if len(states) > 1:
        names += write_series(model, states, folder)
        shutil.copyfile(folder / f"solution_{len(history.steps):04d}.vtu", folder / "solution.vtu")
    else:
        write_step(model, history.last, folder / "solution.vtu")
    if model.dimension == 3 and model.contacts:
        write_surfaces(model, history.last.contacts, folder / SURFACES)
        names.append(SURFACES)
    write_history(history, folder / "history.csv")
    names += ["solution.vtu", "history.csv"]
    if history.end is not None:
        write_checkpoint(history.end, folder / "state.npz")
        names.append("state.npz")
    write_archive(history, folder / ARCHIVE)
    names.append(ARCHIVE)
    if prints is not None:
        write_frd(history, folder / "solution.frd", prints.times)
        names.append("solution.frd")
    if prints is not None and prints.tables:
        write_dat(history, prints, folder / "solution.dat")
        names.append("solution.dat")
    return names
