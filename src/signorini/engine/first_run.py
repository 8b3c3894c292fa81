# SPDX-License-Identifier: BSD-3-Clause
"""A second process beside the first run after an installation, which compiles.

A small run does not wait for it: Python interprets the loops, which takes less than to compile them and gives the same
numbers to the last bit, and the other process goes on for later runs. A large run compiles the loops in the order in
which it comes to them, the other process from the last one on, until they meet: whoever has begun with a loop has it
for both (`compilation`), and where the other process is missing, the run compiles all.
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
from numba.core.caching import IndexDataCacheFile

from signorini.compilation import UNREADABLE, compile_aside, interpreted
from signorini.condense._kernels import block_on, felt_stiffness
from signorini.fem import _kernels
from signorini.linalg import _front_solves, _fronts, _symbolic
from signorini.linalg._blas import scratch
from signorini.linalg._dense_tiles import mirror
from signorini.linalg._dissection import dissect
from signorini.linalg._graph import Elimination, Graph, Rows, both_ways, quotient_rows, subgraph
from signorini.linalg.plan import RELAX, Fronts
from signorini.model.model import Model

INTERPRETED_NODES = 4000
"""Nodes of the largest plane model whose loops are interpreted, three seconds; to compile them takes half a minute."""
FIRST_SOLVE = "first solve on this machine: compiling takes half a minute, once"


def compiled() -> bool:
    """Whether compiled loops are on disk, where the first solve leaves them: the first and the last that it needs."""
    return on_disk(_kernels.node_pattern) and on_disk(_fronts.factorise_fronts)


def on_disk(loop: Any) -> bool:
    """Whether a kernel has been compiled as its file is now.

    Parameters
    ----------
    loop : the kernel
    """
    try:
        return bool(IndexDataCacheFile._load_index(loop._cache._cache_file))  # type: ignore[no-untyped-call]
    except UNREADABLE:
        return False


def calls() -> list[tuple[Any, tuple[object, ...]]]:
    """Loops of every condensed run of plain bodies in the plane, the last first, with arguments of their types."""
    small, large, real, square = np.zeros(1, np.int32), np.zeros(1, np.int64), np.zeros(1), np.zeros((1, 1))
    graph, elimination, rows = Graph(small, small), Elimination(small, small), Rows(small, small, real)
    fronts = Fronts(small, small, large, small, small, small, large, small)
    tree = _fronts.Tree(fronts, rows, elimination, small, _fronts.Factors(real, square, real))
    solved = (real, square, real, scratch())
    cells = _kernels.Cells(
        np.zeros((1, 1), np.int32), np.zeros((1, 1, 1)), real, large, square, square, np.zeros((1, 1, 1, 1)), square
    )
    points = np.zeros((1, 2))
    points.flags.writeable = False  # as meshes keep them
    laws = _kernels.Laws(np.zeros((1, 3), np.uint32), square, real, 2)
    kept = _kernels.MatrixRows(small, small, real)
    pattern, share = _kernels.SparsityPattern(large, small, real), _kernels.Share(small, small, 0)
    return [
        (felt_stiffness, (small, small, real, small, small, real, 1)),
        (block_on, (small, small, real, large, large)),
        (mirror, (square, 0, 0)),
        (mirror, (np.zeros((2, 2), order="F"), 0, 0)),
        (_fronts.add_interface, (rows, elimination, small, square)),
        (_front_solves.backward, (fronts, 0, 1, *solved)),
        (_front_solves.forward, (fronts, *solved)),
        (_front_solves.pivots, (fronts, real)),
        (_fronts.factorise_fronts, (tree, 0, 1, _fronts.stacks(fronts, 1, (1, 1)), False)),
        (_symbolic.stack_peaks, (small, small, large)),
        (_symbolic.sides, (small,)),
        (_symbolic.front_rows, (graph, elimination, small, small)),
        (_symbolic.supernodes, (small, small, RELAX)),
        (_symbolic.column_counts, (graph, elimination, small)),
        (_symbolic.postorder, (small,)),
        (_symbolic.elimination_tree, (graph, elimination, 1)),
        (dissect, (graph, np.zeros((1, 1), np.int32), 1, 1)),
        (subgraph, (graph, 1)),
        (both_ways, (graph,)),
        (quotient_rows, (graph, small, small, small, (0, 1))),
        (_kernels.keep_rows, (kept, small, kept, 0, 1)),
        (_kernels.add_block, (points, cells, laws, pattern, share)),
        (_kernels.add_quadrilaterals, (points, cells, laws, pattern, share)),
        (_kernels.unknown_pattern, (large, small, 2)),
        (_kernels.node_pattern, (large, small, 1)),
        (_kernels.connected_pieces, (large, small, 1)),
    ]


def compile_loops() -> None:
    """Compile the loops that nobody else compiles; what is on disk is left as it is."""
    for loop, arguments in calls():
        compile_aside(loop, tuple(typeof(argument) for argument in arguments))  # type: ignore[no-untyped-call]


def compiles_first(model: Model) -> bool:
    """Whether a run has to compile before it can solve.

    Parameters
    ----------
    model : that it solves
    """
    return not _interpretable(model) and not compiled()


def _interpretable(model: Model) -> bool:
    """Whether Python interprets the loops of a model in seconds."""
    return model.dimension == 2 and len(model.mesh.points) <= INTERPRETED_NODES


@contextmanager
def helped(model: Model) -> Iterator[None]:
    """Have another process compile while the block runs, if anything is left to compile.

    Parameters
    ----------
    model : that is solved in the block
    """
    if compiled():
        yield
    elif _interpretable(model):
        _begun()
        with interpreted([loop for loop, _ in calls()]):
            yield
    else:
        beside = _begun() if (os.cpu_count() or 1) > 1 else None
        try:
            yield
        finally:
            if beside is not None:
                beside.terminate()
                beside.wait()


def _begun() -> subprocess.Popen[bytes] | None:
    """The other process, if there is a Python to begin it."""
    quiet = subprocess.DEVNULL
    command = [sys.executable, "-m", __name__]
    return subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet) if sys.executable else None


if __name__ == "__main__":
    compile_loops()
