# SPDX-License-Identifier: BSD-3-Clause
"""A result folder: one run at a time writes into it, whole files alone, and none of an earlier run stays."""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
import time
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.arrays import stored
from signorini.clock import Clock
from signorini.crew import shared
from signorini.distributed.ranks import ON_RANKS
from signorini.errors import InputError
from signorini.memory import available_memory
from signorini.model.prints import Prints
from signorini.outcome import Outcome
from signorini.output.archive import GrowingArchive, read_archive, write_archive
from signorini.output.checkpoint import write_checkpoint
from signorini.output.contact_csv import write_contacts
from signorini.output.dat import write_dat
from signorini.output.fatigue_csv import with_fatigue_fields, write_fatigue
from signorini.output.fields import Fields
from signorini.output.frd import write_frd
from signorini.output.history_csv import write_history
from signorini.output.room import results_bytes, shared_states
from signorini.output.series import frames, with_ranks, write_series
from signorini.output.summary import summary
from signorini.output.vtu import FIELDS, write_bodies, write_surfaces
from signorini.solution.history import History

if TYPE_CHECKING:
    from signorini.output.rank_files import FieldsOnRanks

try:
    import fcntl
except ImportError:  # Windows has no such module; two runs into one folder are not told apart there
    fcntl = None  # type: ignore[assignment]

_MAX_KEEP_SHARE = 0.1  # of the time: more than that a run does not spend on writing what is finished while steps wait
_ASIDE_PREFIX = ".writing-"  # of folders in which files are written before they appear
_OWN_NAMES = re.compile(
    r"(summary\.json|(contact|history|fatigue|contact_table|history_table)\.csv|state\.npz|solution(_\d{4,})?\.p?vtu|"
    r"contact\.(vtu|pvd)|solution\.(pvd|h5|frd|dat)|"
    r"(contact|stress|displacement|peeq|mesh|view|history|wear|fatigue|accuracy|escape)\.png|report\.html|"
    r"(modes|damping|loops)\.csv|modes\.vtu|(modes|damping)\.png)"
)
_OWN_FIELD_NAMES = re.compile(r"(solution|contact)(_\d{4,}){0,2}(_rank\d+)?\.p?vtu")

SUMMARY = "summary.json"
"""The file of a result folder that tells of the run."""

ARCHIVE = "solution.h5"
"""The file of a result folder that holds the whole history."""

SWEEP, SWEEP_TABLE = "sweep.json", "sweep.csv"
"""The files of a folder in which a parameter study keeps its rows."""

SURFACES = "contact.vtu"
"""The file of a result folder that holds the contact surfaces."""


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


@contextmanager
def own_folder(path: Path, deck: str) -> Iterator[Path]:
    """Open a folder for one run alone, as long as the block lasts; results of another deck are left alone.

    Raises
    ------
    InputError
        If the folder cannot be written to, another run is at it, or it holds the results of another deck.
    """
    folder = open_folder(path)
    with _locked(folder):
        other = _said(folder, "deck")
        if other not in ("", deck):
            raise InputError(
                f"the folder '{folder}' holds the results of another deck, '{other}'; expected a folder of its own (-o)"
            )
        for left in folder.glob(f"{_ASIDE_PREFIX}*"):  # of a run that was killed while it wrote
            shutil.rmtree(left, ignore_errors=True)
        yield folder


def write_folder(history: History, path: Path, *, compress: bool = False) -> list[Path]:
    """Write a history as a run of a deck does, into a folder that may hold an earlier one; the files.

    Parameters
    ----------
    history, path : what is written, and into which folder
    compress : whether fields, archive and state are

    Raises
    ------
    InputError
        If the folder cannot be written to, a run is at it, or it holds the results of a deck.
    """
    clock = Clock()
    clock.seconds |= history.timings
    started = time.perf_counter() - sum(history.timings.values())
    with own_folder(path, "") as folder:
        return Publisher(folder=folder, clock=clock, started=started, compress=compress).publish(history)


def read_results(path: Path) -> History:
    """Read a history from an archive, or from the folder that holds it."""
    return read_folder(path) if path.is_dir() else read_archive(path)


def read_folder(path: Path) -> History:
    """Read the history that a run has left in a folder.

    Raises
    ------
    InputError
        If there is no such folder, or it lacks a file: then why, where the run tells.
    """
    if not path.is_dir():
        raise InputError(f"there is no folder '{path}'; expected one that 'signorini run' has written")
    if (path / SWEEP).is_file():
        pictures = "".join(f", drawn in '{file.name}'" for file in path.glob("sweep.png"))
        raise InputError(
            f"the folder '{path}' is that of a sweep, whose rows are in '{SWEEP_TABLE}'{pictures}; expected that of a "
            "run, such as 'signorini sweep --results' writes for each row"
        )
    for name in (SUMMARY, ARCHIVE):
        if not (path / name).is_file():
            status = _said(path, "status")
            why = f": the run ended with '{status}': {_said(path, 'message')}" if status not in ("", "solved") else ""
            raise InputError(f"the folder '{path}' has no '{name}'{why}")
    return read_archive(path / ARCHIVE)


