# SPDX-License-Identifier: BSD-3-Clause
"""Projected multigrid: large sparse symmetric problems at a cost proportional to their size."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg

from signorini.arrays import Array, BoolArray
from signorini.lcp.linear import factorised
from signorini.lcp.mprgp import symmetric_in_products
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status

if TYPE_CHECKING:
    from signorini.linalg.vcycle import VCycle


USELESS_REDUCTION = 0.5  # of a residual: conjugate gradients that leave more of it have a preconditioner that is none
COARSEST_SWEEPS = 500  # on at most some hundred unknowns: they cost nothing


@dataclass(frozen=True, kw_only=True)
class ProjectedMultigrid:
    """Truncated nonsmooth Newton with multigrid inside, started from the same problem on coarser levels.

    A round is: projected Gauss-Seidel forth and back; conjugate gradients on the free variables, preconditioned by a
    V-cycle of smoothed aggregation; projection; the step that minimises the energy on the way. Where the conjugate
    gradients get nowhere, many narrow contacts part the free variables: then the hierarchy is truncated to those.

    Parameters
    ----------
    max_rounds : limit on the rounds on the finest level
    inner : conjugate gradient steps a round, at most
    coarse_rounds : limit on the rounds on every coarser level, for the start

    References
    ----------
    Graser, Kornhuber (2009), Multigrid methods for obstacle problems, Journal of Computational Mathematics 27:1-44.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> laplacian = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(900, 900))
    >>> solve(laplacian, np.sin(np.arange(900.0)), method=ProjectedMultigrid()).status.name
    'SOLVED'
    """

    name: ClassVar[str] = "multigrid"
    matrices: ClassVar[str] = "sparse, symmetric positive definite; made for Z-matrices and discretised operators"

    max_rounds: int = 100
    inner: int = 8
    coarse_rounds: int = 60

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        M = problem.M
        if not sp.issparse(M) or not (M.diagonal() > 0).all() or not symmetric_in_products(problem):
            note = "It needs a sparse symmetric matrix with a positive diagonal."
            return Attempt.refused(note)
        scale = 1.0 / np.sqrt(M.diagonal())
        A = (sp.diags_array(scale) @ M @ sp.diags_array(scale)).tocsr()
        q = scale * problem.q
        levels = hierarchy(A)
        z = self._start(levels, q) if z0 is None else np.maximum(z0, 0.0) / scale
        for count in range(self.max_rounds + 1):
            if not np.isfinite(z).all():
                return Attempt(z=None, ending=Status.NONFINITE, iterations=count)
            if problem.residual(scale * z).worst <= 0.1 * tolerance:
                return Attempt(z=scale * z, ending=Status.SOLVED, iterations=count)
            z = self._round(levels, q, z)
        return Attempt(z=scale * z, ending=Status.MAX_ITERATIONS, iterations=self.max_rounds)

    def _start(self, levels: Hierarchy, q: Array) -> Array:
        """The answer of the next coarser level, prolonged; P >= 0 keeps it feasible for a Z-matrix."""
        if not levels.prolongations:
            return np.zeros(len(q))
        P = levels.prolongations[0]
        return np.maximum(P @ self._coarse(levels.coarser, P.T @ q), 0.0)

    def _coarse(self, levels: Hierarchy, q: Array) -> Array:
        """An approximate answer of a coarser level."""
        z = self._start(levels, q)
        if not levels.prolongations:
            _relax(levels.matrices[0], q, z, count=COARSEST_SWEEPS)
            return z
        for _ in range(self.coarse_rounds):
            before, z = z, self._round(levels, q, z)
            if np.abs(z - before).max() <= 1e-6 * np.abs(z).max():
                break
        return z

    def _round(self, levels: Hierarchy, q: Array, z: Array) -> Array:
        A, z = levels.matrices[0], z.copy()
        for backwards in (False, True):
            _relax(A, q, z, backwards=backwards)
        gradient = A @ z + q
        free = z > 0
        ahead = np.maximum(z + self._correction(levels, -gradient * free, free), 0.0)
        move = ahead - z
        curvature = float(move @ (A @ move))
        if not curvature > 0:
            return z
        return z + min(1.0, max(0.0, -float(gradient @ move) / curvature)) * move

    def _correction(self, levels: Hierarchy, r: Array, free: BoolArray) -> Array:
        """``A c = r`` on the free variables."""
        c, left = _conjugate_gradients(levels, r, free, self.inner)
        if left > USELESS_REDUCTION:
            c, _ = _conjugate_gradients(levels.truncated(free), r, free, self.inner)
        return c


def _relax(A: Any, q: Array, z: Array, *, count: int = 1, backwards: bool = False) -> None:
    """Projected Gauss-Seidel sweeps in place."""
    from signorini.lcp.kernels import sweeps

    sweeps(A.indptr, A.indices, A.data, q, z, 1.0, count, backwards)


def _conjugate_gradients(levels: Hierarchy, r: Array, free: BoolArray, steps: int) -> tuple[Array, float]:
    """c with ``A c = r`` on the free variables and 0 elsewhere to two digits, and what is left of r."""
    A, shape = levels.matrices[0], levels.matrices[0].shape
    product = LinearOperator(shape, matvec=lambda v: (A @ v) * free, dtype=np.float64)
    cycle = LinearOperator(shape, matvec=lambda v: levels.cycle(v) * free, dtype=np.float64)
    c, _ = cg(product, r, rtol=1e-2, maxiter=steps, M=cycle)
    first = float(np.linalg.norm(r))
    return c, float(np.linalg.norm(r - product @ c)) / first if first > 0 else 0.0


COARSEST_SIZE = 300  # unknowns: the size at which a level is factorised
SLOWEST_COARSENING = 0.7  # of the unknowns of a level: where the next one keeps more, it gains nothing
STRENGTH = 0.08  # of sqrt(A_ii A_jj): entries above it make neighbours


@dataclass(frozen=True, kw_only=True)
class Hierarchy:
    """Matrices from fine to coarse, each the Galerkin product of the one before.

    Attributes
    ----------
    matrices : (n, n) CSR arrays, columns sorted
    prolongations : (n, coarse n) CSR arrays from every matrix to the one before, >= 0 for Z-matrices
    cycle : an approximate inverse of the finest matrix, symmetric positive definite
    """

    matrices: tuple[Any, ...]
    prolongations: tuple[Any, ...]
    cycle: VCycle

    @property
    def coarser(self) -> Hierarchy:
        """All but the finest level."""
        cycle = replace(self.cycle, levels=self.cycle.levels[1:])
        return Hierarchy(matrices=self.matrices[1:], prolongations=self.prolongations[1:], cycle=cycle)

    def truncated(self, free: BoolArray) -> Hierarchy:
        """The hierarchy of ``A x = r`` for the free unknowns (n,) alone, the others held at 0, same prolongations.

        What is prolonged to unknowns that are held is cut off on the finest level, and the coarser matrices are made
        anew: without that, coarse corrections carry from one side of a narrow contact to the other.

        References
        ----------
        Kornhuber (1994), Monotone multigrid methods for elliptic variational inequalities I, Numer. Math. 69:167-184.
        """
        kept = sp.diags_array(free.astype(float))
        A = _sorted(kept @ self.matrices[0] @ kept + sp.diags_array((~free).astype(float)))
        prolongations = [(kept @ P).tocsr() if k == 0 else P for k, P in enumerate(self.prolongations)]
        matrices = [A]
        for P in prolongations:
            A = P.T @ A @ P
            A = _sorted(A + sp.diags_array((A.diagonal() <= 0).astype(float)))  # where nothing is left
            matrices.append(A)
        return _assembled(matrices, prolongations)


def hierarchy(A: Any) -> Hierarchy:
    """Coarsen A, (n, n) CSR array, symmetric with positive diagonal, until a factorisation costs nothing.

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """
    matrices, prolongations = [_sorted(A)], []
    while (size := matrices[-1].shape[0]) > COARSEST_SIZE:
        P = _prolongation(matrices[-1])
        if not 0 < P.shape[1] <= SLOWEST_COARSENING * size:
            break
        prolongations.append(P)
        matrices.append(_sorted(P.T @ matrices[-1] @ P))
    return _assembled(matrices, prolongations)


def _assembled(matrices: list[Any], prolongations: list[Any]) -> Hierarchy:
    """Matrices and prolongations with their V-cycle."""
    from signorini.linalg.symmetric_blocks import SymmetricBlocks  # Numba takes longer than most problems
    from signorini.linalg.vcycle import MultigridLevel, VCycle

    levels = tuple(
        MultigridLevel(
            A=SymmetricBlocks.of(_single(A)),
            P=_single(P),
            inverses=_inverted(A.diagonal())[:, None, None],
        )
        for A, P in zip(matrices[:-1], prolongations, strict=True)
    )
    diagonal = _inverted(matrices[-1].diagonal())
    coarsest = factorised(matrices[-1].tocsc()) or (lambda r: diagonal * r)
    cycle = VCycle(levels=levels, coarsest=coarsest)
    return Hierarchy(matrices=tuple(matrices), prolongations=tuple(prolongations), cycle=cycle)


def _single(rows: Any) -> Any:
    """A matrix in blocks of one entry."""
    return sp.bsr_array((rows.data[:, None, None], rows.indices, rows.indptr), shape=rows.shape)


def _prolongation(A: Any) -> Any:
    """Piecewise constants on aggregates, smoothed by one damped Jacobi step."""
    from pyamg.aggregation import standard_aggregation  # takes longer to import than most problems to solve
    from pyamg.strength import symmetric_strength_of_connection

    constant = standard_aggregation(symmetric_strength_of_connection(sp.csr_matrix(A), theta=STRENGTH))[0]
    return sp.csr_array(constant - sp.diags_array(2.0 / 3.0 / A.diagonal()) @ (A @ constant))


def _sorted(A: Any) -> Any:
    rows = sp.csr_array(A)
    rows.sort_indices()
    return rows


def _inverted(diagonal: Array) -> Array:
    """What a diagonal is divided by; nothing moves where it is not positive."""
    return np.divide(1.0, diagonal, out=np.zeros(len(diagonal)), where=diagonal > 0)
