# SPDX-License-Identifier: BSD-3-Clause
"""A second process beside the first run after an installation, which compiles what the run comes to last.

The run takes about as long for what it comes to first: the assembly and the order of elimination. From there on it
finds on disk what the other process has compiled, the largest loop first. Neither waits: where the second process is
late or missing, the run compiles itself.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numba import typeof

from signorini.condense.body_blocks import mirror
from signorini.linalg import _front_solves, _fronts, _symbolic
from signorini.linalg._blas import scratch
from signorini.linalg._graph import Elimination, Graph, Rows, both_ways, quotient, subgraph
from signorini.linalg.plan import RELAX, Fronts


def calls() -> list[tuple[Any, tuple[object, ...]]]:
    """Loops of every condensed run in the order of `compile_loops`, with arguments of the types that they have there.

    Graphs, which the run comes to while it compiles the assembly, the largest loop, then from the last one on. The run
    compiles the order of elimination meanwhile: two processes at one large loop would waste their time.
    """
    small, large, real, square = np.zeros(1, np.int32), np.zeros(1, np.int64), np.zeros(1), np.zeros((1, 1))
    graph, elimination, rows = Graph(small, small), Elimination(small, small), Rows(small, small, real)
    fronts = Fronts(small, small, large, small, small, small, large, small)
    tree = _fronts.Tree(fronts, rows, elimination, small, _fronts.Factors(real, square, real))
    solved = (fronts, real, square, real, scratch())
    return [
        (both_ways, (graph,)),
        (quotient, (graph, small, small, small)),
        (subgraph, (graph, 1)),
        (_fronts.factorise_fronts, (tree, 0, 1, _fronts.stacks(fronts, 1, (1, 1)), False)),
        (_front_solves.backward, solved),
        (_front_solves.forward, solved),
        (mirror, (np.zeros((2, 2), order="F"),)),
        (mirror, (square,)),
        (_front_solves.pivots, (fronts, real)),
        (_fronts.add_interface, (rows, elimination, small, square)),
        (_symbolic.stack_peaks, (small, small, large)),
        (_symbolic.sides, (small,)),
        (_symbolic.front_rows, (graph, elimination, small, small)),
        (_symbolic.supernodes, (small, small, RELAX)),
        (_symbolic.column_counts, (graph, elimination, small)),
        (_symbolic.postorder, (small,)),
        (_symbolic.elimination_tree, (graph, elimination, 1)),
    ]


def compile_loops() -> None:
    """Compile the loops; what is on disk is left as it is."""
    for loop, arguments in calls():
        loop.compile(tuple(typeof(argument) for argument in arguments))  # type: ignore[no-untyped-call]


@contextmanager
def helped() -> Iterator[None]:
    """Have another process compile while the block runs, if there is a core for it."""
    if not sys.executable or (os.cpu_count() or 1) < 2:
        yield
        return
    quiet = subprocess.DEVNULL
    beside = subprocess.Popen([sys.executable, "-m", __name__], stdin=quiet, stdout=quiet, stderr=quiet)
    try:
        yield
    finally:
        beside.terminate()
        beside.wait()


if __name__ == "__main__":
    compile_loops()
