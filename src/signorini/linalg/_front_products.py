# SPDX-License-Identifier: BSD-3-Clause
"""Products of displacements inside, from those of the interface, without any displacement: down the tree of fronts.

With E the displacements inside under those of the interface, ``E = [-K_ii^-1 K_ic; 1]``, and a symmetric matrix M of
the interface, entries of ``E M E^T`` are asked for where the matrix has entries. For the k unknowns that a front
eliminates and the r below them E is ``-L_kk^-T L_rk^T``: from the products P of those below, which are some of its
parent's, follow

    P_kr = -L_kk^-T L_rk^T P_rr,    P_kk = -P_kr L_rk L_kk^-1

as many operations as two factorisations take, however many displacements M is a sum over; far from the interface,
where few combinations are left, no more than substituting those back (see `_front_ranks`).
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array
from signorini.compilation import kernel, part
from signorini.linalg._blas import AS_STORED, FIRST_TRANSPOSED, Scratch, StoredMatrix, gemm, trsm
from signorini.linalg._front_ranks import LEAST_ROWS, PROBES, combinations, eliminate, fill, gather, take
from signorini.linalg._fronts import list_below, sizes
from signorini.linalg._graph import Elimination, Rows
from signorini.linalg.plan import Fronts

STRIP = 64  # columns of a symmetric product that are formed at a time


@kernel()
def deepest(fronts: Fronts) -> int:
    """Entries of all fronts from the interface to a leaf, where those are most.

    Parameters
    ----------
    fronts : of the plan
    """
    need, most = np.zeros(len(fronts.parent), np.int64), 0
    for t in range(len(fronts.parent) - 1, -1, -1):
        _, k, r = sizes(fronts, t)
        need[t] = (k + r) * max(k + r, PROBES) + (need[fronts.parent[t]] if fronts.parent[t] >= 0 else 0)
        most = max(most, need[t])
    return most


@kernel()
def products(fronts: Fronts, factor: Array, M: Array, pattern: Rows, elimination: Elimination, s: Scratch) -> bool:
    """Overwrite the data of a symmetric pattern by entries of ``E M E^T``: of both triangles in one, the other stays 0.

    False where the pattern has an entry outside of all fronts, where the factor has none.

    Parameters
    ----------
    fronts, factor : as factorised
    M : (m, m) symmetric, in the order of elimination
    pattern : entries where the matrix has some; the data are zero on entry
    elimination : the order
    s : of BLAS
    """
    inside, n = len(elimination.order) - len(M), len(elimination.order)
    room = np.empty(deepest(fronts))
    path, begin = np.empty(len(fronts.parent) + 1, np.int64), np.zeros(len(fronts.parent) + 2, np.int64)
    local, below, height = np.empty(n, np.int32), np.empty(n, np.int32), 0
    ranks, core = np.zeros(len(fronts.parent) + 2, np.int64), np.zeros((PROBES, PROBES))  # rank 0: all products
    widest = max(0, fronts.below.max()) if len(fronts.below) else 0
    probes = np.empty((PROBES, widest if widest >= LEAST_ROWS else 0))
    work = np.empty((2, *probes.shape))
    fill(probes)
    for t in range(len(fronts.parent) - 1, -1, -1):
        a, k, r = sizes(fronts, t)
        while height > 0 and path[height - 1] != fronts.parent[t]:
            height -= 1
        path[height], size = t, k + r
        begin[height + 1] = begin[height] + size * max(size, PROBES)
        P = room[begin[height] : begin[height + 1]]
        list_below(fronts, t, below)
        rank = 0
        if fronts.parent[t] < 0:
            for u in range(len(M)):
                local[inside + u] = u
            _gather(M.ravel(), len(M), local, below[:r], P, k)
        else:
            _number(fronts, fronts.parent[t], local)
            above, rank = room[begin[height - 1] : begin[height]], ranks[height]
            if rank > 0:
                gather(above, rank, local, below[:r], P, k)
            else:
                _, k_above, r_above = sizes(fronts, fronts.parent[t])
                _gather(above, k_above + r_above, local, below[:r], P, k)
        height += 1
        panel = factor.ctypes.data + 8 * fronts.panel[t]
        if rank == 0 and r >= LEAST_ROWS:
            rest = StoredMatrix(P.ctypes.data + 8 * k * (size + 1), size)
            rank = combinations(r, rest, probes, work, core, s)
            take(work, rank, k, r, P)
        ranks[height] = rank
        if r == 0:
            P[:] = 0.0
        elif rank > 0:
            eliminate(k, r, rank, panel, P.ctypes.data, s)
        else:
            _eliminate(k, r, panel, P.ctypes.data, s)
        _number(fronts, t, local)
        if not _write(pattern, elimination, (a, k), local, below[:r], P, core[:rank]):
            return False
    _write_interface(pattern, elimination, inside, M)
    return True


@part()
def _number(fronts: Fronts, t: int, local: Int32Array) -> None:
    """Write where the unknowns of front t stand in it."""
    a, k, _ = sizes(fronts, t)
    for j in range(k):
        local[a + j] = j
    at = k
    for p in range(fronts.begin[t], fronts.begin[t + 1]):
        for u in range(fronts.unknown[fronts.row[p]], fronts.unknown[fronts.row[p] + 1]):
            local[u] = at
            at += 1


@part()
def _gather(above: Array, size: int, local: Int32Array, below: Int32Array, P: Array, k: int) -> None:
    """Take the products of unknowns below a front from those of its parent, (size, size), upper triangle."""
    own = k + len(below)
    for c in range(len(below)):
        j = local[below[c]]
        for i in range(c + 1):
            row = local[below[i]]
            value = above[max(j, row) * size + min(j, row)]
            P[(k + c) * own + k + i] = value
            P[(k + i) * own + k + c] = value


@part()
def _eliminate(k: int, r: int, panel: int, P: int, s: Scratch) -> None:
    """Products of what a front eliminates, also with what is below it, from the address of its columns into P's."""
    size = k + r
    own, lower = StoredMatrix(panel, size), StoredMatrix(panel + 8 * k, size)
    mixed = StoredMatrix(P + 8 * k * size, size)
    rest = StoredMatrix(P + 8 * k * (size + 1), size)
    gemm(FIRST_TRANSPOSED, k, r, r, lower, rest, s.zero, mixed, s)
    trsm(s.left, s.transposed, k, r, own, mixed, s)
    for begin in range(0, k, STRIP):  # the upper triangle alone is read
        end = min(begin + STRIP, k)
        some, into = StoredMatrix(lower.begin + 8 * begin * size, size), StoredMatrix(P + 8 * begin * size, size)
        gemm(AS_STORED, end, end - begin, r, mixed, some, s.zero, into, s)
    for begin in range(0, k, STRIP):
        corner = 8 * begin * (size + 1)
        some, into = StoredMatrix(panel + corner, size), StoredMatrix(P + corner, size)
        trsm(s.right, s.plain, min(STRIP, k - begin), k - begin, some, into, s)


