# SPDX-License-Identifier: BSD-3-Clause
"""Random problems, each of a stated class, each with an answer chosen first."""

from __future__ import annotations

import numpy as np

from benchmarks.lcp_problems.posed import PosedLCP
from signorini.arrays import Array

MADE = "generated from a chosen answer"


def with_solution(M: Array, rng: np.random.Generator, *, zeros: float = 0.0) -> tuple[Array, Array]:
    """(q, z) such that z solves the problem of M and q: about half of z positive, a share of pairs (0, 0).

    Parameters
    ----------
    M : (n, n) array
    zeros : share of the indices with ``z_i = w_i = 0``
    """
    n = len(M)
    side, sizes = rng.permutation(n), rng.uniform(0.5, 2.0, n)
    both = round(zeros * n)
    half = both + (n - both) // 2
    z, w = np.zeros(n), np.zeros(n)
    z[side[both:half]], w[side[half:]] = sizes[side[both:half]], sizes[side[half:]]
    return w - M @ z, z


def random_p(n: int, rng: np.random.Generator) -> PosedLCP:
    """A P-matrix that is neither symmetric nor positive definite: strictly diagonally dominant by rows, rescaled."""
    M = rng.uniform(-1.0, 1.0, (n, n))
    np.fill_diagonal(M, 0.0)
    np.fill_diagonal(M, np.abs(M).sum(axis=1) * rng.uniform(1.05, 1.5, n) + 0.1)
    M = M * rng.uniform(0.2, 5.0, n)
    q, z = with_solution(M, rng)
    return PosedLCP(name=f"random P, n = {n}", source=MADE, M=M, q=q, answer=z, unique=True, traits=frozenset({"P"}))


def random_psd(n: int, rank: int, rng: np.random.Generator, *, skew: float = 0.0) -> PosedLCP:
    """``B B' + skew (C - C')`` with B of the given rank: monotone, symmetric where skew = 0, definite at full rank."""
    B, C = rng.standard_normal((n, rank)), rng.standard_normal((n, n))
    M = (B @ B.T + skew * (C - C.T)) / np.sqrt(n)
    q, z = with_solution(M, rng)
    definite = {"P", "positive definite"} if rank >= n else set()
    traits = frozenset({"monotone", "copositive plus", *definite, *({"symmetric"} if skew == 0 else set())})
    name = f"random PSD, n = {n}, rank {rank}, skew part {skew:g}"
    return PosedLCP(name=name, source=MADE, M=M, q=q, answer=z, unique=rank >= n, traits=traits)


def degenerate(n: int, rng: np.random.Generator, *, zeros: float = 0.5) -> PosedLCP:
    """Positive definite with a share of pairs ``z_i = w_i = 0``: ties everywhere."""
    B = rng.integers(-2, 3, (n, n)).astype(float)
    M = B @ B.T + np.eye(n)
    z = with_solution(M, rng, zeros=zeros)[1].round()
    w = np.where(z > 0, 0.0, rng.integers(0, 2, n))
    traits = frozenset({"P", "positive definite", "monotone", "symmetric", "copositive plus"})
    name = f"degenerate, n = {n}"
    return PosedLCP(name=name, source=MADE, M=M, q=w - M @ z, answer=z, unique=True, traits=traits)


def badly_scaled(n: int, rng: np.random.Generator, *, decades: float = 16.0) -> PosedLCP:
    """A positive definite problem whose rows and columns are multiplied by factors spread over the decades."""
    base = random_psd(n, n, rng, skew=0.3)
    assert isinstance(base.M, np.ndarray)
    assert base.answer is not None
    rows, columns = 10.0 ** rng.uniform(-decades / 2, decades / 2, (2, n))
    name = f"badly scaled over {decades:g} decades, n = {n}"
    M = rows[:, None] * base.M * columns
    z = base.answer / columns
    return PosedLCP(name=name, source=MADE, M=M, q=rows * base.q, answer=z, unique=True, traits=frozenset({"P"}))


def infeasible(n: int, rng: np.random.Generator) -> PosedLCP:
    """Monotone without any feasible point: ``y' M <= 0`` and ``y' q < 0`` for a y >= 0 (Farkas)."""
    y = np.zeros(n)
    y[rng.permutation(n)[: max(1, n // 3)]] = 1.0
    B = rng.standard_normal((n, n))
    B -= np.outer(y, y @ B) / (y @ y)
    M, q = B @ B.T, rng.standard_normal(n)
    q -= y * (y @ q + 1.0) / (y @ y)
    traits = frozenset({"monotone", "symmetric", "copositive plus"})
    return PosedLCP(
        name=f"infeasible, n = {n}", source="generated with a Farkas vector", M=M, q=q, solvable=False, traits=traits
    )


def bimatrix_game(n: int, rng: np.random.Generator) -> PosedLCP:
    """A game of two players, the first with n // 2 strategies; costs are whole numbers from 1 to 9: full of ties."""
    first = np.arange(n) < n // 2
    across = first[:, None] != first
    M, q = np.where(across, rng.integers(1, 10, (n, n)).astype(float), 0.0), -np.ones(n)
    return PosedLCP(name=f"bimatrix game, n = {n}", source="random costs", M=M, q=q, traits=frozenset({"game"}))
