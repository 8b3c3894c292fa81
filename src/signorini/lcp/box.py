# SPDX-License-Identifier: BSD-3-Clause
"""Problems with bounds and free variables, reduced to an LCP and put back: ``BoxLCP`` and ``MixedLCP``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array, BoolArray, frozen
from signorini.errors import InputError
from signorini.lcp.linear import Inverse, factorised, scaled
from signorini.lcp.problem import LCP, read_problem
from signorini.lcp.residual import Residual
from signorini.lcp.solution import LCPSolution, Method, Status
from signorini.lcp.solve import solve
from signorini.short import Short


@dataclass(frozen=True, kw_only=True)
class WithoutFree:
    """The Schur complement of the free variables, an LCP in the others.

    Attributes
    ----------
    M, q : the reduced problem, ``M_cc - M_cf M_ff^-1 M_fc`` and ``q_c - M_cf M_ff^-1 q_f``
    free : (n,) mask of the free variables of the mixed problem
    """

    M: Any
    q: Array
    free: BoolArray
    rows: Any
    right: Array
    inverse: Inverse | None

    def back(self, z: Array) -> Array:
        """All variables, from a solution of the reduced problem."""
        whole = np.zeros(len(self.free))
        whole[~self.free] = z
        if self.inverse is not None:
            whole[self.free] = -self.inverse(self.right + self.rows @ z)
        return whole


def eliminate_free(M: Any, q: Array, free: BoolArray) -> WithoutFree | None:
    """Reduce ``w_f = 0`` (z_f free), ``0 <= z_c  _|_  w_c >= 0`` to an LCP; None where ``M_ff`` is singular.

    Parameters
    ----------
    M : (n, n) dense or CSR array; with free variables the reduced one is dense
    q : (n,) array
    free : (n,) mask

    Examples
    --------
    >>> M, q = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-3.0, -3.0])
    >>> reduced = eliminate_free(M, q, np.array([True, False]))
    >>> float(reduced.M[0, 0]), float(reduced.q[0])
    (1.5, -1.5)
    >>> print(reduced.back(np.array([1.0])))
    [1. 1.]
    """
    f, c = np.flatnonzero(free), np.flatnonzero(~free)
    if not len(f):
        return WithoutFree(M=M, q=q, free=free, rows=None, right=q[f], inverse=None)
    inverse = factorised(M[f][:, f])
    if inverse is None:
        return None
    rows = M[f][:, c].toarray() if sp.issparse(M) else M[np.ix_(f, c)]
    columns = inverse(rows) if len(c) else rows
    M_cf, M_cc = M[c][:, f], M[c][:, c]
    reduced = (M_cc.toarray() if sp.issparse(M) else M_cc) - M_cf @ columns
    return WithoutFree(M=reduced, q=q[c] - M_cf @ inverse(q[f]), free=free, rows=rows, right=q[f], inverse=inverse)


@dataclass(frozen=True, kw_only=True, repr=False)
class BoxLCP(Short):
    """Find ``lower <= z <= upper`` with w = M z + q >= 0 where z_i = lower_i, <= 0 where z_i = upper_i, else 0.

    Parameters
    ----------
    M : (n, n) array or sparse matrix
    q : (n,) array
    lower, upper : (n,) arrays, infinite entries allowed; equal ones fix the variable and leave its w free

    Raises
    ------
    InputError
        For malformed M and q, bounds that are NaN, do not fit or cross, and for a linear operator.

    Examples
    --------
    >>> box = BoxLCP(M=[[2.0, 0.0], [0.0, 2.0]], q=[-1.0, -8.0], lower=[-1.0, 0.0], upper=[1.0, 3.0])
    >>> solution = box.solve()
    >>> print(solution.z, solution.w)
    [0.5 3. ] [ 0. -2.]
    """

    M: Any
    q: ArrayLike
    lower: ArrayLike
    upper: ArrayLike

    def solve(self, *, method: str | Method = "auto", tolerance: float = 1e-9) -> LCPSolution:
        """Reduce, solve, put back, and test the result on the problem as posed; like ``lcp.solve``."""
        problem, lower, upper = self._read()
        reduced = Reduction.of(problem, lower, upper)
        if reduced is None:
            message = f"{Status.SINGULAR.value} Here it is the block of the free variables."
            return _reduced_away(Status.SINGULAR, message, "reduction: SINGULAR")
        if len(reduced.inner.q):
            solution = solve(reduced.inner.M, reduced.inner.q, method=method, tolerance=tolerance)
            if solution.z is None:
                return replace(solution, candidate=None)
            z = reduced.back(solution.z)
        else:
            line, z = "none: all variables are free or fixed", reduced.back(np.zeros(0))
            solution = _reduced_away(Status.SOLVED, Status.SOLVED.value, line)
        residual = box_residual(problem, lower, upper, z)
        if residual.worst <= tolerance:
            return replace(solution, z=frozen(z), w=frozen(problem.M @ z + problem.q), residual=residual)
        message = f"The reduced problem was solved, the problem with bounds was not: {Status.BREAKDOWN.value}"
        return replace(
            solution, z=None, w=None, candidate=frozen(z), residual=residual, status=Status.BREAKDOWN, message=message
        )

    def _read(self) -> tuple[LCP, Array, Array]:
        problem = read_problem(self.M, self.q)
        if isinstance(problem.M, LinearOperator):
            raise InputError("is a linear operator; bounds other than z >= 0 need the entries", where=("M",))
        lower, upper = np.asarray(self.lower, dtype=float), np.asarray(self.upper, dtype=float)
        for name, bound in (("lower", lower), ("upper", upper)):
            if bound.shape != problem.q.shape or np.isnan(bound).any():
                raise InputError(f"has shape {bound.shape} or NaN; expected ({problem.n},) numbers", where=(name,))
        crossed = np.flatnonzero((lower > upper) | (lower == np.inf) | (upper == -np.inf))
        if len(crossed):
            i = crossed[0]
            raise InputError(
                f"is {upper[i]} in row {i} where lower is {lower[i]}; expected lower <= upper", where=("upper",)
            )
        return problem, lower, upper


@dataclass(frozen=True, kw_only=True, repr=False)
class MixedLCP(Short):
    """Find z with w_i = 0 where z_i is free, and ``0 <= z_i  _|_  w_i >= 0`` elsewhere, w = M z + q.

    Parameters
    ----------
    M : (n, n) array or sparse matrix
    q : (n,) array
    free : (n,) mask of the free variables; their block of M must be regular

    Examples
    --------
    >>> MixedLCP(M=[[2.0, 1.0], [1.0, 2.0]], q=[3.0, -3.0], free=[True, False]).solve().z
    array([-3.,  3.])
    """

    M: Any
    q: ArrayLike
    free: ArrayLike

    def solve(self, *, method: str | Method = "auto", tolerance: float = 1e-9) -> LCPSolution:
        """Eliminate the free variables, solve, put back and test; like ``lcp.solve``."""
        free = np.asarray(self.free)
        if free.dtype != bool or free.shape != np.shape(self.q):
            raise InputError(
                f"is {free.dtype} {free.shape}; expected a mask of shape {np.shape(self.q)}", where=("free",)
            )
        lower, upper = np.where(free, -np.inf, 0.0), np.full(free.shape, np.inf)
        return BoxLCP(M=self.M, q=self.q, lower=lower, upper=upper).solve(method=method, tolerance=tolerance)


@dataclass(frozen=True, kw_only=True)
class Reduction:
    """``z = shift + sign x``: x >= 0 or free, and one multiplier more for every variable with two bounds.

    Attributes
    ----------
    inner : the LCP in x (where not fixed) and the multipliers, the free ones eliminated
    shift, sign : (n,) arrays; sign is -1 where only the upper bound is finite, 0 where the variable is fixed
    """

    inner: WithoutFree
    shift: Array
    sign: Array

    @staticmethod
    def of(problem: LCP, lower: Array, upper: Array) -> Reduction | None:
        """The reduction of a problem with bounds lower and upper, (n,); None where the free block is singular."""
        has_lower, has_upper = np.isfinite(lower), np.isfinite(upper)
        shift = np.where(has_lower, lower, np.where(has_upper, upper, 0.0))
        sign = np.where(lower == upper, 0.0, np.where(has_upper & ~has_lower, -1.0, 1.0))
        kept = np.flatnonzero(sign)
        M: Any = problem.M
        q = sign * (problem.q + M @ shift)
        part = scaled(M, sign, sign)[kept][:, kept]
        two = np.flatnonzero((has_lower & has_upper)[kept])
        select = sp.csr_array((np.ones(len(two)), (two, np.arange(len(two)))), shape=(len(kept), len(two)))
        whole = sp.block_array([[sp.csr_array(part), select], [-select.T, None]]) if len(two) else None
        extended = part if whole is None else whole.tocsr() if sp.issparse(M) else whole.toarray()
        free = np.append(~has_lower[kept] & ~has_upper[kept], np.zeros(len(two), dtype=bool))
        inner = eliminate_free(extended, np.append(q[kept], (upper - lower)[kept][two]), free)
        return None if inner is None else Reduction(inner=inner, shift=shift, sign=sign)

    def back(self, z: Array) -> Array:
        """The variables of the problem with bounds."""
        x = np.zeros(len(self.sign))
        kept = np.flatnonzero(self.sign)
        x[kept] = self.inner.back(z)[: len(kept)]
        return self.shift + self.sign * x


def box_residual(problem: LCP, lower: Array, upper: Array, z: Array) -> Residual:
    """The natural residual of z (n,) in a problem with bounds lower and upper, in the sizes of ``natural_residual``."""
    unit, w, _ = problem.yardstick.sizes(z)
    below = np.where(np.isfinite(lower), unit * (z - np.where(np.isfinite(lower), lower, 0.0)), np.inf)
    above = np.where(np.isfinite(upper), unit * (np.where(np.isfinite(upper), upper, 0.0) - z), np.inf)
    fixed = lower == upper
    up, down = np.where(fixed, 0.0, np.maximum(w, 0.0)), np.where(fixed, 0.0, np.maximum(-w, 0.0))
    return Residual(
        primal=float(np.maximum(-np.minimum(below, above), 0.0).max()),
        dual=float(max(up[np.isinf(below)].max(initial=0.0), down[np.isinf(above)].max(initial=0.0))),
        complementarity=float(max(np.minimum(below, up).max(), np.minimum(above, down).max())),
    )


def _reduced_away(status: Status, message: str, line: str) -> LCPSolution:
    """Nothing was left to choose, or to solve for."""
    return LCPSolution(status=status, message=message, method="none", chain=(line,))
