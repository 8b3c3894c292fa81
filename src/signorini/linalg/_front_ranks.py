# SPDX-License-Identifier: BSD-3-Clause
"""Products of displacements of low rank, in fronts far from the interface: a few columns go down the tree then.

What is smooth far from where it acts is a combination of few fields there: of products P_rr of the unknowns below a
front, thousands near a contact, a dozen combinations are left to rounding. With Q those, found from what P makes of
random columns, and C what they have of P,

    P_rr = Q C Q^T,    Q_k = -L_kk^-T L_rk^T Q_r,

and so on in all fronts behind, each as often as one of the displacements is substituted back.

References
----------
Halko, Martinsson, Tropp (2011), Finding structure with randomness, SIAM Review 53:217.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array
from signorini.compilation import part
from signorini.linalg._blas import AS_STORED, Scratch, StoredMatrix, gemm, trsm

PROBES = 32  # random columns that products are asked for
MOST_RANK = 26  # combinations: as many fewer than probes as make sure that no direction was missed
LEAST_ROWS = 4 * PROBES  # below a front: with fewer it takes as long to ask as is gained
_RANK_TOL = 1e-14  # of what products make of a random column: what is left of others is rounding


@part()
def fill(probes: Array) -> None:
    """Write numbers from -1 to 1 that look random and are always the same."""
    state = 1
    for c in range(probes.shape[0]):
        for i in range(probes.shape[1]):
            state = (1103515245 * state + 12345) % 2147483648
            probes[c, i] = state / 1073741824.0 - 1.0


@part()
def combinations(r: int, rest: StoredMatrix, probes: Array, work: Array, core: Array, s: Scratch) -> int:
    """How many combinations symmetric products (r, r) have, up to rounding; 0 where they are more than `MOST_RANK`.

    Parameters
    ----------
    r, rest : size and products
    probes : (PROBES, width) random numbers
    work : (2, PROBES, width) is overwritten, first by the combinations, orthonormal rows
    core : (PROBES, PROBES) is overwritten by what they have of the products
    s : of BLAS
    """
    width, some, seen = probes.shape[1], work[0], work[1]
    columns, made = StoredMatrix(some.ctypes.data, width), StoredMatrix(seen.ctypes.data, width)
    gemm(AS_STORED, r, PROBES, r, rest, StoredMatrix(probes.ctypes.data, width), s.zero, columns, s)
    rank = _orthonormal(some, r)
    if rank > MOST_RANK:
        return 0
    if rank > 0:
        gemm(AS_STORED, r, rank, r, rest, columns, s.zero, made, s)
    for c in range(rank):
        for e in range(c + 1):
            one = np.dot(some[c, :r], seen[e, :r])
            core[c, e] = core[e, c] = -0.5 * (one + np.dot(some[e, :r], seen[c, :r]))
    return rank


@part()
def _orthonormal(some: Array, r: int) -> int:
    """Overwrite the first of rows (PROBES, r) by orthonormal ones that span them all, and tell how many they are."""
    first = 0.0
    for q in range(PROBES):
        best, most = q, 0.0
        for c in range(q, PROBES):
            size = np.dot(some[c, :r], some[c, :r])
            if size > most:
                best, most = c, size
        if q == 0:
            first = most
        if most <= _RANK_TOL * _RANK_TOL * first:
            return q
        for i in range(r):
            some[q, i], some[best, i] = some[best, i], some[q, i]
        for _ in range(2):  # what is left of small rows is not orthogonal to those before otherwise
            some[q, :r] /= np.sqrt(np.dot(some[q, :r], some[q, :r]))
            for c in range(q):
                some[q, :r] -= np.dot(some[c, :r], some[q, :r]) * some[c, :r]
        some[q, :r] /= np.sqrt(np.dot(some[q, :r], some[q, :r]))
        for c in range(q + 1, PROBES):
            some[c, :r] -= np.dot(some[q, :r], some[c, :r]) * some[q, :r]
    return PROBES


@part()
def take(work: Array, rank: int, k: int, r: int, P: Array) -> None:
    """Write combinations as the columns (rank, k + r) of a front, those of the unknowns below it.

    Parameters
    ----------
    work, rank : as `combinations` leaves them
    k, r : unknowns that the front eliminates, and those below it
    P : numbers of the front
    """
    for i in range(r):
        for c in range(rank):
            P[(k + i) * rank + c] = work[0, c, i]


@part()
def gather(above: Array, rank: int, local: Int32Array, below: Int32Array, P: Array, k: int) -> None:
    """Take those of unknowns below a front from its parent's.

    Parameters
    ----------
    above, rank : numbers of the parent, (rank, unknowns) by columns
    local : where unknowns stand in the parent
    below, P, k : unknowns below the front, its numbers, and how many unknowns it eliminates
    """
    for i in range(len(below)):
        start = local[below[i]] * rank
        for c in range(rank):
            P[(k + i) * rank + c] = above[start + c]


@part()
def eliminate(k: int, r: int, rank: int, panel: int, P: int, s: Scratch) -> None:
    """Combinations at what a front eliminates, from those below it.

    Parameters
    ----------
    k, r, rank : unknowns that the front eliminates, those below it, and combinations
    panel, P : addresses of its columns of the factor, and of its numbers
    s : of BLAS
    """
    size = k + r
    mixed, rest = StoredMatrix(P, rank), StoredMatrix(P + 8 * rank * k, rank)
    gemm(AS_STORED, rank, k, r, rest, StoredMatrix(panel + 8 * k, size), s.zero, mixed, s)
    trsm(s.right, s.plain, rank, k, StoredMatrix(panel, size), mixed, s)
