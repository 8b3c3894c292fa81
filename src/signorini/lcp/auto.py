# SPDX-License-Identifier: BSD-3-Clause
"""Which methods to try, in which order, for a problem of given structure and size."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from signorini.lcp.block import BlockPivoting
from signorini.lcp.classes import is_symmetric
from signorini.lcp.enumeration import Enumeration
from signorini.lcp.interior import InteriorPoint
from signorini.lcp.lemke import Lemke
from signorini.lcp.method import Method
from signorini.lcp.mprgp import MPRGP
from signorini.lcp.multigrid import ProjectedMultigrid
from signorini.lcp.newton import SemismoothNewton
from signorini.lcp.problem import LCP
from signorini.lcp.relaxation import ProjectedSOR

SMALL = 60
"""Up to here Lemke's method takes a few milliseconds and is tried first."""

LARGE = 5000
"""From here on a dense tableau is the last resort."""


def methods_for(problem: LCP) -> list[Method]:
    """The chain of ``method="auto"``.

    Small: Lemke, which ends by itself. Dense: block pivoting (a few factorisations where it works), Newton, Lemke,
    interior point. Large, sparse and symmetric: multigrid and MPRGP first. An operator: MPRGP, the only one that needs
    products alone. Enumeration closes the chain to n = 12, and so does a Lemke path with another covering vector.

    Examples
    --------
    >>> from signorini.lcp.problem import read_problem
    >>> [method.name for method in methods_for(read_problem(np.eye(100), np.ones(100)))]
    ['block-pivoting', 'newton', 'lemke', 'interior-point', 'lemke']
    """
    if isinstance(problem.M, LinearOperator):
        return [MPRGP()]
    direct: list[Method] = [BlockPivoting(max_steps=40), SemismoothNewton(max_steps=60)]
    other = np.random.default_rng(0).uniform(1.0, 2.0, problem.n) * problem.sizes[0]
    pivoting: list[Method] = [Lemke(), InteriorPoint(), Lemke(covering=other)]
    if problem.n <= SMALL:
        last: list[Method] = [Enumeration()] if problem.n <= 12 else []
        return [pivoting[0], *direct, *pivoting[1:], *last]
    if not sp.issparse(problem.M):
        return [*direct, *pivoting]
    positive = bool((problem.M.diagonal() > 0).all())
    if positive and problem.n > LARGE and is_symmetric(problem.M):
        return [ProjectedMultigrid(), MPRGP(), *direct, InteriorPoint()]
    sweeps: list[Method] = [ProjectedSOR()] if positive and problem.n > LARGE else []
    return [*direct, InteriorPoint(), *sweeps, *(pivoting if problem.n <= LARGE else [])]
