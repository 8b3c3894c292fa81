# SPDX-License-Identifier: BSD-3-Clause
"""Inputs damaged at random: each must be read, or refused with one clear message, quickly and in little memory.

    python -m benchmarks.fuzz [--number 20000] [--seed 0] [--kind KIND] [--keep FOLDER]

Decks (TOML and keywords), meshes in many formats, result folders, archives and states, made of the examples and of the
decks of the tests. Decks are read and examined as ``signorini check`` does, states are gone on from; results are read
as ``signorini diff`` and ``signorini plot`` do. They are read in another process, which may use 1 GB more than at its
start and 5 seconds of the processor for an input. Input k depends on the seed and k alone. What fails is kept.
"""

from __future__ import annotations

import multiprocessing
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path
from types import FrameType

import matplotlib as mpl

from benchmarks import command
from benchmarks.mutations import KINDS, Corpus, corpus, damage, small_model
from signorini.api import solve
from signorini.deck import load_deck
from signorini.engine.examine import examine
from signorini.errors import InputError, SolveFailed
from signorini.gallery.spheres import hollow_spheres
from signorini.inspection.text import deck_text
from signorini.meshing.profile import read_profile
from signorini.meshing.read import read_mesh
from signorini.meshing.surface import read_surface
from signorini.model.model import Model
from signorini.output.archive import read_archive
from signorini.output.checkpoint import read_checkpoint
from signorini.output.compare import compare
from signorini.output.folder import read_folder
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import picture

SECONDS, MEMORY = 5, 2**30
STUCK = 60  # seconds by the clock: what not even a signal ends
_LONGEST = 2000  # characters of a message
_SHOWN = 3  # failures of one kind at one place that are kept

Found = tuple[int, str, str, str]
"""Number of an input, its kind, what became of it, and where, if it failed."""


class Late(BaseException):
    """An input took too long; nothing that catches errors of readers catches it."""


def outcome(kind: str, path: Path, sound: Corpus) -> str:
    """Read an input: "read", or "refused"; anything else is raised."""
    try:
        _read(kind, path, sound)
    except (InputError, SolveFailed) as error:
        return "refused" if len(str(error)) < _LONGEST else "refused with a message that is too long"
    return "read"


def _read(kind: str, path: Path, sound: Corpus) -> None:
    if kind in ("toml", "inp"):
        deck = load_deck(path, small_strain=True)
        try:
            deck_text(deck, examine(deck.model))
        except InputError as error:
            raise deck.locate(error) from error
    elif kind == "mesh":
        for read in (read_mesh, read_surface, read_profile):
            _try(lambda read=read: read(path))  # type: ignore[misc]
    elif kind == "state":
        solve(small_model(), start=read_checkpoint(path), raise_on_failure=False)
    elif kind == "archive":
        compare(read_archive(path), read_archive(sound.results / "solution.h5"))
    else:
        data = PictureData(read_folder(path))
        for what in ("contact", "stress", "history"):
            picture(data, what)


def _try(read: Callable[[], object]) -> None:
    """One of several ways to read a file; that it is refused says nothing of the others."""
    try:
        read()
    except InputError as error:
        if len(str(error)) >= _LONGEST:
            raise


