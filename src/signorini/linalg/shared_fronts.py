# SPDX-License-Identifier: BSD-3-Clause
"""A factorisation that threads share, task by task; see `schedule`.

What is computed, and in which order numbers are added, is a matter of the plan: the same to the last bit for any
number of threads.
"""

from __future__ import annotations

from collections import deque
from functools import partial
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, Int32Array
from signorini.crew import Crew, Job
from signorini.linalg import _front_tiles, _fronts, _symbolic
from signorini.linalg._blas import StoredMatrix, scratch
from signorini.linalg._fronts import Stacks, Tree
from signorini.linalg.plan import Fronts, Part, Plan
from signorini.linalg.schedule import FrontTask, tasks
from signorini.memory import apart


class NoPivot(Exception):
    """A pivot is not positive.

    Parameters
    ----------
    place : of its unknown in the order of elimination
    """

    def __init__(self, place: int) -> None:
        super().__init__(place)
        self.place = place


def factorise_parts(tree: Tree, plan: Plan, crew: Crew) -> int:
    """Factorise; give -1, or the place in the order of elimination where a pivot is not positive.

    Parameters
    ----------
    tree, plan : what is factorised
    crew : its threads
    """
    shared = _Shared(tree, plan)
    try:
        crew.finish([Job(partial(shared.do, task), task.needs) for task in tasks(plan)])
    except NoPivot as error:
        return error.place
    _fronts.add_interface(tree.K, tree.elimination, tree.slot, tree.made.condensed)
    return -1


class _Front(NamedTuple):
    """A front that threads work on.

    Attributes
    ----------
    below : the unknowns below it, ascending
    left : (r^2,) what will be left, the lower triangle of a matrix by columns
    children : what is left of each, with the rows here that its rows are, and where those that follow each other begin
    """

    below: Int32Array
    left: Array
    children: list[tuple[Array, Int32Array, Int32Array]]


