# SPDX-License-Identifier: BSD-3-Clause
"""What every rank does for factors: it gives MUMPS its rows of the bodies, and solves for loads with the others.

MUMPS leaves the unknowns of the interface out of the elimination and hands their Schur complement to the first rank.
petsc4py does not know of that, so that functions of PETSc are called by their names in its library.

References
----------
Amestoy, Duff, L'Excellent, Koster (2001), A fully asynchronous multifrontal solver using distributed dynamic
scheduling, SIAM J. Matrix Anal. Appl. 23:15; MUMPS users' guide: ICNTL, CNTL, INFOG and "Schur complement".
"""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from petsc4py import PETSc

from signorini.arrays import Array, IntArray
from signorini.distributed.multigrid import matrix, set_options
from signorini.distributed.parts import OwnBodies
from signorini.distributed.ranks import Team
from signorini.distributed.room import Room, room_for

_OPTIONS = {
    "mat_mumps_icntl_7": 5,  # the order of elimination is METIS's, or minimum degree where MUMPS has no METIS
    "mat_mumps_icntl_14": 40,  # per cent of memory beyond what MUMPS expects, which borders and many ranks exceed
    "mat_mumps_cntl_1": 0.0,  # no pivoting: the interior is positive definite, or it is refused
}
_ONLY_INSIDE = 26, 0  # ICNTL: solves leave out the unknowns of the Schur complement
_STATUS, _DETAIL, _NEGATIVE = 1, 2, 12  # numbers in INFOG: how it ended, what more is said of it, pivots below 0
_MEGABYTES = 15  # number in INFO: what a rank will take, which is known before anything is factorised
_DENSE = 6.0  # matrices of the size of the interface that the first rank holds at once, as one process does
_TILE = 256  # rows and columns that are mirrored at once
_INFORMATION = 64  # numbers that have room for what PETSc says to a factorisation, of which MUMPS hears nothing


class AskedOfFactors(NamedTuple):
    """What a rank adds to its rows of the bodies.

    Attributes
    ----------
    springs : (own,) on the diagonal
    border : (own, m) columns of the border
    interface : (k,) unknowns that are not eliminated, on the first rank; none on the others
    """

    springs: Array
    border: sp.csr_array
    interface: IntArray


class FactorsMade(NamedTuple):
    """How a factorisation ended.

    Attributes
    ----------
    status, detail : INFOG(1) and INFOG(2) of MUMPS; not below 0 where it ran through
    negative : pivots below 0
    room : for the factors and the interface, on the machine that has least; where they do not fit they are not made
    condensed : (k, k) Schur complement, on the first rank; None on the others, and where there is none
    """

    status: int
    detail: int
    negative: int
    room: Room
    condensed: Array | None


class OwnFactors:
    """The factors of the bodies and their border, of which every rank has a part.

    Attributes
    ----------
    made : how the factorisation ended

    Parameters
    ----------
    team : the ranks
    bodies : rows of the bodies
    asked : what is added to them
    """

    def __init__(self, team: Team, bodies: OwnBodies, asked: AskedOfFactors) -> None:
        self._own = len(asked.springs)
        A = _with_border(team, bodies, asked)
        self._solver = PETSc.KSP().create(team.comm)
        self._solver.setOperators(A)
        self._solver.setType("preonly")
        factors = self._solver.getPC()
        factors.setType("cholesky")
        factors.setFactorSolverType("mumps")
        set_options(self._solver, "signorini_mumps_", _OPTIONS)
        self._solver.setErrorIfNotConverged(False)
        self._solver.setFromOptions()
        factors.setFactorSetUpSolverType()
        self._matrix = factors.getFactorMatrix()
        kept = asked.interface.astype(PETSc.IntType)
        self._kept = PETSc.IS().createGeneral(kept, comm=team.comm)
        count = int(team.total(len(kept)))
        if count:
            _petsc("MatFactorSetSchurIS", self._matrix, self._kept)
        information = (ctypes.c_double * _INFORMATION)()
        _petsc("MatFactorInfoInitialize", ctypes.byref(information))
        _petsc("MatCholeskyFactorSymbolic", self._matrix, A, None, ctypes.byref(information))
        room = room_for(team, 1e6 * self._matrix.getMumpsInfo(_MEGABYTES) + 8.0 * _DENSE * len(kept) ** 2)
        if room.asked <= room.free:
            _petsc("MatCholeskyFactorNumeric", self._matrix, A, ctypes.byref(information))
        status, detail, negative = (self._matrix.getMumpsInfog(number) for number in (_STATUS, _DETAIL, _NEGATIVE))
        made = status >= 0 and room.asked <= room.free
        if made and count:
            self._matrix.setMumpsIcntl(*_ONLY_INSIDE)
        condensed = self._condensed(count) if team.first and made else None
        self.made = FactorsMade(status, detail, negative, room, condensed)
        self._x, self._b = A.createVecs()

    def _condensed(self, count: int) -> Array:
        """(k, k) The Schur complement where MUMPS has left it, in the lower triangle, by columns; nothing is copied."""
        if not count:
            return np.zeros((0, 0))
        found, status = ctypes.c_void_p(), ctypes.c_int()
        _petsc("MatFactorGetSchurComplement", self._matrix, ctypes.byref(found), ctypes.byref(status))
        entries = ctypes.c_void_p()
        _petsc("MatDenseGetArray", found, ctypes.byref(entries))
        S = np.asarray(_Entries(self._matrix, entries.value, count))
        _mirror(S)
        S.flags.writeable = False
        _petsc("MatDenseRestoreArray", found, ctypes.byref(entries))
        _petsc("MatFactorRestoreSchurComplement", self._matrix, ctypes.byref(found), status)
        return S

    def solved(self, f: Array) -> Array:
        """(own, k) Displacements under forces (own, k) on what is eliminated, where the interface is held."""
        result = np.empty_like(f)
        for k, forces in enumerate(f.T):
            self._b.array[: self._own], self._b.array[self._own :] = forces, 0.0
            self._matrix.solve(self._b, self._x)
            result[:, k] = self._x.array[: self._own]
        return result


