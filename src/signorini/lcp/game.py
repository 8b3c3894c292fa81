# SPDX-License-Identifier: BSD-3-Clause
"""The path of Lemke and Howson: equilibria of bimatrix games, on which Lemke's path with a positive d ends in a ray."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.lcp.lemke import Lemke, Path
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status
from signorini.lcp.tableau import Equilibrated, Tableau, equilibrate


@dataclass(frozen=True, kw_only=True)
class LemkeHowson:
    """Complementary pivoting on ``M = [[0, A], [B, 0]]`` with A, B > 0 and q < 0, where it always ends in a solution.

    With x and y of a solution, x / sum(x) and y / sum(y) are an equilibrium of the game in which the players pay A y
    and B x (for q = -1). Every pure strategy k of either player starts a path: k alone is played as much as the other
    player's best answer s asks, s as much as the best answer to it asks. From there complementarity is missed in k
    alone, by ``theta = w_k``, which is driven to 0 as Lemke's theta is, under ``d = -e_k``.

    Some of these paths are short and some enormous: ``starts`` of them are followed for ``n / 2 + 50`` pivots each,
    then, where none has ended, four times as far, and so on.

    Parameters
    ----------
    starts : strategies to start from, in the order of the variables
    rounds : how often the limit on the pivots is raised

    References
    ----------
    Lemke, Howson (1964), Equilibrium points of bimatrix games, SIAM Journal 12:413-423. Cottle, Pang, Stone (1992), The
    Linear Complementarity Problem, section 4.4 and algorithm 4.4.21.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> A, B = np.array([[1.0, 2.0], [3.0, 1.0]]), np.array([[2.0, 1.0], [1.0, 3.0]])
    >>> M = np.block([[np.zeros((2, 2)), A], [B, np.zeros((2, 2))]])
    >>> solve(M, -np.ones(4), method="lemke").status.name, solve(M, -np.ones(4), method=LemkeHowson()).status.name
    ('RAY_TERMINATION', 'SOLVED')
    """

    name: ClassVar[str] = "lemke-howson"
    matrices: ClassVar[str] = "bimatrix games, [[0, A], [B, 0]] with A, B > 0 and q < 0: always ends in a solution"

    starts: int = 10
    rounds: int = 8

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        M = problem.dense()
        first = None if M is None else first_player(M, problem.q)
        if M is None or first is None:
            note = "It needs M = [[0, A], [B, 0]], its variables in any order, with A, B > 0, and q < 0."
            return Attempt.refused(note)
        scaled = equilibrate(M, problem.q, *problem.sizes)
        limit, pivots = problem.n // 2 + 50, 0
        for path in range(self.rounds * self.starts):
            turn, start = divmod(path, self.starts)
            if start >= problem.n:
                continue
            attempt = _path_from(start, limit * 4**turn, first, problem, M, scaled, tolerance)
            pivots += attempt.iterations
            if attempt.z is not None and problem.residual(attempt.z).worst <= tolerance:
                break
        return replace(attempt, iterations=pivots)


def first_player(M: Array, q: Array) -> BoolArray | None:
    """(n,) mask of the variables of the player to whom variable 0 belongs; None where M and q are no bimatrix game.

    Examples
    --------
    >>> first_player(np.array([[0.0, 1.0], [2.0, 0.0]]), np.array([-1.0, -1.0]))
    array([ True, False])
    >>> first_player(np.array([[1.0, 1.0], [2.0, 0.0]]), np.array([-1.0, -1.0])) is None
    True
    """
    if M[0, 0] != 0 or not (q < 0).all():
        return None
    first = M[0] == 0
    other = ~first
    within = (M[np.ix_(first, first)], M[np.ix_(other, other)])
    across = (M[np.ix_(first, other)], M[np.ix_(other, first)])
    return first if other.any() and not any(map(np.any, within)) and all((m > 0).all() for m in across) else None


def _path_from(
    start: int, limit: int, first: BoolArray, problem: LCP, M: Array, scaled: Equilibrated, tolerance: float
) -> Attempt:
    """From the best answer to the best answer to a strategy along the path that misses complementarity in it alone."""
    n = problem.n
    tableau = Tableau(scaled.M, scaled.q, -(np.arange(n) == start).astype(float))
    own = np.flatnonzero(first == first[start])
    others = np.flatnonzero(first != first[start])
    answer = _last_to_be_met(tableau, start, others)
    tableau.pivot(answer, n + start)
    best = _last_to_be_met(tableau, answer, own)
    tableau.pivot(best, n + answer)
    path = Path(Lemke(max_pivots=limit), tableau, tolerance, problem, M, scaled, np.zeros(n, dtype=bool))
    if best == start:
        return path.ended(Status.SOLVED, "")
    path.largest_theta = float(tableau.rhs[start])
    tableau.pivot(start, 2 * n)
    return path.follow(n + best, "")


def _last_to_be_met(tableau: Tableau, strategy: int, rows: IntArray) -> int:
    """The row, of those given, whose w is the last to rise to 0 with z of the strategy; the last of ties."""
    ratios = tableau.rhs[rows] / tableau.column(tableau.n + strategy)[rows]
    # the last of tied rows leaves the others lexicographically positive
    return int(rows[np.flatnonzero(ratios >= ratios.max() * (1 - 1e-12))[-1]])