@part()
def _write(
    pattern: Rows,
    elimination: Elimination,
    own: tuple[int, int],
    local: Int32Array,
    below: Int32Array,
    P: Array,
    core: Array,
) -> bool:
    """Write entries of the rows of unknowns that a front eliminates, with all that go later; False if one is outside.

    ``own`` is the first unknown that it eliminates, and how many; ``core`` is of combinations, empty of products.
    """
    (indptr, indices, data), (order, place), (a, k) = pattern, elimination, own
    size, rank = k + len(below), len(core)
    known = np.empty(rank)
    for j in range(k):
        for c in range(rank):
            known[c] = 0.0
            for e in range(rank):
                known[c] += core[c, e] * P[j * rank + e]
        for p in range(indptr[order[a + j]], indptr[order[a + j] + 1]):
            i = place[indices[p]]
            if i < a + j:
                continue
            at = local[i]
            if i >= a + k and (at < k or at >= size or below[at - k] != i):
                return False
            share = 1.0 if i == a + j else 2.0
            if rank > 0:
                value = 0.0
                for c in range(rank):
                    value += known[c] * P[at * rank + c]
                data[p] = share * value
            else:
                data[p] = share * P[max(at, j) * size + min(at, j)]
    return True


@part()
def _write_interface(pattern: Rows, elimination: Elimination, inside: int, M: Array) -> None:
    """Write entries between unknowns of the interface."""
    (indptr, indices, data), (order, place) = pattern, elimination
    for u in range(len(M)):
        for p in range(indptr[order[inside + u]], indptr[order[inside + u] + 1]):
            v = place[indices[p]] - inside
            if v >= u:
                data[p] = M[u, v] if u == v else 2.0 * M[u, v]
