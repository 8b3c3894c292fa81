# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation of the bodies on all ranks by PETSc's GAMG, springs of their contacts added on every level.

As in `signorini.iterative.multigrid` the bodies alone make the coarse grids. The springs are ``B' D B``, on a coarse
level ``(B P)' D (B P)``: B P is made once, and a product of small matrices follows every change of D.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.sparse as sp
from petsc4py import PETSc

from signorini.arrays import Array
from signorini.distributed.ranks import Team

_COARSEST = 400  # unknowns that are solved for directly, on every rank
_SMOOTHING = 2  # steps of the Chebyshev iteration before and after
_LEAST_SMOOTHED = 0.1  # of the largest eigenvalue: from where on smoothing damps
_ABOVE_FOUND = 1.1  # of the largest eigenvalue found: what is taken for it
_ESTIMATES = 12  # conjugate gradients that find it
_NO_STIFFNESS = 1e-12  # of the largest diagonal: rows of aggregates that have fewer unknowns than rigid motions
_DEPENDENT = 1e-12  # of the largest square of a combination of rigid motions: others are the same motion twice
_MOST_ITERATIONS = 400  # of conjugate gradients
_numbers = itertools.count()  # of solvers, whose options stand in one table


def matrix(team: Team, rows: sp.csr_array, width: int, block: int = 1) -> Any:
    """A matrix of PETSc.

    Parameters
    ----------
    team : the ranks
    rows : those of this rank, in columns of all ranks
    width : columns that are this rank's
    block : unknowns a node
    """
    rows.sort_indices()
    made = PETSc.Mat().create(team.comm)
    made.setSizes(((rows.shape[0], None), (width, None)))
    made.setType("aij")
    made.setBlockSize(block)
    integers = (part.astype(PETSc.IntType) for part in (rows.indptr, rows.indices))
    made.setPreallocationCSR((*integers, rows.data))
    made.assemble()
    return made


class CoarseGrids:
    """Coarse grids of the bodies.

    Parameters
    ----------
    team : the ranks
    K : stiffness in blocks of a node
    near_null : (own, k) motions that hardly need a force, the rows of this rank

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """

    def __init__(self, team: Team, K: Any, near_null: Array) -> None:
        self.team = team
        squares, axes = np.linalg.eigh(team.total(near_null.T @ near_null))
        kept = squares > _DEPENDENT * squares[-1]
        orthonormal = (axes[:, kept] / np.sqrt(squares[kept])).T @ near_null.T
        vectors = []
        for values in orthonormal:
            vectors.append(K.createVecRight())
            vectors[-1].array[:] = values
        K.setNearNullSpace(PETSc.NullSpace().create(vectors=vectors, comm=team.comm))
        self._gamg = PETSc.KSP().create(team.comm)
        set_options(
            self._gamg,
            "signorini_gamg_",
            {
                "pc_gamg_agg_nsmooths": 1,
                "pc_gamg_threshold": 0.0,
                "pc_gamg_coarse_eq_limit": _COARSEST,
                "mg_coarse_pc_type": "none",
            },
        )
        self._gamg.setOperators(K)
        made = self._gamg.getPC()
        made.setType("gamg")
        self._gamg.setFromOptions()
        made.setUp()
        count = made.getMGLevels()
        # the coarsest first, as PETSc counts
        self.K = [*(made.getMGSmoother(k).getOperators()[1] for k in range(count - 1)), K]
        self.P = [made.getMGInterpolation(k) for k in range(1, count)]
        for coarse in self.K[:-1]:
            _stiffen_empty_rows(coarse)


def _stiffen_empty_rows(K: Any) -> None:
    diagonal = K.getDiagonal()
    most, first = diagonal.norm(PETSc.NormType.INFINITY), K.getOwnershipRange()[0]
    K.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    for row in first + np.flatnonzero(diagonal.array <= _NO_STIFFNESS * most):
        K.setValue(row, row, most)
    K.assemble()


