# SPDX-License-Identifier: BSD-3-Clause
"""Lemke's complementary pivoting method, the one that always ends: a solution, a ray, or a breakdown named so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.lcp.active import polish
from signorini.lcp.delayed import DOUBT, RAY, SOLVED, Tolerances
from signorini.lcp.linear import factorised
from signorini.lcp.problem import LCP, read_vector
from signorini.lcp.solution import Attempt, Ray, Status
from signorini.lcp.tableau import Equilibrated, Tableau, equilibrate
from signorini.short import Short

NOISE = 1e-14  # of the largest basic variable: less is rounding
HIDDEN_TIE = 1e-6  # of its largest value: theta below it at the end of a path may be 0, hidden by a tie

AS_NEAR_AS_ROUNDING = (
    "A problem so near is solved by the candidate, and rounding in M and q may be as large: neither a solution nor a "
    "ray. Ask for a looser tolerance, or give more accurate data."
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Lemke(Short):
    """Follow the solutions of ``w = M z + q + theta d`` from a large theta down to theta = 0.

    One of w_i, z_i is 0 for every i all along; the complement of the variable that left enters next. Ties in the ratio
    test are broken lexicographically, which excludes cycling, except that theta leaves first where it can: in
    frictional contact the textbook choice runs along pairs of multipliers that rise together, into a spurious ray.

    Parameters
    ----------
    covering : (n,) d >= 0, positive where q < 0; None stands for 1 in the equilibrated rows
    max_pivots : limit, None stands for ``100 n + 1000``
    pivot_tolerance : entries of the equilibrated tableau below it, relative to their column, are not pivoted on
    tie_tolerance : ratios closer than it, relative to the size of the basic variables, are ties
    check_every : pivots between two looks at the rounding error of the tableau, which is refactored where it drifts

    Notes
    -----
    Rows and columns are equilibrated by powers of two, which leaves the path what it is. With ``z0`` the path starts
    from the basis of its positive components. The ray of a path that ends in one is returned. Where theta is near 0
    there, the end is polished and tested first, since it may be a solution hidden by a tie; one that misses the
    tolerance is a ``BREAKDOWN``: a problem so near is solved, and rounding in the data may be as large.

    References
    ----------
    Cottle, Pang, Stone (1992), The Linear Complementarity Problem, algorithms 4.4.5 and 4.9.3 (lexicographic).

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> solve([[2.0, 1.0], [0.0, 2.0]], [-1.0, -2.0], method=Lemke()).z.round(12)
    array([0., 1.])
    """

    name: ClassVar[str] = "lemke"
    matrices: ClassVar[str] = "any; ends in a solution where M is copositive plus, P0 or semimonotone and one exists"

    covering: ArrayLike | None = None
    max_pivots: int | None = None
    pivot_tolerance: float = 1e-11
    tie_tolerance: float = 1e-12
    check_every: int = 64

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        M = problem.dense()
        if M is None:
            return Attempt.refused("Lemke needs the entries of M.")
        scaled = equilibrate(M, problem.q, *problem.sizes)
        d = np.ones(problem.n) if self.covering is None else scaled.rows * self._covering(problem)
        basis: BoolArray = np.zeros(problem.n, dtype=bool) if z0 is None else z0 > 0
        turned = principal_transform(scaled.M, scaled.q, basis)
        note = "" if turned is not None else "The basis of z0 is singular: started from z = 0."
        if turned is None:
            basis[:] = False
        tableau = Tableau(*(turned or (scaled.M, scaled.q)), _normed(d))
        path = Path(self, tableau, tolerance, problem, M, scaled, basis)
        if (tableau.rhs >= 0).all():
            return path.ended(Status.SOLVED, note)
        return path.follow(path.first_pivot(), note)

    def _covering(self, problem: LCP) -> Array:
        d = read_vector(self.covering, "covering", problem.n) if self.covering is not None else np.ones(problem.n)
        bad = np.flatnonzero((d < 0) | ((d == 0) & (problem.q < 0)))
        if len(bad):
            raise InputError(
                f"is {d[bad[0]]} in row {bad[0]}; expected d >= 0, and d > 0 where q < 0", where=("covering",)
            )
        return d


class Path:
    """One run: the tableau and what is needed to judge where it stands.

    Attributes
    ----------
    tableau : of the equilibrated problem, z_i and w_i exchanged where ``basis``
    largest_theta : what theta is compared with
    pivots : so far
    """

    def __init__(
        self,
        options: Lemke,
        tableau: Tableau,
        tolerance: float,
        problem: LCP,
        M: Array,
        scaled: Equilibrated,
        basis: BoolArray,
    ) -> None:
        self.options, self.tableau, self.tolerance, self.basis = options, tableau, tolerance, basis
        self.problem, self.M, self.scaled = problem, M, scaled
        self.pivots = 0
        self.largest_theta = 0.0
        self.confirmed: Array | None = None

    def follow(self, entering: int, note: str) -> Attempt:
        """From a basis with theta in it, and the variable that enters, to a solution, a ray or the limit."""
        tableau, n = self.tableau, self.tableau.n
        limit = self.options.max_pivots or 100 * n + 1000
        theta_stays, checked = False, 0
        while self.pivots < limit:
            if self.pivots - checked >= self.options.check_every:
                checked = self.pivots
                if not self._sound():
                    return self.ended(Status.BREAKDOWN, note)
            tolerances = Tolerances(self.options.pivot_tolerance, self.options.tie_tolerance, self.largest_theta)
            reason, entering, row, pivots = tableau.walk(
                entering, limit - self.pivots, tolerances, theta_stays=theta_stays
            )
            self.pivots += pivots
            if reason == RAY:
                return self._at_ray(entering, note)
            if reason == SOLVED or (reason == DOUBT and self._would_solve(entering, row)):
                return self.ended(Status.SOLVED, note)
            theta_stays = reason == DOUBT
        return self.ended(Status.MAX_ITERATIONS, note)

    def first_pivot(self) -> int:
        """Bring theta in, where q / d is least, the last row in ties (the lexicographic rule); what enters next."""
        tableau, n = self.tableau, self.tableau.n
        first = np.flatnonzero(tableau.d > 0)
        ratios = tableau.q[first] / tableau.d[first]
        least = float(ratios.min())
        self.largest_theta = -least
        row = first[np.flatnonzero(ratios <= least - self.options.tie_tolerance * least)[-1]]
        self.pivots = 1
        return tableau.pivot(int(row), 2 * n) + n

    def _sound(self) -> bool:
        """Refactor where rounding shows; False where that does not help."""
        drift = self.tableau.drift()
        return bool(drift <= 1e-10) or (bool(np.isfinite(drift)) and self.tableau.refresh())

    def _would_solve(self, entering: int, row: int) -> bool:
        """Whether the basis with theta gone is a solution, or theta is tied only within the tolerance."""
        tableau = self.tableau
        basic = tableau.basic.copy()
        basic[row] = entering
        column = tableau.column(entering)
        step = max(float(tableau.rhs[row]), 0.0) / float(column[row])
        values = tableau.rhs - step * column
        values[row] = step
        z, worst = self._polished(basic, values)
        self.confirmed = z if worst <= self.tolerance else None
        return self.confirmed is not None

    def _z_of(self, basic: IntArray, values: Array) -> Array:
        """z of the problem as posed, from values of basic variables of the turned, scaled problem."""
        n = self.tableau.n
        x = np.zeros(2 * n + 1)
        x[basic] = values
        return self.scaled.back(np.where(self.basis, x[:n], x[n:-1]))

    def _polished(self, basic: IntArray, values: Array) -> tuple[Array, float]:
        """The values of the basic variables, or the basis solved for anew where that is better."""
        n = self.tableau.n
        z = self._z_of(basic, np.where(values > NOISE * np.abs(values).max(), values, 0.0))
        is_basic = np.zeros(2 * n + 1, dtype=bool)
        is_basic[basic] = True
        return polish(self.problem, self.M, z, active=np.where(self.basis, is_basic[:n], is_basic[n:-1]))

    def _at_ray(self, entering: int, note: str) -> Attempt:
        """Test the end of the path for a solution hidden by a tie, then report the ray."""
        tableau = self.tableau
        if not np.isfinite(tableau.rhs).all():
            return self.ended(Status.NONFINITE, note)
        theta = tableau.values()[2]
        candidate = self._z_of(tableau.basic, np.maximum(tableau.rhs, 0.0))
        share = theta / self.largest_theta
        if share <= HIDDEN_TIE:
            candidate, worst = self._polished(tableau.basic, tableau.rhs)
            solved = worst <= self.tolerance
            said = "polished." if solved else f"{share:.1e} of its largest value. {AS_NEAR_AS_ROUNDING}"
            ending = Status.SOLVED if solved else Status.BREAKDOWN
            note = f"{note} The path ended in a tie near theta = 0: {said}".strip()
            return Attempt(z=candidate, ending=ending, iterations=self.pivots, note=note)
        direction = np.zeros(2 * tableau.n + 1)
        direction[tableau.basic] = -tableau.column(entering)
        direction[entering] = 1.0
        basic = np.arange(2 * tableau.n + 1)
        ray = Ray(
            point=candidate,
            direction=self._z_of(basic, direction),
            covering=self._covering(),
            theta=theta / self.scaled.unit,
            slope=float(direction[-1]) / self.scaled.unit,
        )
        note = f"{note} theta is {share:.1e} of its largest value at the ray.".strip()
        return Attempt(z=candidate, ending=Status.RAY_TERMINATION, iterations=self.pivots, note=note, ray=ray)

    def _covering(self) -> Array:
        """The covering vector in the rows of the problem as posed (of the turned problem, after a warm start)."""
        d, swapped = self.tableau.d, self.basis
        return (np.where(swapped, 0.0, d) - self.scaled.M[:, swapped] @ d[swapped]) / self.scaled.rows

    def ended(self, ending: Status, note: str) -> Attempt:
        """The candidate of the present basis, solved for anew on the problem as posed."""
        rhs = self.tableau.rhs
        if not np.isfinite(rhs).all():
            return Attempt(z=None, ending=Status.NONFINITE, iterations=self.pivots, note=note)
        z = self._polished(self.tableau.basic, rhs)[0] if self.confirmed is None else self.confirmed
        return Attempt(z=z, ending=ending, iterations=self.pivots, note=note)


def _normed(d: Array) -> Array:
    """d with a largest entry near 1, by a power of two: the path does not depend on its length."""
    return d / float(np.exp2(np.round(np.log2(d.max()))))


def principal_transform(M: Array, q: Array, swapped: BoolArray) -> tuple[Array, Array] | None:
    """(M', q') of the LCP in which z_i and w_i are exchanged where ``swapped``; None where that block is singular.

    Examples
    --------
    >>> M, q = principal_transform(np.array([[2.0]]), np.array([-4.0]), np.array([True]))
    >>> float(M[0, 0]), float(q[0])
    (0.5, 2.0)
    """
    A, B = np.flatnonzero(swapped), np.flatnonzero(~swapped)
    if not len(A):
        return M, q
    solved = factorised(M[np.ix_(A, A)])
    if solved is None:
        return None
    inverse = solved(np.eye(len(A)))
    turned, vector = np.empty_like(M), np.empty_like(q)
    coupling = M[np.ix_(B, A)] @ inverse
    turned[np.ix_(A, A)] = inverse
    turned[np.ix_(A, B)] = -inverse @ M[np.ix_(A, B)]
    turned[np.ix_(B, A)] = coupling
    turned[np.ix_(B, B)] = M[np.ix_(B, B)] - coupling @ M[np.ix_(A, B)]
    vector[A], vector[B] = -inverse @ q[A], q[B] - coupling @ q[A]
    return turned, vector