def _said(folder: Path, key: str) -> str:
    """An entry of the summary in a folder; empty where there is none, or none that can be read."""
    try:
        return str(json.loads((folder / SUMMARY).read_text(encoding="utf-8"))[key])
    except (OSError, ValueError, KeyError, TypeError):
        return ""


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the folder; the system lets go of it whenever the process ends, however it ends."""
    if fcntl is None:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            words = f"another run writes into the folder '{folder}'; expected a folder of its own for each (-o)"
            raise InputError(words) from None
        except OSError:  # a file system that knows no locks
            pass
        yield
    finally:
        os.close(handle)


@dataclass(kw_only=True)
class Publisher:
    """Writes the history of a run into its folder, what is finished first, in the end everything.

    Attributes
    ----------
    folder : that :func:`own_folder` opened
    deck : name of the deck
    clock : its seconds go into the summary, and those of the output are added to it
    started : ``time.perf_counter()`` at the beginning of the run
    prints : what a deck of keywords asks for: what its users expect is written too, ``.frd`` and, if there are tables,
        ``.dat``
    compress : whether fields, archive and state are
    """

    folder: Path
    clock: Clock
    started: float
    deck: str = ""
    prints: Prints | None = None
    compress: bool = False
    _written: set[str] = field(default_factory=set)
    _archive: GrowingArchive = field(init=False)
    _spent: float = 0.0
    _ranks: FieldsOnRanks | None = None

    def __post_init__(self) -> None:
        self._archive = GrowingArchive(compress=self.compress)

    def keep(self, history: History) -> None:
        """Write what is finished while the next step waits, where that has taken at most a tenth of the time so far.

        Every step that takes ten times as long as writing is on disk at its end; faster ones some at a time. Where
        memory does not hold results beside what the next step is solved with, they wait for the end.
        """
        begin = time.perf_counter()
        if self._spent > _MAX_KEEP_SHARE * (begin - self.started) or results_bytes(history.model) > available_memory():
            return
        first = not self._written
        try:
            self.publish(history)
        finally:
            # the first time loads what the end of the run needs anyway, and takes several times as long
            self._spent += 0.0 if first else time.perf_counter() - begin

    def publish(self, history: History) -> list[Path]:
        """Write a history, finished or not, in place of whatever an earlier run left in the folder.

        Everything is written aside first, then the new files come under their names, each whole, the summary last: a
        summary in the folder means that the files beside it are complete. Earlier results go before that; what this
        run itself wrote earlier stays until it is replaced, so that it is there whenever the process is killed.

        Parameters
        ----------
        history : with no step at all, a summary is written, which says why, and an archive with the motion of bodies
            that run away

        Returns
        -------
        The files, in the order of their appearance

        Raises
        ------
        OSError
            If they cannot be written, because the disk is full; what the folder held before is still there.
        """
        try:
            return self._publish(history)
        except OSError as error:
            self._archive = GrowingArchive(compress=self.compress)  # begin it anew
            self._written -= {ARCHIVE}
            reason = os.strerror(error.errno) if error.errno else str(error)
            words = f"cannot write results into '{self.folder}': {reason}; what it held before is still there"
            raise OSError(error.errno or 0, words) from error

    def _publish(self, history: History) -> list[Path]:
        folder, clock = self.folder, self.clock
        with tempfile.TemporaryDirectory(dir=folder, prefix=_ASIDE_PREFIX) as name:
            aside = Path(name)
            with (clock.spending if history.status == Outcome.RUNNING else clock.phase)("output"):
                names = self._write(history, aside)
            seconds = clock.seconds | {"total": time.perf_counter() - self.started}
            words = json.dumps(summary(history, seconds, self.deck), indent=2, allow_nan=False, ensure_ascii=False)
            (aside / SUMMARY).write_text(words + "\n", encoding="utf-8")
            names.append(SUMMARY)
            if not self._written:
                _clear(folder)
            for file in names:
                (folder / file).parent.mkdir(exist_ok=True)
                if (aside / file).exists():
                    os.replace(aside / file, folder / file)
            self._written |= set(names)
        return [folder / file for file in names]

    def _write(self, history: History, aside: Path) -> list[str]:
        """All files but the summary; their names. Fields that are in the folder already stay as they are.

        While the run goes on the archive grows, and the tables that users of other codes expect wait for the end. The
        archive is written beside the fields: HDF5 and NumPy let go of the interpreter.
        """
        if not history.steps and stored(history, "escape") is None:
            return []
        if history.backend in ON_RANKS and self._ranks is None:
            self._ranks = with_ranks(history)
        parts = [lambda: self._write_fields(history, aside), lambda: self._write_archive(history, aside)]
        # ranks hear from one thread
        return [name for names in shared(parts, worth=self._ranks is None) for name in names]

    def _write_archive(self, history: History, aside: Path) -> list[str]:
        """The whole history; its name."""
        if history.status == Outcome.RUNNING:
            last = self.folder / ARCHIVE if ARCHIVE in self._written else None
            self._archive.write(history, aside / ARCHIVE, last=last)
        else:
            write_archive(history, aside / ARCHIVE, compress=self.compress)
        return [ARCHIVE]

    def _write_fields(self, history: History, aside: Path) -> list[str]:
        """What is not in the archive alone; the names of the files."""
        if not history.steps:
            return []
        prints = None if history.status == Outcome.RUNNING else self.prints
        shared = () if prints is None else history.steps[: shared_states(history.model)]
        fields = Fields(history.model, shared=shared)
        names = _write_tables(history, fields, aside, done=self._written, compress=self.compress, ranks=self._ranks)
        if prints is not None:
            by_rows = self._ranks or fields
            write_frd(history, by_rows, aside / "solution.frd", prints.times)
            names.append("solution.frd")
            if prints.tables:
                write_dat(history, by_rows, prints, aside / "solution.dat")
                names.append("solution.dat")
        return names


def _clear(folder: Path) -> None:
    """Remove what an earlier run has left, and nothing else; the summary first, for it speaks of the rest."""
    (folder / SUMMARY).unlink(missing_ok=True)
    for old in folder.iterdir():
        if _OWN_NAMES.fullmatch(old.name):
            old.unlink()
    fields = folder / FIELDS
    if fields.is_dir():
        for old in fields.iterdir():
            if _OWN_FIELD_NAMES.fullmatch(old.name):
                old.unlink()
        if not any(fields.iterdir()):
            fields.rmdir()


def _write_tables(
    history: History,
    fields: Fields,
    folder: Path,
    *,
    done: Collection[str],
    compress: bool,
    ranks: FieldsOnRanks | None,
) -> list[str]:
    """Rows and fields of the steps, and the state at the end of the last one; their names.

    Fields whose names are in ``done`` are not written again; ``ranks`` write them where several hold the bodies.
    """
    write_contacts(history, folder / "contact.csv")
    names = ["contact.csv"]
    model = history.model
    if len(history.steps) > 1 or any(shot.deformed for shot in history.last.instants[:-1]):
        names += write_series(fields, frames(history), folder, done=done, compress=compress, ranks=ranks)
    if history.fatigue_results:
        write_fatigue(history, folder / "fatigue.csv")
        names.append("fatigue.csv")
    shown = _write_last(history, fields, folder, compress=compress, ranks=ranks)
    if model.contacts:
        write_surfaces(model, history.last.contacts, folder / SURFACES)
        names.append(SURFACES)
    write_history(history, folder / "history.csv")
    names = list(dict.fromkeys([*names, *shown, "history.csv"]))
    if history.end is not None:
        write_checkpoint(history.end, folder / "state.npz", compress=compress)
        names.append("state.npz")
    return names


def _write_last(
    history: History, fields: Fields, folder: Path, *, compress: bool, ranks: FieldsOnRanks | None
) -> list[str]:
    """Write the bodies at the end of the last step, with what criteria of fatigue say; the names of the files."""
    judged, last = history.fatigue_results, f"solution_{len(history.steps):04d}"
    if ranks is None:
        if not judged and (folder / f"{last}.vtu").exists():
            shutil.copyfile(folder / f"{last}.vtu", folder / "solution.vtu")
        else:
            bodies = with_fatigue_fields(fields, history) if judged else fields.at(history.last, strained=True)
            write_bodies(bodies, folder / "solution.vtu", compress=compress)
        return ["solution.vtu"]
    index = "solution.pvtu" if judged else f"{last}.pvtu"  # with no more to say files of ranks are called by the step
    if not (folder / index).exists():
        ranks.write(history.last, folder, index, compress=compress, results=judged)
    if not judged:
        shutil.copyfile(folder / index, folder / "solution.pvtu")
    return [*ranks.files(index), "solution.pvtu"]
