# SPDX-License-Identifier: BSD-3-Clause
"""The smallest ball around points, in any dimension: amplitudes of shear in a plane and of deviators."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.compilation import kernel, part

_ROUNDS = 40  # walks per dimension: some ten are seen; what then is left is a ball that holds all, not the smallest
_OUTWARD = 1e-10  # of the size: rounding of a way, and of a direction in which a point neither comes nor goes
_DEPENDENT = 1e-20  # of the square of an edge: what is left of one that lies in the plane of others, squared
_NEGATIVE = 1e-12  # weights of points that are on the ball but do not hold it


@kernel()
def smallest_ball(points: Array) -> tuple[Array, float]:
    """Centre (d,) and radius of the smallest ball around points (n, d).

    From a ball around a first point its centre walks towards that of the points which it touches, until it touches
    another one or is there; then a point drops out that does not hold it, until all do.

    References
    ----------
    Fischer, Gaertner, Kutz (2003), Proc. ESA, LNCS 2832, 630.

    Examples
    --------
    >>> centre, radius = smallest_ball(np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [1.0, 0.0]]))
    >>> centre.tolist(), radius
    ([1.0, 0.0], 1.0)
    """
    d = points.shape[1]
    centre = points[0].copy()
    touching = np.zeros(d + 1, np.int64)
    touching[0] = _farthest(points, centre)
    count = 1
    size = np.sqrt(_square(points[touching[0]], centre))
    if size == 0.0:
        return centre, 0.0
    for _ in range(_ROUNDS * (d + 1)):
        goal, weights = _middle(points, touching[:count])
        stop, reached = -1, 1.0
        if count <= d:
            stop, reached = _first_touched(points, touching[:count], centre, goal, size)
        if stop >= 0:
            centre += reached * (goal - centre)
            touching[count] = stop
            count += 1
            continue
        centre = goal
        least = int(np.argmin(weights))
        if weights[least] >= -_NEGATIVE:
            break
        count -= 1
        touching[least] = touching[count]
    return centre, np.sqrt(_square(points[_farthest(points, centre)], centre))


@kernel()
def smallest_balls(paths: Array) -> tuple[Array, Array]:
    """Centres (n, d) and radii (n,) of the smallest balls around paths (n, t, d)."""
    n, _, d = paths.shape
    centres, radii = np.zeros((n, d)), np.zeros(n)
    for i in range(n):
        centres[i], radii[i] = smallest_ball(paths[i])
    return centres, radii


@part()
def _square(one: Array, other: Array) -> float:
    """Square of a distance."""
    total = 0.0
    for i in range(len(one)):
        total += (one[i] - other[i]) ** 2
    return total


@part()
def _farthest(points: Array, centre: Array) -> int:
    """The point that is farthest from a centre."""
    found, largest = 0, -1.0
    for i in range(len(points)):
        square = _square(points[i], centre)
        if square > largest:
            found, largest = i, square
    return found


@part()
def _middle(points: Array, touching: Array) -> tuple[Array, Array]:
    """The centre of the sphere through points, in their plane, and its weights: ``sum w p``, ``sum w = 1``."""
    first, count = points[touching[0]], len(touching) - 1
    middle, weights = first.copy(), np.zeros(count + 1)
    edges, gram = np.zeros((count, points.shape[1])), np.zeros((count, count))
    for i in range(count):
        edges[i] = points[touching[i + 1]] - first
    for i in range(count):
        for j in range(count):
            for k in range(points.shape[1]):
                gram[i, j] += edges[i, k] * edges[j, k]
    own = np.array([0.5 * gram[i, i] for i in range(count)])
    least = np.array([_DEPENDENT * gram[i, i] for i in range(count)])
    for i in range(count):  # Cholesky's elimination, without square roots
        if gram[i, i] <= least[i]:
            gram[i, i] = np.inf
        for j in range(i + 1, count):
            share = gram[j, i] / gram[i, i]
            for k in range(i, count):
                gram[j, k] -= share * gram[i, k]
            own[j] -= share * own[i]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            own[i] -= gram[i, k] * own[k]
        own[i] /= gram[i, i]
        middle += own[i] * edges[i]
        weights[i + 1] = own[i]
    weights[0] = 1.0 - own.sum()
    return middle, weights


@part()
def _first_touched(points: Array, touching: Array, centre: Array, goal: Array, size: float) -> tuple[int, float]:
    """The point that a ball touches first whose centre walks, and the part of the way; -1 where it touches none."""
    way, first = goal - centre, points[touching[0]]
    square, length = _square(first, centre), np.sqrt((way * way).sum())
    stop, reached = -1, 1.0
    if length <= _OUTWARD * size:
        return stop, reached
    for i in range(len(points)):
        outward = 0.0
        for k in range(len(way)):  # no array a point
            outward += way[k] * (first[k] - points[i, k])
        if outward <= _OUTWARD * length * size:
            continue
        known = False
        for own in touching:
            known = known or own == i
        if known:
            continue
        part = max(0.0, (square - _square(points[i], centre)) / (2.0 * outward))
        if part < reached:
            stop, reached = i, part
    return stop, reached
