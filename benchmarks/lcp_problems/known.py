# SPDX-License-Identifier: BSD-3-Clause
"""Named problems of the literature, with the answers printed there or worked out by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from benchmarks.lcp_problems.posed import PosedLCP
from signorini.arrays import Array

DEFINITE = ("P", "positive definite", "monotone", "symmetric", "copositive plus")


def known() -> list[PosedLCP]:
    """The problems in the order of their size."""
    return _tiny() + _cyclers() + [problem for n in (5, 20, 100) for problem in _exponential(n)] + _coulomb()


def _tiny() -> list[PosedLCP]:
    cps = "Cottle, Pang, Stone (1992)"
    return [
        _posed("one unknown, open", cps, [[2.0]], [3.0], [0.0], *DEFINITE, unique=True),
        _posed("one unknown, closed", cps, [[2.0]], [-4.0], [2.0], *DEFINITE, unique=True),
        _posed("one unknown, none", "w = -z - 1 < 0", [[-1.0]], [-1.0], None),
        _posed("one unknown, M = 0, none", "w = -1", [[0.0]], [-1.0], None, "monotone", "symmetric", "copositive plus"),
        _posed(
            "two unknowns",
            f"{cps}, 1.4",
            [[2.0, 1.0], [1.0, 2.0]],
            [-5.0, -6.0],
            [4 / 3, 7 / 3],
            *DEFINITE,
            unique=True,
        ),
        _posed(
            "copositive, not monotone",
            f"{cps}, section 3.8",
            [[1.0, 2.0], [2.0, 1.0]],
            [-1.0, -1.0],
            [1 / 3, 1 / 3],
            "symmetric",
            "copositive plus",
        ),
        _posed(
            "skew: a linear program",
            "max x, x <= 1",
            [[0.0, 1.0], [-1.0, 0.0]],
            [-1.0, 1.0],
            [1.0, 1.0],
            "monotone",
            "copositive plus",
            unique=True,
        ),
        _posed(
            "rank one, a line of solutions",
            "z_1 + z_2 = 1",
            [[1.0, 1.0], [1.0, 1.0]],
            [-1.0, -1.0],
            [0.5, 0.5],
            "monotone",
            "symmetric",
            "copositive plus",
        ),
        _posed(
            "bimatrix game",
            "QuantEcon documentation of lcp_lemke",
            [[1.0, 0, 0], [2, 1, 0], [2, 2, 1]],
            [-8.0, -12, -14],
            [8.0, 0, 0],
            "P",
            unique=True,
        ),
    ]


def _cyclers() -> list[PosedLCP]:
    kostreva = "Kostreva (1979), Opsearch 16:23-33"
    murty = "Murty (1988), Linear Complementarity, example 2.11"
    M = [[-1.5, 2.0], [-4.0, 4.0]]
    return [
        _posed(
            "Kostreva 1, cycles without tie breaking",
            kostreva,
            [[1.0, 2, 0], [0, 1, 2], [2, 0, 1]],
            [-1.0] * 3,
            [1 / 3] * 3,
            "P",
            unique=True,
        ),
        _posed("Kostreva 2, none", kostreva, [[1.0, -1, 3], [2, -1, 3], [-1, -2, 0]], [-1.0] * 3, None),
        _posed("Murty 2.11", murty, M, [-5.0, 17.0], [27.0, 22.75]),
    ]


def _exponential(n: int) -> list[PosedLCP]:
    U = np.eye(n) + 2 * np.triu(np.ones((n, n)), 1)
    e = np.eye(n)
    return [
        _posed(
            f"Murty's triangle, n = {n}",
            "Murty (1978), Math. Programming Study 7",
            U,
            -np.ones(n),
            e[-1],
            "P",
            unique=True,
        ),
        _posed(
            f"Fathi, n = {n}", "Fathi (1979), Math. Programming 17", U.T @ U, -np.ones(n), e[0], *DEFINITE, unique=True
        ),
    ]


def _coulomb() -> list[PosedLCP]:
    """One node with Coulomb friction, K = [[2, 1], [1, 2]]: one answer at mu = 1, three at mu = 3 and f_t = 2.5."""
    return [_one_node(1.0, 0.5, None), _one_node(3.0, 2.5, None)]


def _one_node(mu: float, f_t: float, answer: ArrayLike | None) -> PosedLCP:
    k, c, f_n = 2.0, 1.0, 1.0
    # gap = -u_n, u_t = s_plus - s_minus, N = f_n - k u_n - c u_t, p_t = -(f_t - c u_n - k u_t)
    plus, minus = k - mu * c, k + mu * c
    M = np.array([[k, -c, c], [mu * k - c, plus, -plus], [mu * k + c, -minus, minus]])
    q = np.array([f_n, mu * f_n - f_t, mu * f_n + f_t])
    return _posed(
        f"one Coulomb node, mu = {mu:g}",
        "Klarbring (1990), Ing. Archiv 60:529",
        M,
        q,
        answer,
        "contact",
        covering=[1.0, 1.0 + mu, 1.0 + mu],
        solvable=True,
    )


def _posed(
    name: str,
    source: str,
    M: Any,
    q: ArrayLike,
    answer: ArrayLike | None,
    *traits: str,
    unique: bool = False,
    covering: ArrayLike | None = None,
    solvable: bool | None = None,
) -> PosedLCP:
    return PosedLCP(
        name=name,
        source=source,
        M=np.asarray(M, dtype=float),
        q=np.asarray(q, dtype=float),
        answer=_maybe(answer),
        unique=unique,
        solvable=answer is not None if solvable is None else solvable,
        covering=_maybe(covering),
        traits=frozenset(traits),
    )


def _maybe(values: ArrayLike | None) -> Array | None:
    return None if values is None else np.asarray(values, dtype=float)
