# SPDX-License-Identifier: BSD-3-Clause
"""Run verification cases, in one process or in several: then this one imports nothing of what is verified."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from typing import Any

from signorini.cores import threads
from signorini.verify.check import Check

Case = Callable[[], Iterator[Check]]
CheckRow = dict[str, str | float | bool]
Begin = Callable[[str, int, int], None]

_SUITE = "signorini.verify.suite"
QUICK, ALL = f"{_SUITE}:QUICK", f"{_SUITE}:ALL"
"""Where the cases are: module and name of a tuple."""


def rows_of(cases: Sequence[Case], begin: Begin) -> Iterator[CheckRow]:
    """Rows of cases, each as soon as it is computed: case, quantity, computed, reference, error, tolerance, ...

    Parameters
    ----------
    cases : in the order of their rows
    begin : told before every case what it is, how many are done and how many there are
    """
    yield from _in_turn([_title(case) for case in cases], [partial(_rows, case) for case in cases], begin)


def shared_rows(where: str, begin: Begin, processes: int) -> Iterator[CheckRow]:
    """Rows in the same order from processes that share the cases: those of a case come once it is done.

    Where nothing is compiled yet, one of them compiles what every case needs while the other one is at the first case.

    Parameters
    ----------
    where : the cases are, as `QUICK`
    begin : as of `rows_of`
    processes : 1: this one computes
    """
    if processes == 1:
        yield from rows_of(_cases(where), begin)
        return
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        try:
            asked = pool.submit(_plan, where)
            found: dict[int, Future[list[CheckRow]]] = {0: pool.submit(_all_rows, where, 0)}
            pool.submit(_compile)
            plan = asked.result()
            for k in sorted(range(1, len(plan.titles)), key=lambda k: k not in plan.ahead):
                found[k] = pool.submit(_all_rows, where, k)
            yield from _in_turn(plan.titles, [found[k].result for k in range(len(found))], begin)
        finally:
            pool.shutdown(cancel_futures=True)


@dataclass(frozen=True, kw_only=True)
class _Plan:
    """What the cases are, and which go ahead: their loops take seconds to compile, which others would wait for."""

    titles: list[str]
    ahead: frozenset[int]


def _plan(where: str) -> _Plan:
    cases, much = _cases(where), importlib.import_module(_SUITE).COMPILE_MUCH
    ahead = () if _first_run().compiled() else [k for k, case in enumerate(cases) if case in much]
    return _Plan(titles=[_title(case) for case in cases], ahead=frozenset(ahead))


def _compile() -> None:
    if not _first_run().compiled():
        _first_run().compile_loops()


def _first_run() -> Any:
    return importlib.import_module("signorini.engine.first_run")


def _cases(where: str) -> Sequence[Case]:
    module, name = where.split(":")
    cases: Sequence[Case] = getattr(importlib.import_module(module), name)
    return cases


def _in_turn(
    titles: Sequence[str], found: Sequence[Callable[[], Iterable[CheckRow]]], begin: Begin
) -> Iterator[CheckRow]:
    for done, (title, rows) in enumerate(zip(titles, found, strict=True)):
        begin(title, done, len(titles))
        yield from rows()


def _title(case: Case) -> str:
    return case.__name__.replace("_", " ")


def _rows(case: Case) -> Iterator[CheckRow]:
    for check in case():
        yield check.row()


def _all_rows(where: str, k: int) -> list[CheckRow]:
    with threads(1):
        return list(_rows(_cases(where)[k]))
