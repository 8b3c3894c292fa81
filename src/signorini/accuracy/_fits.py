# SPDX-License-Identifier: BSD-3-Clause
"""Patches of cells around corners, polynomials that fit points in them, and what cells are away from these."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel


@kernel()
def cells_at_corners(cells: tuple[IntArray, IntArray], count: int) -> tuple[IntArray, IntArray]:
    """Where the cells of every corner begin (count + 1,), and these.

    Parameters
    ----------
    cells : where the corners of every cell begin (m + 1,), and these
    count : of corners
    """
    first, corners = cells
    starts = np.zeros(count + 1, np.int64)
    for v in corners:
        starts[v + 1] += 1
    for v in range(count):
        starts[v + 1] += starts[v]
    found, at = np.empty(len(corners), np.int64), starts[:-1].copy()
    for cell in range(len(first) - 1):
        for v in corners[first[cell] : first[cell + 1]]:
            found[at[v]] = cell
            at[v] += 1
    return starts, found


@kernel()
def wider_patches(
    cells: tuple[IntArray, IntArray],
    touching: tuple[IntArray, IntArray],
    patches: tuple[IntArray, IntArray],
    narrow: BoolArray,
) -> tuple[IntArray, IntArray]:
    """Patches of which some take those of all corners of the cells around, every cell once.

    Parameters
    ----------
    cells : where the corners of every cell begin (m + 1,), and these
    touching, patches : where the cells of every corner begin (n + 1,), and these: those that it is of, and its patch
    narrow : (n,) whether a patch becomes wider
    """
    first, corners = cells
    own_starts, own = touching
    old_starts, old = patches
    count = len(narrow)
    starts, seen = np.zeros(count + 1, np.int64), np.full(len(first) - 1, -1)
    found = np.empty(0, np.int64)
    for turn in range(2):  # counted, then kept
        at = 0
        for v in range(count):
            if not narrow[v]:
                for k in range(old_starts[v], old_starts[v + 1]):
                    if turn == 1:
                        found[at] = old[k]
                    at += 1
            else:
                for cell in own[own_starts[v] : own_starts[v + 1]]:
                    for w in corners[first[cell] : first[cell + 1]]:
                        for other in old[old_starts[w] : old_starts[w + 1]]:
                            if seen[other] != turn * count + v:
                                seen[other] = turn * count + v
                                if turn == 1:
                                    found[at] = other
                                at += 1
            starts[v + 1] = at
        if turn == 0:
            found = np.empty(at, np.int64)
    return starts, found


@kernel(nogil=True)
def fit(
    patches: tuple[IntArray, IntArray],
    points: tuple[IntArray, Array, Array],
    centres: Array,
    sizes: Array,
    regular: float,
    found: Array,
) -> None:
    """Polynomials that fit values at the points of the cells around corners by least squares, by Cholesky's factors.

    Monomials up to degree 1 or 2 of ``(x - centre) / size``, as many as are asked for.

    Parameters
    ----------
    patches : where the cells of every corner begin (n + 1,), and these
    points : where those of every cell begin (m + 1,), their places (p, d) length, and values (p, c)
    centres, sizes : (n, d) and (n,) of the patches, length
    regular : of the trace of a patch's normal equations, added to their diagonal
    found : (n, k, c) coefficients, set
    """
    starts, cells = patches
    first, places, values = points
    d, count, components = places.shape[1], found.shape[1], found.shape[2]
    basis, normal, right = np.ones(count), np.zeros((count, count)), np.zeros((count, components))
    for v in range(len(starts) - 1):
        normal[:], right[:], scale = 0.0, 0.0, 1.0 / sizes[v]
        for n in range(starts[v], starts[v + 1]):
            cell = cells[n]
            for p in range(first[cell], first[cell + 1]):
                for i in range(d):
                    basis[1 + i] = (places[p, i] - centres[v, i]) * scale
                if count > d + 1:
                    k = d + 1
                    for i in range(d):
                        for j in range(i, d):
                            basis[k] = basis[1 + i] * basis[1 + j]
                            k += 1
                for i in range(count):
                    for j in range(i + 1):
                        normal[i, j] += basis[i] * basis[j]
                    for c in range(components):
                        right[i, c] += basis[i] * values[p, c]
        trace = 0.0
        for i in range(count):
            trace += normal[i, i]
        for j in range(count):
            pivot = normal[j, j] + regular * trace
            for k in range(j):
                pivot -= normal[j, k] * normal[j, k]
            normal[j, j] = np.sqrt(pivot)
            for i in range(j + 1, count):
                for k in range(j):
                    normal[i, j] -= normal[i, k] * normal[j, k]
                normal[i, j] /= normal[j, j]
            for c in range(components):
                for k in range(j):
                    right[j, c] -= normal[j, k] * right[k, c]
                right[j, c] /= normal[j, j]
        for j in range(count - 1, -1, -1):
            for c in range(components):
                for k in range(j + 1, count):
                    right[j, c] -= normal[k, j] * right[k, c]
                right[j, c] /= normal[j, j]
        found[v] = right


@kernel(nogil=True)
def add_work(
    cells: tuple[IntArray, Array, Array],
    shapes: tuple[Array, Array],
    places: Array,
    fitted: tuple[Array, Array, Array],
    compliance: Array,
    found: Array,
) -> None:
    """Work of what stresses of the cells are away from polynomials around their corners, and of these.

    Parameters
    ----------
    cells : corners (m, a), stresses at the points where these are best (m, p, c), volumes (m, q)
    shapes : linear shape functions at the q places (q, a), and values there of what is given at the p points (q, p)
    places : (m, q, d) length
    fitted : centres (n, d), sizes (n,) and coefficients (n, k, c) of the corners
    compliance : (c, c)
    found : (m, 2) both works, added to
    """
    corners, stress, volumes = cells
    linear, own = shapes
    centres, sizes, coefficients = fitted
    d, count, components = places.shape[2], coefficients.shape[1], coefficients.shape[2]
    basis, smooth, difference = np.ones(count), np.zeros(components), np.zeros(components)
    for m in range(len(corners)):
        for q in range(places.shape[1]):
            smooth[:] = 0.0
            for a in range(corners.shape[1]):
                v = corners[m, a]
                for i in range(d):
                    basis[1 + i] = (places[m, q, i] - centres[v, i]) / sizes[v]
                if count > d + 1:
                    k = d + 1
                    for i in range(d):
                        for j in range(i, d):
                            basis[k] = basis[1 + i] * basis[1 + j]
                            k += 1
                for k in range(count):
                    share = linear[q, a] * basis[k]
                    for c in range(components):
                        smooth[c] += share * coefficients[v, k, c]
            for c in range(components):
                difference[c] = smooth[c]
                for p in range(stress.shape[1]):
                    difference[c] -= own[q, p] * stress[m, p, c]
            lost, whole = 0.0, 0.0
            for i in range(components):
                for j in range(components):
                    lost += compliance[i, j] * difference[i] * difference[j]
                    whole += compliance[i, j] * smooth[i] * smooth[j]
            found[m, 0] += volumes[m, q] * lost
            found[m, 1] += volumes[m, q] * whole
