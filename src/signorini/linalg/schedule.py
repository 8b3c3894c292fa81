# SPDX-License-Identifier: BSD-3-Clause
"""What threads share of a factorisation: tasks, and which of them need each other.

Subtrees of fronts are a task each. Above them every front is taken tile by tile, so that threads go on at its end, at
the fronts beside it and at the one above at once.

References
----------
Geist, Ng (1989), FrontTask scheduling for parallel sparse Cholesky factorization, Int. J. Parallel Program. 18:291.
Buttari, Langou, Kurzak, Dongarra (2009), A class of parallel tiled linear algebra algorithms, Parallel Comput. 35:38.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from signorini.linalg.plan import Fronts, Plan

TILE = 512  # rows and columns of a front that one thread takes at a time: smaller ones cost BLAS a tenth more

Kind = Literal["branch", "begin", "gather", "eliminate", "leave", "end"]
Tile = tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class FrontTask:
    """What one thread does of a factorisation.

    Attributes
    ----------
    kind : eliminate fronts below the shared ones; or of one front begin it, gather columns, eliminate columns from some
        rows, form a tile of what is left, end it: hand on what is left
    front, end : the front, or the fronts of a branch from the first to behind the last
    columns, rows : first ones of a tile, and how many
    needs : numbers of tasks that have to be done before, all of them smaller
    work : multiplications and additions
    """

    kind: Kind
    front: int
    end: int
    columns: Tile = (0, 0)
    rows: Tile = (0, 0)
    needs: tuple[int, ...] = ()
    work: float = 0.0


def tasks(plan: Plan) -> list[FrontTask]:
    """The tasks of a factorisation, in an order in which one thread can do them."""
    made = _Tasks(plan.fronts)
    for part in plan.parts:
        if part.branch:
            made.branch(part.begin, part.end, part.work)
        else:
            made.front(part.begin)
    return made.found


def tiles(begin: int, end: int, size: int = TILE) -> list[Tile]:
    """First rows and heights of tiles.

    Parameters
    ----------
    begin, end : of all rows
    size : of a tile

    Examples
    --------
    >>> tiles(0, 1200)
    [(0, 512), (512, 512), (1024, 176)]
    """
    return [(first, min(size, end - first)) for first in range(begin, end, size)]


class _Tasks:
    """Tasks so far, and those that hand on what is left of a front, by front."""

    def __init__(self, fronts: Fronts) -> None:
        self.found: list[FrontTask] = []
        self._fronts = fronts
        self._ends: dict[int, int] = {}
        self._below: dict[int, list[int]] = {}
        self._root: tuple[int, ...] = ()

    def _add(self, kind: Kind, t: int, needs: Iterable[int], columns: Tile = (0, 0), rows: Tile = (0, 0)) -> int:
        work = self._work(kind, t, columns, rows)
        order = tuple(sorted(set(needs)))
        self.found.append(FrontTask(kind=kind, front=t, end=t + 1, columns=columns, rows=rows, needs=order, work=work))
        return len(self.found) - 1

    def _work(self, kind: Kind, t: int, columns: Tile, rows: Tile) -> float:
        """Multiplications and additions of a task on a front."""
        (first, width), (begin, height) = columns, rows
        if kind == "eliminate":
            both = 2.0 * width * first + width**2
            return height * both if begin != first else width * (width * first + width**2 / 3)
        if kind == "leave":
            k = int(self._fronts.unknown[self._fronts.first[t + 1]] - self._fronts.unknown[self._fronts.first[t]])
            return float(int(width) * int(height) * k * (2 if begin != first else 1))
        return 0.0

    def _hand_on(self, fronts: Iterable[int], task: int) -> None:
        for t in fronts:
            self._ends[t] = task
            self._below.setdefault(int(self._fronts.parent[t]), []).append(t)

    def branch(self, begin: int, end: int, work: float) -> None:
        """Fronts that follow each other and have all their children among them."""
        parent = self._fronts.parent[begin:end]
        roots = begin + np.flatnonzero((parent == -1) | (parent >= end))
        self.found.append(FrontTask(kind="branch", front=begin, end=end, work=work))
        task = len(self.found) - 1
        if (parent == -1).any():  # the condensed matrix is added to in one order
            self.found.append(FrontTask(kind="end", front=begin, end=end, needs=(task, *self._root)))
            task = len(self.found) - 1
            self._root = (task,)
        self._hand_on(roots.tolist(), task)

    def front(self, t: int) -> None:
        """A front by tiles."""
        fronts = self._fronts
        k = int(fronts.unknown[fronts.first[t + 1]] - fronts.unknown[fronts.first[t]])
        begun = self._add("begin", t, [self._ends[child] for child in self._below.pop(t, [])])
        blocks, below = tiles(0, k), tiles(k, k + int(fronts.below[t]))
        gathered = [self._add("gather", t, [begun], block) for block in blocks]
        done: dict[Tile, int] = {}
        for block, ready in zip(blocks, gathered, strict=True):
            done[block] = pivot = self._add("eliminate", t, [ready, *_known(done, block)], block, block)
            for rows in [tile for tile in blocks if tile > block] + below:
                done[rows] = self._add("eliminate", t, [pivot, *_known(done, rows)], block, rows)
        left = [
            self._add("leave", t, [done[columns], done[rows]], columns, rows)
            for i, columns in enumerate(below)
            for rows in below[i:]
        ]
        root = fronts.parent[t] == -1
        end = self._add("end", t, [*(left or done.values()), *(self._root if root else ())])
        if root:
            self._root = (end,)
        self._hand_on([t], end)


def _known(done: dict[Tile, int], tile: Tile) -> Iterator[int]:
    if tile in done:
        yield done[tile]