@contextmanager
def _limit(seconds: float) -> Iterator[None]:
    def late(_: int, __: FrameType | None) -> None:
        raise Late(f"more than {seconds} s")

    signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def _place(error: BaseException) -> str:
    """File and line of ours in which an error came up, and the last one of all."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [frame for frame in frames if "/signorini/" in frame.filename]
    last = [*ours, *frames][-1] if not ours else ours[-1]
    end = f" ({Path(frames[-1].filename).name}:{frames[-1].lineno})" if frames[-1] is not last else ""
    return f"{last.filename.partition('/signorini/')[2] or last.filename}:{last.lineno}{end}"


def _one(sound: Corpus, number: int, seed: int, kind: str, folder: Path) -> Found:
    """Damage, read and forget input ``number``."""
    kind, path = damage(sound, random.Random(f"{seed}/{number}"), folder, kind)
    try:
        with warnings.catch_warnings(record=True), _limit(SECONDS):
            return number, kind, outcome(kind, path, sound), ""
    except (Exception, Late) as error:
        return number, kind, f"{type(error).__name__}: {str(error)[:120]}", _place(error)
    finally:
        if path.is_dir():
            shutil.rmtree(path)


def _worker(sound: Corpus, numbers: range, seed: int, kind: str, pipe: Connection, listener: Connection) -> None:
    """Read inputs one after the other, and tell what became of each; ends when nobody listens any more."""
    listener.close()
    mpl.use("Agg")
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    sys.stdout = sys.stderr = open("/dev/null", "w")  # noqa: SIM115  # for as long as the process lasts
    with tempfile.TemporaryDirectory() as name:
        for number in numbers:
            pipe.send(_one(sound, number, seed, kind, Path(name)))


def compile_first(sound: Corpus) -> None:
    """Read sound decks and rare models once: seconds in which a function is compiled at its first use do not count."""
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings(record=True):
        for kind, texts in sound.texts.items():
            for text in texts:
                path = Path(name, f"deck.{kind}")
                path.write_text(text)
                outcome(kind, path, sound)
        for model in rare_models():
            examine(model)


def rare_models() -> Iterator[Model]:
    """What no sound deck has and a damaged one may: curved sides in space that do not match, in both couplings."""
    spheres = hollow_spheres(n=(2, 3))
    for coupling in ("mortar", "node-to-segment"):
        yield replace(spheres, contacts=[replace(contact, coupling=coupling) for contact in spheres.contacts])


def outcomes(sound: Corpus, number: int, seed: int, kind: str = "") -> Iterator[Found]:
    """What became of each input; a process that an input ends, or that hangs in it, is followed by another."""
    fork, at = multiprocessing.get_context("fork"), 0
    while at < number:
        mine, other = fork.Pipe(duplex=False)
        process = fork.Process(target=_worker, args=(sound, range(at, number), seed, kind, other, mine), daemon=True)
        process.start()
        other.close()
        try:
            while at < number and mine.poll(STUCK):
                yield mine.recv()
                at += 1
        except EOFError:
            process.join()
            yield at, kind, f"the process ended: {process.exitcode}", "?"
            at += 1
            continue
        if at < number:
            process.kill()
            yield at, kind, "hangs", "?"
            at += 1
        process.join()


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("--number", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", choices=KINDS, default="", help="only one kind of input")
    parser.add_argument("--keep", type=Path, default=Path("fuzz-found"), help="where inputs that fail are kept")
    options = parser.parse_args()
    counts: Counter[tuple[str, str]] = Counter()
    failures: Counter[tuple[str, str]] = Counter()
    started = told = time.perf_counter()
    with tempfile.TemporaryDirectory() as name:
        sound = corpus(Path(name))
        compile_first(sound)
        for number, kind, became, place in outcomes(sound, options.number, options.seed, options.kind):
            if not place and became in ("read", "refused"):
                counts[kind, became] += 1
            else:
                what = became.partition(":")[0], place
                failures[what] += 1
                if failures[what] <= _SHOWN:
                    target = options.keep / f"{options.seed}-{number}"
                    target.mkdir(parents=True, exist_ok=True)
                    damage(sound, random.Random(f"{options.seed}/{number}"), target, options.kind)
                    print(f"{target}: {kind}: {became} at {place}", flush=True)
            if time.perf_counter() - told > 60:
                told = time.perf_counter()
                print(f"{number + 1} inputs in {told - started:.0f} s, {failures.total()} failed", flush=True)
    print(f"{options.number} inputs in {time.perf_counter() - started:.0f} s, {failures.total()} failed")
    for (kind, became), count in sorted(counts.items()):
        print(f"{count:8d}  {kind}: {became}")
    for (became, place), count in failures.most_common():
        print(f"{count:8d}  {became} at {place}")


if __name__ == "__main__":
    main()
