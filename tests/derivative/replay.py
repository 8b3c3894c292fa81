# SPDX-License-Identifier: BSD-3-Clause
"""A path replayed as an analytic function of its data, for complex steps: it shares no line with the derivatives."""

import numpy as np

from signorini.law.states import OPEN, STICK


def replayed(points, A, R, ends, mu):
    """Motions and forces (2, n), scaled, and the part of the leg, at every point of a history in the plane.

    ``ends`` is what the equations see of the load at both ends of every leg, (2 n + k,); A (2n, 2n), mu (n,).
    """
    n, k = len(mu), R.shape[1]
    anchor, found = np.zeros(n, complex), []
    for i, point in enumerate(points):
        codes, (first, last) = point.states.codes, ends[point.leg]
        closed, stick, slips = codes != OPEN, codes == STICK, np.flatnonzero(codes > STICK)
        normal, tangential = np.flatnonzero(closed), n + np.flatnonzero(stick)
        rows = np.concatenate([normal, tangential])
        T = np.zeros((2 * n, len(rows)), complex)
        T[rows, np.arange(len(rows))] = 1.0
        for j in slips:
            T[n + j, np.searchsorted(normal, j)] = (1.0 if codes[j] % 2 == 0 else -1.0) * mu[j]
        m = len(rows)
        matrix = np.zeros((m + k, m + k), complex)
        matrix[:m, :m], matrix[:m, m:], matrix[m:, :m] = A[rows] @ T, R[rows], R.T @ T
        target = np.zeros(2 * n, complex)
        target[n:][stick] = anchor[stick]
        right = [np.concatenate([target[rows] - first[rows], -first[2 * n :]])]
        right.append(np.concatenate([(first - last)[rows], (first - last)[2 * n :]]))
        solved = np.linalg.solve(matrix, np.column_stack(right))
        r = (T @ solved[:m]).T
        h = (A @ r.T + R @ solved[m:]).T + np.array([first, last - first])[:, : 2 * n]
        part = complex(point.part)
        if point.at_event:
            pair, kind = condition(point, mu)
            part = -kind(h[0], r[0], pair) / kind(h[1], r[1], pair)
        here, push = h[0] + part * h[1], r[0] + part * r[1]
        following = points[i + 1].states.codes if i + 1 < len(points) else codes
        begins = (following == STICK) & ~stick
        anchor = np.where(begins, here[n:], anchor)
        found.append((here.reshape(2, n), push.reshape(2, n), part))
    return found


def condition(point, mu):
    """The pair whose event ends a piece, and what vanishes there, from how its state changes."""
    n, event = len(mu), point.event
    pair = event.pair
    if event.gap:
        return pair, lambda h, _, k: h[k]
    if not event.friction:
        return pair, lambda _, r, k: r[k]
    sign = -event.friction
    return pair, lambda _, r, k: mu[k] * r[k] - sign * r[n + k]