class SpringCycle:
    """Conjugate gradients with a V-cycle for the bodies and springs in their pairs, which change.

    Parameters
    ----------
    grids : of the bodies
    B : (d a, b) relative displacements of the pairs, pair by pair
    stuck : (a, d, d) the stiffest springs of the pairs of this rank
    """

    def __init__(self, grids: CoarseGrids, B: Any, stuck: Array) -> None:
        self._team, self._grids = grids.team, grids
        self._any = B.getSize()[0] > 0
        self._seen = [B]
        for P in reversed(grids.P):
            self._seen.insert(0, self._seen[0].matMult(P))
        self._D = self._blocks(len(stuck), B.getOwnershipRange())
        self._springs: list[Any] = []
        self._A = [K.copy() for K in grids.K]
        if self._any:
            self._set(stuck)
            self._springs = [self._D.ptap(seen) for seen in self._seen]
            for A, S in zip(self._A, self._springs, strict=True):
                A.axpy(1.0, S, structure=PETSc.Mat.Structure.DIFFERENT)
        pairs = zip(grids.K[1:], self._A[1:], strict=True)
        self._solver = self._made([max(self._largest(K), self._largest(A)) for K, A in pairs])
        self._x, self._b = self._A[-1].createVecs()
        self._is_new = False

    def _blocks(self, count: int, rows: tuple[int, int]) -> Any:
        """The matrix of the springs, a block for each pair."""
        d = (rows[1] - rows[0]) // count if count else 1
        first = rows[0] + d * np.repeat(np.arange(count), d)
        columns = (first[:, None] + np.arange(d)).ravel()
        self._pattern = np.arange(0, d * (rows[1] - rows[0]) + 1, d), columns
        shape = (rows[1] - rows[0], self._seen[-1].getSize()[0])
        ones = sp.csr_array((np.ones(len(columns)), columns, self._pattern[0]), shape=shape)
        return matrix(self._team, ones, rows[1] - rows[0])

    def _set(self, springs: Array) -> None:
        indptr, columns = (part.astype(PETSc.IntType) for part in self._pattern)
        self._D.setValuesCSR(indptr, columns, np.ascontiguousarray(springs).ravel())
        self._D.assemble()

    def under(self, springs: Array) -> None:
        """Take other springs, on every level.

        Parameters
        ----------
        springs : (a, d, d) of the pairs of this rank
        """
        self._is_new = True
        if self._any:
            self._set(springs)
            for A, K, S, seen in zip(self._A, self._grids.K, self._springs, self._seen, strict=True):
                self._D.ptap(seen, result=S)
                K.copy(A, PETSc.Mat.Structure.DIFFERENT)
                A.axpy(1.0, S, structure=PETSc.Mat.Structure.SUBSET)

    def solved(self, springs: Array, g: Array, residual: float) -> tuple[Array, int]:
        """Displacements under forces (own,), and the number of conjugate gradients.

        Parameters
        ----------
        springs : (a, d, d) of the pairs of this rank, near those that coarse levels have
        g : the forces
        residual : what may be left of them
        """
        if self._any and not self._is_new:
            S, before = self._springs[-1], self._springs[-1].copy()
            self._set(springs)
            self._D.ptap(self._seen[-1], result=S)
            before.aypx(-1.0, S, structure=PETSc.Mat.Structure.SAME)
            self._A[-1].axpy(1.0, before, structure=PETSc.Mat.Structure.SUBSET)
        self._is_new = False
        self._b.array[:] = g
        self._x.set(0.0)
        self._solver.setTolerances(rtol=residual, atol=0.0, max_it=_MOST_ITERATIONS)
        self._solver.solve(self._b, self._x)
        return self._x.array.copy(), int(self._solver.getIterationNumber())

    def _made(self, largest: list[float]) -> Any:
        """The solver: its levels smooth down from the largest eigenvalues, given from the coarsest but one."""
        solver = PETSc.KSP().create(self._team.comm)
        solver.setType("cg")
        solver.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
        solver.setOperators(self._A[-1])
        cycle = solver.getPC()
        cycle.setType("mg")
        cycle.setMGLevels(len(self._A))
        for k, P in enumerate(self._grids.P, 1):
            cycle.setMGInterpolation(k, P)
        for k, A in enumerate(self._A):
            cycle.getMGSmoother(k).setOperators(A)
        prefix = f"signorini_{next(_numbers)}_"
        # floating bodies leave motions free
        words: dict[str, Any] = {"ksp_type": "preonly", "pc_type": "redundant", "redundant_pc_type": "svd"}
        set_options(cycle.getMGSmoother(0), f"{prefix}0_", words)
        for k, most in enumerate(largest, 1):
            bounds = f"{_LEAST_SMOOTHED * most * _ABOVE_FOUND},{most * _ABOVE_FOUND}"
            words = {"ksp_type": "chebyshev", "ksp_max_it": _SMOOTHING, "ksp_chebyshev_eigenvalues": bounds}
            set_options(cycle.getMGSmoother(k), f"{prefix}{k}_", {**words, "pc_type": "pbjacobi"})
        solver.setOptionsPrefix(prefix)
        solver.setFromOptions()
        solver.setUp()
        return solver

    def _largest(self, A: Any) -> float:
        """The largest eigenvalue of A preconditioned by the blocks of its diagonal, nearly."""
        solver = PETSc.KSP().create(self._team.comm)
        solver.setType("cg")
        solver.getPC().setType("pbjacobi")
        solver.setOperators(A)
        solver.setComputeEigenvalues(True)
        solver.setTolerances(rtol=1e-14, max_it=_ESTIMATES)
        b, x = A.createVecs()
        first, last = b.getOwnershipRange()
        # the same start on any number of ranks, and smooth motions in it as little as others
        b.array[:] = np.sin(1.0 + np.arange(first, last, dtype=np.float64) ** 2)
        solver.solve(b, x)
        return float(np.max(solver.computeEigenvalues().real))


def set_options(solver: Any, prefix: str, words: Mapping[str, Any]) -> None:
    """Give a solver a prefix and options of it.

    Parameters
    ----------
    solver, prefix, words : of PETSc, without a dash
    """
    solver.setOptionsPrefix(prefix)
    options = PETSc.Options()
    for name, value in words.items():
        options[prefix + name] = value
