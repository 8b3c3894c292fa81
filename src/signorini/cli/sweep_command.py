# SPDX-License-Identifier: BSD-3-Clause
"""``signorini sweep``: a deck with many values of what it says, a row of a table for each combination."""

from __future__ import annotations

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from signorini.checks import whole
from signorini.cli.exit_codes import DONE, FAILED, INTERRUPTED, NO_SOLUTION, WRONG_INPUT
from signorini.cli.progress import progress_bar
from signorini.distributed.ranks import ON_RANKS
from signorini.engine.condensation import refuse_unknown
from signorini.engine.first_run import helped
from signorini.errors import InputError, SignoriniError
from signorini.output.atomic_write import atomic_write
from signorini.output.table import align
from signorini.study.lanes import RankLanes, serve
from signorini.study.mpi import world
from signorini.study.problem import DeckFile, Study
from signorini.study.record import TABLE
from signorini.study.row import BROKEN, StudyRow
from signorini.study.sweep import RESULTS, Sweep, Sweeping, processes_beside
from signorini.study.values import Value, asked_values

PICTURE = "sweep.png"
"""File of the picture in the folder of a study."""

_SHOWN = 24  # rows on a terminal, the first ones; all are in the table
_MOST_OUTPUTS = 5  # columns of answers on a terminal
_DOTS = 150  # an inch


def sweep(options: argparse.Namespace) -> int:
    """Solve, write, print; 0 if every row is solved and certified, 3 if one is not."""
    comm = None if options.backend in ON_RANKS else world()
    if comm is None or comm.rank == 0:
        return _first(options, comm)
    study = comm.bcast(None)
    if study is None:
        return WRONG_INPUT
    serve(comm, study)
    return int(comm.bcast(None))


def _first(options: argparse.Namespace, comm: Any) -> int:
    """The command on the only rank, or on the first one."""
    try:
        study, folder = _study(options)
        processes = _processes(options)
    except BaseException:
        if comm is not None:
            comm.bcast(None)
        raise
    sweeping = Sweeping(study, folder)
    lanes = None
    if comm is not None:
        comm.bcast(study)
        lanes = RankLanes(comm, study)
    code = FAILED
    try:
        # one rank or process compiles for all
        with helped(study.base.model) if comm is None else nullcontext():
            code = _run(options, sweeping, folder, processes, lanes)
    finally:
        if comm is not None:
            comm.bcast(code)
    return code


def _run(
    options: argparse.Namespace, sweeping: Sweeping, folder: Path, processes: int | None, lanes: RankLanes | None
) -> int:
    """Solve what is left, and say what was found."""
    quiet = options.quiet or options.json
    try:
        with progress_bar(quiet=quiet) as tell:
            found = sweeping.finished(processes, tell, lanes)
    except (KeyboardInterrupt, SignoriniError) as stop:
        if isinstance(stop, InputError):
            raise
        words = "interrupted" if isinstance(stop, KeyboardInterrupt) else str(stop)
        done = len(sweeping.record.rows)
        print(
            f"signorini: {words}; {done} of {sweeping.count} rows are in {folder}, the same command goes on from them",
            file=sys.stderr,
        )
        return INTERRUPTED if isinstance(stop, KeyboardInterrupt) else FAILED
    files = [TABLE, *_picture(found, folder)]
    if options.json:
        print(sweeping.record.text, end="")
    elif not options.quiet:
        print(found.title or "untitled", end="\n\n")
        print("\n".join(_table(found)), end="\n\n")
        print(f"{', '.join(files)} in {folder}")
    return _told(found, folder)


def _study(options: argparse.Namespace) -> tuple[Study, Path]:
    """What is asked for, and the folder of it."""
    refuse_unknown(options.backend, ("--backend",))
    values: dict[str, tuple[Value, ...]] = {}
    for words in options.set:
        key, own = asked_values(words)
        if key in values:
            raise InputError(f"'{key}' is set twice; expected each key once", where=("--set",))
        values[key] = own
    source = DeckFile(
        path=Path(options.deck),
        small_strain=options.small_strain,
        deck_increments=options.increments == "deck",
        allow=tuple(options.allow),
        include=tuple(options.include),
        fatigue=None if options.fatigue is None else Path(options.fatigue),
    )
    folder = Path(options.folder) if options.folder else Path("out", f"{source.path.stem}_sweep")
    study = Study.of(source, values, options.backend, folder / RESULTS if options.results else None)
    modes = study.base.modes
    if modes is not None and not modes.preload:
        raise InputError(f"'{source.path}' asks for natural modes of bodies as they are drawn; expected loads to solve")
    return study, folder


def _processes(options: argparse.Namespace) -> int | None:
    """How many share the rows; None: that is found on the way."""
    if options.processes is not None:
        count = whole(options.processes, ("--processes",))
        if options.backend in ON_RANKS and count > 1:
            raise InputError(
                f"is {count}; back end '{options.backend}' takes all ranks for one row", where=("--processes",)
            )
        return count
    return 1 if options.backend in ON_RANKS else processes_beside(options.threads)


def _picture(found: Sweep, folder: Path) -> list[str]:
    """The name of the picture, which is drawn where there is anything to draw; none of an earlier sweep stays."""
    file = folder / PICTURE
    file.unlink(missing_ok=True)
    try:
        figure = found.plot()
    except InputError:
        return []
    with atomic_write(file) as aside:
        figure.savefig(aside, dpi=_DOTS)
    return [PICTURE]


def _table(found: Sweep) -> list[str]:
    """Values, endings and a few answers of the first rows."""
    rows = found.rows
    outputs = dict.fromkeys(name for row in rows for name in row.outputs)
    chosen = [name for name in outputs if name.endswith((".max_pressure", ".max_slip"))][: _MOST_OUTPUTS - 1]
    chosen += [name for name in ("dissipation", "pressure_error") if name in outputs]
    keys = list(rows[0].values)
    lines = [[*keys, *chosen, "seconds", ""]]
    for row in rows[:_SHOWN]:
        answers = [f"{row.outputs[name]:.6g}" if name in row.outputs else "" for name in chosen]
        ending = "certified" if row.solved else row.status
        lines.append([*(_word(row.values[key]) for key in keys), *answers, f"{row.wall_seconds:.2f}", ending])
    more = len(rows) - _SHOWN
    return [*align(lines, right=range(len(keys) + len(chosen) + 1)), *([f"  ... {more} more"] if more > 0 else [])]


def _told(found: Sweep, folder: Path) -> int:
    """Say which rows have no answer; the exit code."""
    sys.stdout.flush()
    failed = [row for row in found.rows if not row.solved]
    if not failed:
        return DONE
    words = f"{len(failed)} of {len(found.rows)} rows have no certified solution, see {folder / TABLE}"
    print(f"signorini: {words}; the first: {_why(failed[0])}", file=sys.stderr)
    return FAILED if any(row.status == BROKEN for row in failed) else NO_SOLUTION


def _why(row: StudyRow) -> str:
    values = ", ".join(f"{key} = {value}" for key, value in row.values.items())
    return f"{values}: {row.status}: {row.message}"


def _word(value: Value) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
