# SPDX-License-Identifier: BSD-3-Clause
"""The one call, and the only place where SOLVED is granted: on the problem as posed, outside every method."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, frozen
from signorini.errors import InputError, one_of
from signorini.lcp.auto import methods_for
from signorini.lcp.block import BlockPivoting
from signorini.lcp.enumeration import Enumeration
from signorini.lcp.game import LemkeHowson
from signorini.lcp.interior import InteriorPoint
from signorini.lcp.lemke import Lemke
from signorini.lcp.mprgp import MPRGP
from signorini.lcp.multigrid import ProjectedMultigrid
from signorini.lcp.newton import SemismoothNewton
from signorini.lcp.principal import LeastIndex
from signorini.lcp.problem import LCP, read_problem, read_vector
from signorini.lcp.relaxation import ProjectedSOR
from signorini.lcp.solution import Attempt, LCPSolution, Method, Status

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
