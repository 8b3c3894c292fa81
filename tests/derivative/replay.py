# SPDX-License-Identifier: BSD-3-Clause
"""Paths replayed as analytic functions of their data, for complex steps: they share no line with the derivatives."""

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


def replayed_in_space(points, A, R, ends, mu, facets):
    """The same in space on polygons with so many corners: all forces, motions and rigid motions in one system a piece.

    A (3n, 3n), motions and forces are found as (3, n).
    """
    n, k, half = len(mu), R.shape[1], np.pi / facets
    anchor, found = np.zeros((2, n), complex), []
    for point in points:
        first, last = ends[point.leg]
        law = np.zeros((3 * n, 6 * n), complex)  # of r and h
        told = np.zeros((3 * n, 2), complex)
        for j in range(n):
            rows = j, n + j, 2 * n + j
            left = point.states.tangent.left[j]
            if not point.states.tangent.closed[j]:
                law[rows, rows] = 1.0
                continue
            law[j, 3 * n + j] = 1.0
            angle = np.arctan2(point.r[2, j], point.r[1, j])
            if left == 2:
                for row, axis in zip(rows[1:], anchor, strict=True):
                    law[row, 3 * n + row], told[row, 0] = 1.0, axis[j]
            elif left == 1:
                along = point.states.tangent.tau[:, j]
                normal = along[1], -along[0]
                for row, part, way, held in zip(rows[1:], normal, along, anchor[:, j], strict=True):
                    law[n + j, row] += part
                    law[2 * n + j, 3 * n + row] += way
                    told[2 * n + j, 0] += way * held
                law[n + j, j] = -np.cos(half) * mu[j]
            else:
                corner = 2 * half * np.round(angle / (2 * half))
                for row, part in zip(rows[1:], (np.cos(corner), np.sin(corner)), strict=True):
                    law[row, row], law[row, j] = 1.0, -mu[j] * part
        matrix = np.block([[law, np.zeros((3 * n, k))], [A, -np.eye(3 * n), R], [R.T, np.zeros((k, 3 * n + k))]])
        loads = np.stack([first, last - first], axis=-1)
        solved = np.linalg.solve(matrix, np.concatenate([told, -loads]))
        r, h = solved[: 3 * n].reshape(3, n, 2), solved[3 * n : 6 * n].reshape(3, n, 2)
        part = complex(point.part)
        if point.at_event:
            event = point.event
            j, of_bound = event.pair, event.start * mu[event.pair]
            g = (
                event.gap * h[0, j]
                + (of_bound if event.start else event.pressure) * r[0, j]
                + event.friction @ r[1:, j]
            )
            part = -g[0] / g[1]
        here, push = h[..., 0] + part * h[..., 1], r[..., 0] + part * r[..., 1]
        anchor = here[1:]
        found.append((here, push, part))
    return found