class _Entries:
    """Numbers in the memory of a matrix of PETSc's, as NumPy asks for them: it lives as long as somebody has them.

    Parameters
    ----------
    matrix : of PETSc
    address, count : where they are, and of how many rows and columns
    """

    def __init__(self, matrix: Any, address: int | None, count: int) -> None:
        self._matrix = matrix
        self.__array_interface__ = {"data": (address, False), "shape": (count, count), "typestr": "<f8", "version": 3}


def _mirror(S: Array) -> None:
    """Overwrite the lower triangle by the upper one."""
    for first in range(0, len(S), _TILE):
        behind = first + _TILE
        S[behind:, first:behind] = S[first:behind, behind:].T
        block = S[first:behind, first:behind]
        block[:] = np.triu(block) + np.triu(block, 1).T


def _with_border(team: Team, bodies: OwnBodies, asked: AskedOfFactors) -> Any:
    """``[[K, B^T], [B, 0]]``, whose last rows the last rank has; MUMPS is given its upper triangle, without B."""
    m, last = asked.border.shape[1], team.rank == team.size - 1
    if not m and not team.total(float(asked.springs.any())):
        return bodies.K
    indptr, indices, data = bodies.K.getValuesCSR()
    first, width = bodies.K.getOwnershipRange()[0], bodies.K.getSize()[1]
    count = len(asked.springs)
    own = sp.csr_array((data, indices, indptr), shape=(count, width))
    springs = sp.csr_array((asked.springs, first + np.arange(count), np.arange(count + 1)), shape=own.shape)
    rows = sp.hstack([own + springs, asked.border], format="csr")
    if last:
        diagonal = sp.csr_array((np.zeros(m), width + np.arange(m), np.arange(m + 1)), shape=(m, width + m))
        rows = sp.csr_array(
            (
                np.concatenate([rows.data, diagonal.data]),
                np.concatenate([rows.indices, diagonal.indices]),
                np.concatenate([rows.indptr, rows.indptr[-1] + diagonal.indptr[1:]]),
            ),
            shape=(count + m, width + m),
        )
    A = matrix(team, sp.csr_array(rows), rows.shape[0])
    A.setOption(A.Option.SYMMETRIC, True)
    return A


def _petsc(name: str, *given: Any) -> None:
    """Call a function of PETSc's library; objects of petsc4py are their handles there."""
    words = [ctypes.c_void_p(one.handle) if hasattr(one, "handle") else one for one in given]
    failed = getattr(ctypes.CDLL(PETSc.__file__), name)(*words)
    if failed:
        raise PETSc.Error(failed)


def hold_factors(team: Team, asked: AskedOfFactors, bodies: int, number: int) -> FactorsMade:
    """Factorise the bodies with all other ranks, and keep the factors.

    Parameters
    ----------
    team, asked : the ranks and what this one adds
    bodies, number : under which bodies are held, and the factors will be
    """
    made = OwnFactors(team, team.held[bodies], asked)
    team.held[number] = made
    return made.made


def solve_factors(team: Team, f: Array, number: int) -> Array:
    """(own, k) Displacements under forces (own, k), see `OwnFactors.solved`.

    Parameters
    ----------
    team, f : the ranks, and forces on what is this one's
    number : under which the factors are held
    """
    found: OwnFactors = team.held[number]
    return found.solved(f)


def diagonal_of(team: Team, number: int) -> Array:
    """(own,) The diagonal of the bodies.

    Parameters
    ----------
    team, number : the ranks, and under which the bodies are held
    """
    bodies: OwnBodies = team.held[number]
    return np.array(bodies.K.getDiagonal().array)


def rows_of(team: Team, wanted: IntArray, number: int) -> sp.csr_array:
    """(k, unknowns) Some rows of the bodies.

    Parameters
    ----------
    team : the ranks
    wanted : (k,) numbers of this rank's own rows
    number : under which the bodies are held
    """
    bodies: OwnBodies = team.held[number]
    first, width = bodies.K.getOwnershipRange()[0], bodies.K.getSize()[1]
    found = [bodies.K.getRow(int(row)) for row in first + wanted]
    indptr = np.cumsum([0, *(len(columns) for columns, _ in found)])
    columns = np.concatenate([np.zeros(0, np.int64), *(columns for columns, _ in found)])
    values = np.concatenate([np.zeros(0), *(values for _, values in found)])
    return sp.csr_array((values, columns, indptr), shape=(len(wanted), width))
