# SPDX-License-Identifier: BSD-3-Clause
"""The chain of methods to try for a problem of given structure and size."""

from __future__ import annotations

import numpy as np
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.lcp.block import BlockPivoting
from signorini.lcp.classes import is_symmetric
from signorini.lcp.enumeration import Enumeration
from signorini.lcp.feasibility import Feasibility
from signorini.lcp.game import LemkeHowson, first_player
from signorini.lcp.interior import InteriorPoint
from signorini.lcp.lemke import Lemke
from signorini.lcp.mprgp import MPRGP
from signorini.lcp.multigrid import ProjectedMultigrid
from signorini.lcp.newton import SemismoothNewton
from signorini.lcp.problem import LCP
from signorini.lcp.relaxation import ProjectedSOR
from signorini.lcp.solution import Method

DENSE_SIZE = 60  # unknowns up to which a sparse matrix is treated as a dense one
LEMKE_SIZE = 1500  # unknowns up to which Lemke's method is as fast as a few factorisations, and tried first
TABLEAU_SIZE = 5000  # unknowns from which a dense tableau is the last resort
ENUMERATION_SIZE = 12  # unknowns up to which all supports are tried in milliseconds


def methods_for(problem: LCP) -> list[Method]:
    """The chain of ``method="auto"``.

    Bimatrix games: Lemke and Howson's path, which always ends in a solution. Dense: Lemke first, which ends by itself,
    to n = 1500, and to n = 5000 where M looks like frictional contact, whose bases are often singular; otherwise block
    pivoting first (a few factorisations where it works); then Newton and interior point. Large, sparse and symmetric:
    multigrid and MPRGP first. An operator: MPRGP, the only one that needs products alone. A Lemke path with another
    covering vector closes the chain; behind it enumeration to n = 12, or one linear programme that may prove that there
    is no solution.

    Examples
    --------
    >>> from signorini.lcp.problem import read_problem
    >>> [method.name for method in methods_for(read_problem(np.eye(100), np.ones(100)))]
    ['lemke', 'block-pivoting', 'newton', 'interior-point', 'lemke', 'feasibility']
    >>> [method.name for method in methods_for(read_problem(np.eye(2000), np.ones(2000)))]
    ['block-pivoting', 'newton', 'lemke', 'interior-point', 'lemke']
    """
    if isinstance(problem.M, LinearOperator):
        return [MPRGP()]
    direct: list[Method] = [BlockPivoting(max_steps=40), SemismoothNewton(max_steps=60)]
    other = np.random.default_rng(0).uniform(1.0, 2.0, problem.n) * problem.sizes[0]
    others: list[Method] = [InteriorPoint(), Lemke(covering=other)]
    if isinstance(problem.M, np.ndarray) or problem.n <= DENSE_SIZE:
        last: list[Method] = [Enumeration() if problem.n <= ENUMERATION_SIZE else Feasibility()]
        if (M := problem.dense()) is not None and first_player(M, problem.q) is not None:
            return [LemkeHowson(), *direct, *others, *last]
        if problem.n <= LEMKE_SIZE or (problem.n <= TABLEAU_SIZE and looks_like_friction(problem.M)):
            return [Lemke(max_pivots=10 * problem.n + 1000), *direct, *others, *last]
        return [*direct, Lemke(), *others]
    positive = bool((problem.M.diagonal() > 0).all())
    if positive and problem.n > TABLEAU_SIZE and is_symmetric(problem.M):
        return [ProjectedMultigrid(), MPRGP(), *direct, InteriorPoint()]
    sweeps: list[Method] = [ProjectedSOR()] if positive and problem.n > TABLEAU_SIZE else []
    return [*direct, InteriorPoint(), *sweeps, *([Lemke(), *others] if problem.n <= TABLEAU_SIZE else [])]


def looks_like_friction(M: Array) -> bool:
    """Whether there is a zero on the diagonal, or two columns are opposite: multipliers of slip either way. Cost: n^2.

    Examples
    --------
    >>> looks_like_friction(np.array([[3.0, 1.0, -1.0], [1.0, 2.0, -2.0], [0.0, -2.0, 2.0]]))
    True
    >>> looks_like_friction(np.array([[3.0, 1.0], [1.0, 2.0]]))
    False
    """
    if not np.diag(M).all():
        return True
    sums = np.random.default_rng(0).uniform(1.0, 2.0, len(M)) @ M
    sums = sums[np.argsort(np.abs(sums))]
    return bool((np.abs(sums[1:] + sums[:-1]) <= 1e-10 * np.abs(sums[1:])).any())
