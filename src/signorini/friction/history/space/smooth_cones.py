# SPDX-License-Identifier: BSD-3-Clause
"""Complementarity of numbers, and of motions and forces of pairs in Coulomb's law on a smooth cone.

With ``w = M x + q`` a mixed problem::

    0 <= x_i  _|_  w_i >= 0                                       of numbers
    (x, w) motion and force of a pair that obey Coulomb's law     of pairs, three rows each

What pairs that touch without pressure do next is such a law: the cone is homogeneous, so that rates obey it as motions
do. With ``y = w - x`` both are one equation, ``P(y) - M (P(y) - y) = q``, where P keeps what is positive of a number
and projects a pair (see `law`), piecewise smooth: Newton's method, from the answer on a polygon for instance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini import lcp
from signorini.arrays import Array, BoolArray
from signorini.law.section import FrictionSection

_SIDES = (8, 12)  # of the polygons whose answers Newton's method starts from
_NEWTON_STEPS = 30  # of one run from one start
_SOLVED = 1e-11  # of the data: what a solution may lack
_PULLS = 1e-10  # of the data: a normal force of a pair that must stay closed, below zero


@dataclass(frozen=True, kw_only=True, eq=False)
class ConeProblem:
    """Numbers first, then normals, first and second tangents of m pairs.

    Attributes
    ----------
    M, q : (N + 3m, N + 3m) and (N + 3m,)
    friction : (2, m) half-axes of the section at a normal force of 1, > 0
    closed : (m,) pairs that may not open

    Examples
    --------
    One pair, pressed by 1 and pulled by 1 along its second tangent, slips:

    >>> problem = ConeProblem(
    ...     M=np.eye(3), q=np.array([1.0, 0.0, -1.0]), friction=np.full((2, 1), 0.4), closed=np.array([False])
    ... )
    >>> x = problem.newton(problem.q)
    >>> x.round(12).tolist(), problem.w(x).round(12).tolist()
    ([0.0, 0.0, 0.6], [1.0, 0.0, -0.4])
    """

    M: Array
    q: Array
    friction: Array
    closed: BoolArray

    @property
    def numbers(self) -> int:
        """N."""
        return len(self.q) - 3 * len(self.closed)

    @property
    def unit(self) -> float:
        """Size of the data."""
        return float(np.abs(self.q).max(initial=0.0)) or 1.0

    def w(self, x: Array) -> Array:
        """(N + 3m,) What x is complementary to."""
        return np.asarray(self.M @ x + self.q)

    def obeyed(self, y: Array) -> tuple[Array, Array]:
        """(N + 3m,) The w of a y that obeys the law, and its derivative."""
        N, m = self.numbers, len(self.closed)
        w, slope = np.maximum(y, 0.0), np.diag((y > 0.0).astype(np.float64))
        pressed = np.maximum(y[N : N + m], 0.0)
        found = FrictionSection(axes=self.friction, sides=np.zeros(m, dtype=np.int64)).project(
            y[N + m :].reshape(2, m), pressed
        )
        w[N + m :], left = found.r.ravel(), found.left
        normal, along = N + np.arange(m), N + m * np.arange(1, 3)[:, None] + np.arange(m)
        w[normal[self.closed]], slope[normal[self.closed], normal[self.closed]] = y[normal[self.closed]], 1.0
        slope[along, along] = 0.0
        share = np.divide(w[along], pressed, out=np.zeros((2, m)), where=pressed > 0.0)
        slips, across = (pressed > 0.0) & (left == 1), found.slope
        for i in range(2):
            for j in range(2):
                slope[along[i], along[j]] = across[i, j]
            slope[along[i], normal] = np.where(slips, share[i] - (across[i] * share).sum(axis=0), 0.0)
        return w, slope

    def lacking(self, x: Array) -> Array:
        """(N + m,) How far each number, and each pair, is from its law."""
        N, w = self.numbers, self.w(x)
        off = np.abs(self.obeyed(w - x)[0] - w)
        return np.concatenate([off[:N], np.linalg.norm(off[N:].reshape(3, -1), axis=0)])

    def newton(self, y: Array) -> Array | None:
        """A solution x, by Newton's method from a y; None where it finds none."""
        unit = self.unit
        for _ in range(_NEWTON_STEPS):
            w, slope = self.obeyed(y)
            off = w - self.M @ (w - y) - self.q
            if np.abs(off).max(initial=0.0) <= _SOLVED * unit:
                pulls = self.closed & (y[self.numbers : self.numbers + len(self.closed)] < -_PULLS * unit)
                return None if pulls.any() else w - y
            try:
                y = y - np.linalg.solve(slope - self.M @ (slope - np.eye(len(y))), off)
            except np.linalg.LinAlgError:
                return None
            if not np.isfinite(y).all():
                return None
        return None

    def found(self) -> Array | None:
        """A solution x by Newton's method, from polygons, or all pairs sticking or open; None where it finds none."""
        N, m = self.numbers, len(self.closed)
        for sides in _SIDES:
            x = self._on_polygons(sides)
            x = None if x is None else self.newton(self.w(x) - x)
            if x is not None:
                return x
        still = np.zeros_like(self.q)
        far = np.concatenate([self.q[:N], np.full(m, -self.unit), np.zeros(2 * m)])
        for y in (self.w(still), far):
            x = self.newton(y)
            if x is not None:
                return x
        return None

    def _on_polygons(self, sides: int) -> Array | None:
        """An x that obeys the law with polygons around the sections, by Lemke's method; None where that finds none."""
        N, m = self.numbers, len(self.closed)
        angle = (np.arange(sides) + 0.5) * (2.0 * np.pi / sides)
        size = N + m + m * sides
        moves, asks = np.zeros((len(self.q), size)), np.zeros((size, len(self.q)))
        one = np.arange(N + m)
        moves[one, one] = asks[one, one] = 1.0
        for k in range(m):
            at = N + m + k * sides + np.arange(sides)
            for i, share in enumerate((np.cos(angle), np.sin(angle))):
                normal = share / self.friction[i, k]
                moves[N + (1 + i) * m + k, at] = asks[at, N + (1 + i) * m + k] = -normal
            asks[at, N + k] = 1.0
        may = np.concatenate([np.ones(N, dtype=np.bool_), ~self.closed, np.ones(m * sides, dtype=np.bool_)])
        M = (asks @ self.M @ moves)[np.ix_(may, may)]
        answer = lcp.solve(M, (asks @ self.q)[may] / self.unit, method="lemke")
        return None if answer.z is None else np.asarray(moves[:, may] @ answer.z * self.unit)
