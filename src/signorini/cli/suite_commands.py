# SPDX-License-Identifier: BSD-3-Clause
"""``signorini verify`` and ``signorini bench``: run a suite, print its table, write it as JSON."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from signorini.cli.progress import progress_bar
from signorini.clock import Listener
from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write

_VERIFY_COLUMNS = ("passed", "computed", "reference", "error", "tolerance", "case, quantity; source")
_COLUMN_WIDTH = 12  # letters
_PROCESSES = 4  # that share the cases at most: each holds a model, and the longest cases take a part of all
_BENCH_COLUMNS = (
    "name",
    "dofs",
    "contact_pairs",
    "friction",
    "path",
    "backend",
    "assembly_seconds",
    "contact_seconds",
    "linear_seconds",
    "ratio",
    "cpu_seconds",
    "peak_memory_bytes",
    "iterations",
)


def verify(options: argparse.Namespace) -> int:
    """Print every row as soon as it is computed; 0 only if every case passed."""
    file = _json_file(options.json)
    from signorini.cores import number_of_threads
    from signorini.verify.rows import ALL, QUICK, shared_rows

    processes = min(number_of_threads(), _PROCESSES)
    cases: list[Mapping[str, Any]] = []
    with progress_bar() as tell:
        print(_line(_VERIFY_COLUMNS))
        for case in shared_rows(ALL if options.all else QUICK, _beginning(tell), processes):
            if not cases or case["case"] != cases[-1]["case"]:
                print(case["case"])
            cases.append(case)
            numbers = [_word(case[column]) for column in ("passed", "computed", "reference", "error", "tolerance")]
            if case.get("at_least"):
                numbers[2] = f">= {numbers[2]}"
            print(_line(numbers, str(case["quantity"]), str(case["source"])), flush=True)
    _write(cases, file)
    failed = sum(not case["passed"] for case in cases)
    print(f"{len(cases)} quantities, {failed} failed" if failed else f"{len(cases)} quantities, all passed")
    return 1 if failed or not cases else 0


def bench(options: argparse.Namespace) -> int:
    """Print what is found as soon as it is known, the table of times at the end; 0 if everything could be timed."""
    file = _json_file(options.json)
    from signorini.bench.suite import benchmark_rows
    from signorini.output.table import align

    results = []
    with progress_bar() as tell:
        for result in benchmark_rows(options.names, options.dofs, options.sample, _beginning(tell)):
            results.append(result)
            if "counts" in result:
                counts = ", ".join(f"{what} {count}" for what, count in result["counts"].items())
                print(f"{result['name']}, {result['bodies']} bodies: {counts}", flush=True)
            if "words" in result:
                print(result["words"], flush=True)
    timed = [result for result in results if "ratio" in result]
    if timed:
        rows = [[_word(result.get(column)) for column in _BENCH_COLUMNS] for result in timed]
        heads = [column.replace("_", " ") for column in _BENCH_COLUMNS]
        print("\n".join(align([heads, *rows], right=range(1, len(heads)))))
    _write(results, file)
    return 0


def _beginning(tell: Listener | None) -> Callable[[str, int, int], None]:
    """From what begins, how many are done and how many there are to a progress bar."""
    return lambda what, done, count: tell(f"{done + 1} of {count}: {what}", done / count) if tell else None


def _line(row: Sequence[str], *words: str) -> str:
    """A row of the table of `verify`, which stands on its own: numbers in columns, then words."""
    return "  ".join(("", *(word.rjust(_COLUMN_WIDTH) for word in row), "; ".join(words))).rstrip()


def _json_file(name: str | None) -> Path | None:
    """Refuse a file that cannot be written before minutes are spent on what goes there."""
    if name is None:
        return None
    file = Path(name)
    if file.is_dir() or not file.absolute().parent.is_dir():
        raise InputError(f"cannot write '{file}'; expected a file in a folder that exists", where=("--json",))
    return file


def _write(results: Sequence[Mapping[str, Any]], file: Path | None) -> None:
    if file is not None:
        with atomic_write(file) as aside:
            aside.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def _word(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "NO"
    return f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