class _Shared:
    """A factorisation on its way: what is left of fronts, by front, and the fronts at hand."""

    def __init__(self, tree: Tree, plan: Plan) -> None:
        self._tree = tree
        sizes = [_most_waiting(tree.fronts, part) for part in plan.parts if part.branch]
        self._size = max((size[0] for size in sizes), default=0), max((size[1] for size in sizes), default=0)
        self._ahead = deque(range(len(sizes)))  # branches that nobody has begun
        self._spare: deque[Stacks] = deque()
        self._left: dict[int, Array] = {}
        self._begun: dict[int, _Front] = {}

    def do(self, task: FrontTask) -> None:
        """Do a task.

        Raises
        ------
        NoPivot
            Where a pivot is not positive.
        """
        match task.kind:
            case "branch":
                self._eliminate_branch(task)
            case "begin":
                self._begin(task.front)
            case "gather":
                self._gather(task)
            case "eliminate":
                self._eliminate(task)
            case "leave":
                self._leave(task)
            case "end":
                self._end(task)

    def _eliminate_branch(self, task: FrontTask) -> None:
        """Eliminate fronts, and keep what is left of them."""
        tree = self._tree
        self._ahead.pop()
        try:
            stacks = self._spare.pop()
        except IndexError:
            stacks = _fronts.stacks(tree.fronts, len(tree.elimination.order), self._size)
        failed = _fronts.factorise_fronts(tree, task.front, task.end, stacks, True)
        if failed >= 0:
            raise NoPivot(failed)
        for side in range(2):
            top = 0
            for t in stacks.waiting[side, : stacks.number[side]].tolist():
                size = int(tree.fronts.below[t]) ** 2
                self._left[t] = apart(size)
                self._left[t][:] = stacks.left[side][top : top + size]
                top += size
        stacks.top[:] = stacks.number[:] = 0
        if self._ahead:
            self._spare.append(stacks)
        else:  # what follows is the largest fronts
            self._spare.clear()

    def _begin(self, t: int) -> None:
        """Make room for what will be left of a front, and see where its children go."""
        fronts = self._tree.fronts
        a, k = _own(fronts, t)
        below = _below(fronts, t)
        rows = np.concatenate([np.arange(a, a + k, dtype=np.int32), below])
        children = []
        for child in np.flatnonzero(fronts.parent[:t] == t)[::-1].tolist():
            target = np.searchsorted(rows, _below(fronts, child)).astype(np.int32)
            runs = np.flatnonzero(np.diff(target, prepend=-2, append=-2) != 1).astype(np.int32)
            children.append((self._left.pop(child), target, runs))
        self._begun[t] = _Front(below, apart(len(below) ** 2), children)

    def _gather(self, task: FrontTask) -> None:
        """Gather columns of a front from K and from what its children left."""
        tree, t = self._tree, task.front
        front = self._begun[t]
        k = _own(tree.fronts, t)[1]
        rows = k + len(front.below)
        _front_tiles.gather_matrix(tree, t, task.columns, front.below)
        into = tree.made.columns[tree.fronts.panel[t] : tree.fronts.panel[t + 1]]
        for child in front.children:
            _front_tiles.add_child(*child, task.columns, (0, rows), into, rows, 0)

    def _columns(self, t: int) -> tuple[int, StoredMatrix]:
        """How many columns a front has of its own, and where they lie."""
        fronts, k = self._tree.fronts, _own(self._tree.fronts, t)[1]
        return k, StoredMatrix(self._tree.made.columns.ctypes.data + 8 * int(fronts.panel[t]), k + int(fronts.below[t]))

    def _eliminate(self, task: FrontTask) -> None:
        """Eliminate columns of a front from some rows."""
        failed = _front_tiles.eliminate_tile(task.columns, task.rows, self._columns(task.front)[1], scratch())
        if failed != 0:
            raise NoPivot(_own(self._tree.fronts, task.front)[0] + task.columns[0] + failed - 1)

    def _leave(self, task: FrontTask) -> None:
        """Form a tile of what is left of a front."""
        front, (k, columns) = self._begun[task.front], self._columns(task.front)
        r = len(front.below)
        (first, width), (begin, height) = task.columns, task.rows
        front.left.reshape(r, r)[first - k : first - k + width, begin - k : begin - k + height] = 0.0
        for child in front.children:
            _front_tiles.add_child(*child, task.columns, task.rows, front.left, r, k)
        left = StoredMatrix(front.left.ctypes.data, r)
        _front_tiles.leave_tile(task.columns, task.rows, k, columns, left, scratch())

    def _end(self, task: FrontTask) -> None:
        """Hand on what is left of a front, and what is left of fronts without a parent to the condensed matrix.

        Of the last front of a body that the interface does not touch nothing is left.
        """
        if task.front in self._begun:
            self._left[task.front] = self._begun.pop(task.front).left
        fronts, inside = self._tree.fronts, len(self._tree.elimination.order) - len(self._tree.slot)
        for t in range(task.front, task.end):
            if fronts.parent[t] == -1 and fronts.below[t] > 0:
                target = self._tree.slot[_below(fronts, t) - inside]
                _front_tiles.add_root(self._left.pop(t), target, self._tree.made.condensed)


def _own(fronts: Fronts, t: int) -> tuple[int, int]:
    """First unknown of a front, and how many it eliminates."""
    a, end = fronts.unknown[fronts.first[t : t + 2]].tolist()
    return a, end - a


def _below(fronts: Fronts, t: int) -> Int32Array:
    """The unknowns below a front, ascending."""
    nodes = fronts.row[fronts.begin[t] : fronts.begin[t + 1]]
    first, size = fronts.unknown[nodes], fronts.unknown[nodes + 1] - fronts.unknown[nodes]
    ends = np.cumsum(size)
    total = int(ends[-1]) if len(ends) else 0
    return (np.repeat(first - (ends - size), size) + np.arange(total)).astype(np.int32)


def _most_waiting(fronts: Fronts, branch: Part) -> tuple[int, int]:
    """Entries that wait in a branch on each of its two stacks at the worst time; what is left of its roots stays."""
    inside, number = slice(branch.begin, branch.end), branch.end - branch.begin
    parent = fronts.parent[inside] - branch.begin
    parent[(parent < 0) | (parent > number)] = number
    return _symbolic.stack_peaks(parent, fronts.side[inside], fronts.below[inside].astype(np.int64) ** 2)
