# SPDX-License-Identifier: BSD-3-Clause
"""A factorisation that threads share: branches of the tree side by side, above them large fronts tile by tile.

What is computed, and in which order numbers are added, is a matter of the plan: the same to the last bit for any
number of threads.

References
----------
Geist, Ng (1989), Task scheduling for parallel sparse Cholesky factorization, Int. J. Parallel Program. 18:291.
Buttari, Langou, Kurzak, Dongarra (2009), A class of parallel tiled linear algebra algorithms, Parallel Comput. 35:38.
"""

from __future__ import annotations

from collections import deque
from functools import partial

import numpy as np

from signorini.linalg import _fronts, _symbolic
from signorini.linalg._blas import StoredMatrix, scratch
from signorini.linalg._fronts import Stacks, Tree
from signorini.linalg.crew import Crew
from signorini.linalg.plan import Fronts, Part, Plan

TILE = 512  # rows and columns of a large front that one thread takes at a time: smaller ones cost BLAS a tenth more


def factorise_parts(tree: Tree, plan: Plan, crew: Crew) -> int:
    """Factorise; give -1, or the place in the order of elimination where a pivot is not positive.

    Parameters
    ----------
    tree, plan : what is factorised
    crew : its threads
    """
    stacks = _fronts.stacks(plan.fronts, len(tree.elimination.order), plan.stacks)
    branches = _Branches(tree, plan) if crew.threads > 1 else None
    made = crew.ahead(partial(branches.factorise, part) for part in plan.parts if part.branch) if branches else None
    for part in plan.parts:
        if part.branch and branches and made:
            failed, left = next(made)
            if failed < 0:
                branches.take(part, left, stacks)
        elif part.large:
            failed = _large_front(tree, part.begin, stacks, crew)
        else:
            failed = crew.run(partial(_fronts.factorise_fronts, tree, part.begin, part.end, stacks, False))
        if failed >= 0:
            return failed
    _fronts.add_interface(tree.K, tree.elimination, tree.slot, tree.made.condensed)
    return -1


class _Branches:
    """Branches of the tree, factorised on stacks of their own that are used again."""

    def __init__(self, tree: Tree, plan: Plan) -> None:
        self._tree = tree
        sizes = [_most_waiting(tree.fronts, part) for part in plan.parts if part.branch]
        self._size = max((size[0] for size in sizes), default=0), max((size[1] for size in sizes), default=0)
        self._spare: deque[Stacks] = deque()

    def factorise(self, part: Part) -> tuple[int, Stacks]:
        """Factorise one; what is left of it lies on the stack of its root."""
        tree = self._tree
        try:
            stacks = self._spare.pop()
        except IndexError:
            stacks = _fronts.stacks(tree.fronts, len(tree.elimination.order), self._size)
        return _fronts.factorise_fronts(tree, part.begin, part.end, stacks, True), stacks

    def take(self, part: Part, branch: Stacks, stacks: Stacks) -> None:
        """Take over what is left of one.

        Parameters
        ----------
        part, branch : which one, and its stacks
        stacks : of the fronts above
        """
        root = part.end - 1
        side, size = self._tree.fronts.side[root], int(self._tree.fronts.below[root]) ** 2
        top = stacks.top[side]
        stacks.left[side][top : top + size] = branch.left[side][:size]
        _fronts.leave_front(self._tree, root, stacks, False)
        branch.top[:] = branch.number[:] = 0
        self._spare.append(branch)


def _most_waiting(fronts: Fronts, branch: Part) -> tuple[int, int]:
    """Entries that wait in a branch on each of its two stacks at the worst time."""
    inside = slice(branch.begin, branch.end)
    parent = fronts.parent[inside] - branch.begin
    parent[-1] = -1  # the root, whose parent is above
    return _symbolic.stack_peaks(parent, fronts.side[inside], fronts.below[inside].astype(np.int64) ** 2)


def _large_front(tree: Tree, t: int, stacks: Stacks, crew: Crew) -> int:
    """Factorise a front tile by tile; give -1, or the place in the order where a pivot is not positive."""
    fronts = tree.fronts
    leaf = crew.run(partial(_fronts.gather_front, tree, t, stacks))
    a = int(fronts.unknown[fronts.first[t]])
    k, r = int(fronts.unknown[fronts.first[t + 1]]) - a, int(fronts.below[t])
    columns = StoredMatrix(tree.made.columns.ctypes.data + 8 * int(fronts.panel[t]), k + r)
    for block in _tiles(0, k):
        first, width = block
        failed = crew.run(partial(_fronts.eliminate_tile, block, block, columns, scratch()))
        if failed != 0:
            return a + first + failed - 1
        below = _tiles(first + width, k + r)
        crew.each([partial(_fronts.eliminate_tile, block, rows, columns, scratch()) for rows in below])
    own = fronts.side[t]
    left = StoredMatrix(stacks.left[own].ctypes.data + 8 * int(stacks.top[own]), r)
    crew.each([partial(_fronts.leave_tile, tile, k, columns, not leaf, left, scratch()) for tile in _tiles(0, r)])
    crew.run(partial(_fronts.leave_front, tree, t, stacks, False))
    return -1


def _tiles(begin: int, end: int) -> list[tuple[int, int]]:
    """First rows and heights of tiles.

    >>> _tiles(0, 1200)
    [(0, 512), (512, 512), (1024, 176)]
    """
    return [(first, min(TILE, end - first)) for first in range(begin, end, TILE)]
