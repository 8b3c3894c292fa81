# SPDX-License-Identifier: BSD-3-Clause
"""From a deck that was read to its natural modes, and the loops of one of them: tables, files and pictures."""

from __future__ import annotations

import argparse
import textwrap
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

from signorini.api import solve
from signorini.blas_threads import one_thread
from signorini.clock import Clock
from signorini.deck import Deck
from signorini.errors import InputError
from signorini.model.modes import STUCK, ModesRequest
from signorini.output.atomic_write import atomic_write
from signorini.output.folder import own_folder
from signorini.output.modes_files import (
    DAMPING,
    LOOPS,
    MODES,
    SHAPES,
    write_damping,
    write_loops,
    write_modes,
    write_shapes,
)
from signorini.output.modes_table import damping_table, modes_table
from signorini.plot.modes import draw_damping, draw_modes
from signorini.plot.style import literal
from signorini.solution.damping import JointDamping
from signorini.solution.history import History
from signorini.solution.modes import NaturalModes
from signorini.vibration.damping import joint_damping
from signorini.vibration.modes import modes_by_joint

_MODES_PICTURE, _DAMPING_PICTURE = "modes.png", "damping.png"
_PICTURE_DOTS = 150  # an inch


@one_thread()
def run_modes(deck: Deck, options: argparse.Namespace, clock: Clock, started: float) -> int:
    """Solve the preload, find the modes, follow the loops; write and print.

    Parameters
    ----------
    deck : as it was read
    options : ``folder``, ``number``, ``joints``, ``mode``, ``amplitudes`` and ``quiet`` of the command line
    clock : that tells progress
    started : ``time.perf_counter()`` at the beginning of the command

    Returns
    -------
    The exit code, 0; what could not be solved is raised
    """
    request = _request(deck, options)
    path = Path(options.folder) if options.folder else Path("out", deck.path.stem)
    with own_folder(path, deck.path.name) as folder:
        try:
            history = solve(deck.model, settings=deck.settings, clock=clock) if request.preload else None
            model, end = (deck.model, None) if history is None else (history.model, history.end)
            joints = request.joints if any(not contact.tied for contact in model.contacts) else (STUCK,)
            modes = modes_by_joint(model, request.number, joints, end, diameters=request.nodal_diameters)
            damping = None
            if history is not None and request.amplitudes:
                damping = joint_damping(
                    history, request.amplitudes, mode=request.mode, cycles=request.cycles, settings=deck.settings
                )
        except InputError as error:
            raise deck.locate(error) from error
        files = _write(deck, modes, damping, folder)
    if not options.quiet:
        _tell(deck, history, modes, damping, request.nodal_diameters)
        print(f"{', '.join(files)} in {folder} ({time.perf_counter() - started:.2f} s)")
    return 0


def _request(deck: Deck, options: argparse.Namespace) -> ModesRequest:
    """What the deck asks for, with what the command line says instead."""
    request = deck.modes or ModesRequest()
    keys = ("number", "joints", "nodal_diameters", "mode", "amplitudes")
    said = {key: getattr(options, key) for key in keys}
    try:
        return replace(request, **{key: value for key, value in said.items() if value is not None})
    except InputError as error:
        raise InputError(error.message, where=(f"--{error.where[0]}",)) from error


def _write(deck: Deck, modes: Mapping[str, NaturalModes], damping: JointDamping | None, folder: Path) -> list[str]:
    """Write all files; the names of those written, of those of an earlier run none stays."""
    for name in (DAMPING, LOOPS, _DAMPING_PICTURE):
        (folder / name).unlink(missing_ok=True)
    model = deck.model
    write_modes(modes, folder / MODES)
    write_shapes(model, modes, folder / SHAPES)
    _save(draw_modes(model, modes), folder / _MODES_PICTURE)
    if damping is None:
        return [MODES, SHAPES, _MODES_PICTURE]
    write_damping(damping, folder / DAMPING)
    write_loops(damping, folder / LOOPS)
    _save(draw_damping(damping, model.title), folder / _DAMPING_PICTURE)
    return [MODES, SHAPES, _MODES_PICTURE, DAMPING, LOOPS, _DAMPING_PICTURE]


def _save(figure: Figure, path: Path) -> None:
    with atomic_write(path) as aside:
        literal(figure).savefig(aside, dpi=_PICTURE_DOTS)


def _tell(
    deck: Deck,
    history: History | None,
    modes: Mapping[str, NaturalModes],
    damping: JointDamping | None,
    diameters: int,
) -> None:
    """Print what was found."""
    about = "of the bodies as they are drawn" if history is None else f"about the end of step '{history.last.name}'"
    if diameters:
        about = f"with {diameters} nodal diameter{'s' if diameters > 1 else ''} {about}"
    print(deck.model.title or "untitled")
    print(modes_table(modes, about), end="\n\n")
    if damping is not None:
        print(damping_table(damping), end="\n\n")
    for note in deck.notes:
        print(textwrap.fill(f"deck: {note}", 112), end="\n\n")
