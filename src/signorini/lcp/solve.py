# SPDX-License-Identifier: BSD-3-Clause
"""The one call, the methods that it tries, and the only place where SOLVED is granted: on the problem as posed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array, frozen
from signorini.errors import InputError, one_of
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
from signorini.lcp.principal import LeastIndex
from signorini.lcp.problem import LCP, read_problem, read_vector
from signorini.lcp.relaxation import ProjectedSOR
from signorini.lcp.solution import Attempt, LCPSolution, Method, Status

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


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Lemke(),
        LemkeHowson(),
        LeastIndex(),
        BlockPivoting(),
        SemismoothNewton(),
        ProjectedSOR(),
        MPRGP(),
        ProjectedMultigrid(),
        InteriorPoint(),
        Enumeration(),
    )
}
"""The methods by name, with their default options."""


def solve(
    M: Any,
    q: ArrayLike,
    *,
    method: str | Method = "auto",
    z0: ArrayLike | None = None,
    tolerance: float = 1e-9,
) -> LCPSolution:
    """Solve ``0 <= z  _|_  w = M z + q >= 0``.

    Parameters
    ----------
    M : (n, n) array, sparse matrix or sparse array, or LinearOperator where the method allows
    q : (n,) array
    method : ``"auto"``, the name of a method, or a solver object such as ``Lemke(covering=d)``
    z0 : (n,) start, used by the methods that can; Lemke takes the basis of its positive entries
    tolerance : largest natural residual (``natural_residual``, dimensionless) that counts as solved

    Returns
    -------
    LCPSolution
        Also where no solution was found: look at ``.solved`` or ``.status``.

    Raises
    ------
    InputError
        For a malformed M, q, z0, method or tolerance; an empty problem (n = 0) is malformed.

    Examples
    --------
    >>> solution = solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0], method="lemke")
    >>> solution.solved, solution.z.round(9).tolist()
    (True, [1.333333333, 2.333333333])
    >>> print(solve([[-1.0]], [-1.0], method="lemke").status.name)
    RAY_TERMINATION
    """
    problem = read_problem(M, q)
    start = None if z0 is None else read_vector(z0, "z0", problem.n)
    if not tolerance > 0:
        raise InputError(f"is {tolerance}; expected a positive number", where=("tolerance",))
    return _judge(problem, _chain(method, problem), start, tolerance)


def _chain(method: str | Method, problem: LCP) -> list[Method]:
    if not isinstance(method, str):
        return [method]
    if method == "auto":
        return methods_for(problem)
    if method not in METHODS:
        raise InputError(one_of(method, (*METHODS, "auto"), "method"), where=("method",))
    return [METHODS[method]]


def _judge(problem: LCP, methods: list[Method], z0: Array | None, tolerance: float) -> LCPSolution:
    """Run the methods in order until one is confirmed by the residual of the problem as posed.

    Where none is, the first ray says more than the last failure.
    """
    tried: list[LCPSolution] = []
    for method in methods:
        attempt = method.attempt(problem, z0, tolerance)
        tried.append(_tested(problem, method, attempt, tolerance))
        if tried[-1].status in (Status.SOLVED, Status.NO_SOLUTION):
            break
    rays = [solution for solution in tried if solution.ray is not None]
    ended = rays[0] if rays and tried[-1].status not in (Status.SOLVED, Status.NO_SOLUTION) else tried[-1]
    return replace(ended, chain=tuple(line for solution in tried for line in solution.chain))


def _tested(problem: LCP, method: Method, attempt: Attempt, tolerance: float) -> LCPSolution:
    """Replace the method's claim by what the natural residual says."""
    z = attempt.z if attempt.z is not None and np.isfinite(attempt.z).all() else None
    residual = None if z is None else problem.residual(z)
    confirmed = residual is not None and residual.worst <= tolerance
    status = attempt.ending
    if confirmed:
        status = Status.SOLVED
    elif status is Status.SOLVED:
        status = Status.NONFINITE if attempt.z is not None and z is None else Status.BREAKDOWN
    said = f"{method.name}: {status.value}"
    if residual is not None and not confirmed:
        said += f" Natural residual of the candidate {residual.worst:.1e}, asked {tolerance:.1e}."
    line = f"{method.name}: {status.name} after {attempt.iterations} iterations"
    return LCPSolution(
        z=frozen(z) if confirmed and z is not None else None,
        w=frozen(problem.M @ z + problem.q) if confirmed and z is not None else None,
        status=status,
        iterations=attempt.iterations,
        residual=residual,
        candidate=None if confirmed or z is None else frozen(z),
        message=f"{said} {attempt.note}".strip(),
        method=method.name,
        chain=(line,),
        ray=None if confirmed else attempt.ray,
    )
