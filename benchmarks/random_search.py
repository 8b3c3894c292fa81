# SPDX-License-Identifier: BSD-3-Clause
"""What programs share that make a random model of every seed and judge its answer: verdict, command line, table."""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from benchmarks import command, page


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What became of a model.

    Attributes
    ----------
    outcome : a word; in capitals where it is a failure
    words : numbers and messages
    worst : violation of a law or difference from a reference, relative; 0 where nothing was measured
    """

    outcome: str
    words: str
    worst: float = 0.0

    @property
    def failed(self) -> bool:
        return self.outcome.isupper()


Judge = Callable[[int, frozenset[str]], tuple[Collection[str], Verdict]]
"""The model of a seed that has some kinds at least: all its kinds, and its verdict."""


def parser(words: str | None, kinds: Sequence[str], models: int) -> argparse.ArgumentParser:
    """Options of a search.

    Parameters
    ----------
    words : a module's docstring
    kinds : what models are made of
    models : how many there are if nothing is said
    """
    made = command.parser(words, write=True)
    made.add_argument("models", type=int, nargs="?", default=models)
    made.add_argument("--seed", type=int, default=0, help="of the first model; the others follow")
    made.add_argument("--kinds", nargs="*", default=[], choices=kinds, help="what is in every model")
    made.add_argument(
        "--in-turn", action="store_true", help="in every model the next one of them, of all if none is named"
    )
    made.add_argument("--kept", type=Path, help="file of verdicts: models that were right there are not judged again")
    made.add_argument("--only", type=int, help="the one model of this seed")
    return made


@dataclass
class Tally:
    """How often what came out, and the worst of it, of models of every kind."""

    kinds: Sequence[str]
    outcomes: dict[str, Counter[str]] = field(default_factory=dict)
    worst: dict[str, float] = field(default_factory=dict)

    def count(self, kinds: Collection[str], verdict: Verdict) -> None:
        for kind in ("all", *kinds):
            self.outcomes.setdefault(kind, Counter())[verdict.outcome] += 1
            self.worst[kind] = max(self.worst.get(kind, 0.0), verdict.worst)

    def table(self) -> str:
        """Failures are the last columns but one."""
        every = self.outcomes["all"]
        names = sorted(every, key=lambda name: (name.isupper(), -every[name]))
        rows = [
            [kind, *(self.outcomes[kind][name] for name in names), f"{self.worst[kind]:.0e}"]
            for kind in ("all", *self.kinds)
            if kind in self.outcomes
        ]
        return page.table(["models with", *names, "worst"], rows)


def _kept(path: Path | None) -> dict[tuple[int, frozenset[str]], tuple[Collection[str], Verdict]]:
    """Kinds and verdicts of models that did not fail, by seed and kinds that were wanted; a later line counts."""
    found: dict[tuple[int, frozenset[str]], tuple[Collection[str], Verdict]] = {}
    if path is None or not path.exists():
        return found
    for line in map(json.loads, path.read_text(encoding="utf-8").splitlines()):
        verdict = Verdict(**line["verdict"])
        if not verdict.failed:
            found[line["seed"], frozenset(line["wanted"])] = line["kinds"], verdict
    return found


def search(options: argparse.Namespace, kinds: Sequence[str], judge: Judge, name: str) -> None:
    """Judge the models that the options ask for, or until Ctrl-C; print failures and the table.

    Parameters
    ----------
    options : see `parser`
    kinds : what models are made of
    judge : makes and judges the model of a seed
    name : of the place in a document for the table
    """
    seeds = [options.only] if options.only is not None else range(options.seed, options.seed + options.models)
    tally, done, named = Tally(kinds), 0, options.kinds or kinds
    before = _kept(options.kept)
    try:
        for seed in seeds:
            wanted = frozenset([named[seed % len(named)]] if options.in_turn else options.kinds)
            found, verdict = before.get((seed, wanted)) or judge(seed, wanted)
            if options.kept and (seed, wanted) not in before:
                line = {"seed": seed, "wanted": sorted(wanted), "kinds": sorted(found), "verdict": asdict(verdict)}
                with options.kept.open("a", encoding="utf-8") as file:
                    print(json.dumps(line), file=file)
            tally.count(found, verdict)
            done += 1
            if verdict.failed or options.only is not None:
                print(f"{seed} ({' '.join(sorted(found))}): {verdict.outcome}: {verdict.words}", flush=True)
    except KeyboardInterrupt:  # what is done counts
        if not done:
            raise
    turn = ", in every model the next of these kinds and others by chance" if options.in_turn else ""
    text = f"{tally.table()}\n\n{done} models, seeds {seeds[0]} to {seeds[done - 1]}{turn}."
    print(f"\n{text}")
    if options.write:
        page.write(name, text, options.write)
