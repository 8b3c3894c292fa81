# SPDX-License-Identifier: BSD-3-Clause
"""What every rank does for factors: it gives MUMPS its rows of the bodies, and solves for loads with the others.

MUMPS leaves the unknowns of the interface out of the elimination and hands their Schur complement to the first rank.
petsc4py does not know of that, so that functions of PETSc are called by their names in its library.

MUMPS keeps the memory that it worked in as long as its factors, and beside many pairs that is several matrices of
their size, most of it for their rows of the factor, which nobody asks for again. Then bodies are factorised twice: with
the interface, whose factor is discarded as it is made, and alone, to be solved with.

References
----------
Amestoy, Duff, L'Excellent, Koster (2001), A fully asynchronous multifrontal solver using distributed dynamic
scheduling, SIAM J. Matrix Anal. Appl. 23:15; MUMPS users' guide: ICNTL, CNTL, INFOG and "Schur complement".
"""

from __future__ import annotations

import ctypes
import weakref
from copy import copy
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from petsc4py import PETSc

from signorini.arrays import Array, IntArray
from signorini.distributed.multigrid import matrix, set_options
from signorini.distributed.parts import OwnBodies
from signorini.distributed.ranks import Team
from signorini.distributed.room import Room, room_for
from signorini.linalg._dense_tiles import mirror

_OPTIONS = {
    "mat_mumps_icntl_7": 5,  # the order of elimination is METIS's, or minimum degree where MUMPS has no METIS
    "mat_mumps_icntl_14": 40,  # per cent of memory beyond what MUMPS expects, which borders and many ranks exceed
    "mat_mumps_cntl_1": 0.0,  # no pivoting: the interior is positive definite, or it is refused
}
_ONLY_INSIDE = 26, 0  # ICNTL: solves leave out the unknowns of the Schur complement
_STATUS, _DETAIL, _NEGATIVE = 1, 2, 12  # numbers in INFOG: how it ended, what more is said of it, pivots below 0
_OPERATIONS = 3  # number in RINFOG
_MEGABYTES = 15  # number in INFO: what a rank will take, which is known before anything is factorised
_DISCARDED = "mat_mumps_icntl_31"  # whether factors are dropped as they are made, for their Schur complement alone
_WIDE = 4  # entries of the interface to one of the bodies from which these are factorised twice
_DENSE = 4.0  # matrices of the size of the interface that the first rank holds at once, as one process does
_INFORMATION = 64  # numbers that have room for what PETSc says to a factorisation, of which MUMPS hears nothing


class AskedOfFactors(NamedTuple):
    """What a rank adds to its rows of the bodies.

    Attributes
    ----------
    springs : (own,) on the diagonal; they are there, and filled in there
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
    operations : of the factorisation with the interface, as MUMPS has counted them

    Parameters
    ----------
    team : the ranks
    bodies : rows of the bodies
    asked : what is added to them
    """

    def __init__(self, team: Team, bodies: OwnBodies, asked: AskedOfFactors) -> None:
        self._team, self._own = team, len(asked.springs)
        interface, none = asked.interface, np.zeros(0, dtype=np.int64)
        self._count = int(team.total(len(interface)))
        self._wide = self._count**2 > _WIDE * int(team.total(bodies.K.getInfo(PETSc.Mat.InfoType.LOCAL)["nz_used"]))
        self._whole = _Elimination(team, _with_border(team, bodies, asked), interface, discarded=self._wide)
        self._inside = _Elimination(team, _inside(team, bodies, asked), none) if self._wide else self._whole
        self._dense = 8.0 * len(interface) ** 2

    def made(self) -> FactorsMade:
        """Factorise where that fits, and hand over the Schur complement; called once."""
        whole, inside = self._whole, self._inside
        asked = inside.bytes + _DENSE * self._dense
        room = room_for(self._team, max(asked, whole.bytes + self._dense))
        fits, condensed = room.asked <= room.free, None
        if fits:
            whole.factorise()
        status, detail, negative = whole.end
        self.operations = whole.operations
        if fits and status >= 0:
            condensed = whole.condensed(self._count) if self._team.first else None
            if self._wide:
                whole.destroy()
                inside.factorise()
                status, detail, again = inside.end
                negative = max(negative, again)
            elif self._count:
                inside.matrix.setMumpsIcntl(*_ONLY_INSIDE)
        del self._whole
        return FactorsMade(status, detail, negative, room, condensed)

    def solved(self, f: Array) -> Array:
        """(own, k) Displacements under forces (own, k) on what is eliminated, where the interface is held."""
        result, (x, b) = np.empty_like(f), self._inside.vectors
        for k, forces in enumerate(f.T):
            b.array[: self._own], b.array[self._own :] = forces, 0.0
            self._inside.matrix.solve(b, x)
            result[:, k] = x.array[: self._own]
        return result


class _Elimination:
    """A matrix of all ranks as MUMPS eliminates it: analysed, and factorised when that is asked for.

    Attributes
    ----------
    matrix : of the factors
    vectors : an answer and a load
    bytes : what this rank will take for it

    Parameters
    ----------
    team, A : the ranks and the matrix
    interface : (k,) unknowns that are not eliminated, on the first rank; none on the others
    discarded : whether nothing is kept but their Schur complement
    """

    def __init__(self, team: Team, A: Any, interface: IntArray, *, discarded: bool = False) -> None:
        self._A, self._solver = copy(A), PETSc.KSP().create(team.comm)  # others may go on with theirs
        self._solver.setOperators(A)
        self._solver.setType("preonly")
        factors = self._solver.getPC()
        factors.setType("cholesky")
        factors.setFactorSolverType("mumps")
        set_options(self._solver, "signorini_mumps_", _OPTIONS | {_DISCARDED: int(discarded)})
        self._solver.setErrorIfNotConverged(False)
        self._solver.setFromOptions()
        factors.setFactorSetUpSolverType()
        self.matrix, self.vectors = factors.getFactorMatrix(), A.createVecs()
        self._kept = PETSc.IS().createGeneral(interface.astype(PETSc.IntType), comm=team.comm)
        if self._kept.getSize():
            _petsc("MatFactorSetSchurIS", self.matrix, self._kept)
        self._information = (ctypes.c_double * _INFORMATION)()
        _petsc("MatFactorInfoInitialize", ctypes.byref(self._information))
        _petsc("MatCholeskyFactorSymbolic", self.matrix, A, None, ctypes.byref(self._information))
        self.bytes = 1e6 * self.matrix.getMumpsInfo(_MEGABYTES)

    def factorise(self) -> None:
        """Factorise; `end` says how that went."""
        _petsc("MatCholeskyFactorNumeric", self.matrix, self._A, ctypes.byref(self._information))

    @property
    def end(self) -> tuple[int, int, int]:
        """Status, detail and pivots below 0, see `FactorsMade`."""
        status, detail, negative = (self.matrix.getMumpsInfog(number) for number in (_STATUS, _DETAIL, _NEGATIVE))
        return status, detail, negative

    @property
    def operations(self) -> float:
        """Of the factorisation."""
        return float(self.matrix.getMumpsRinfog(_OPERATIONS))

    def condensed(self, count: int) -> Array:
        """(k, k) The Schur complement where MUMPS has left it, in the lower triangle, by columns; nothing is copied."""
        if not count:
            return np.zeros((0, 0))
        found, status = ctypes.c_void_p(), ctypes.c_int()
        _petsc("MatFactorGetSchurComplement", self.matrix, ctypes.byref(found), ctypes.byref(status))
        S = np.asarray(_Entries(found.value, count))
        mirror(S.T, 0, len(S))  # it comes with its upper triangle
        _petsc("MatFactorRestoreSchurComplement", self.matrix, ctypes.byref(found), status)
        return S

    def destroy(self) -> None:
        """Give back what it takes; all ranks together."""
        for held in (*self.vectors, self.matrix, self._solver, self._kept, self._A):
            held.destroy()


class _Entries:
    """Numbers of a dense matrix of PETSc's, as NumPy asks for them: they live as long as somebody has them.

    Parameters
    ----------
    matrix : address of the matrix, which others may let go
    count : of its rows and columns
    """

    def __init__(self, matrix: int | None, count: int) -> None:
        own, entries = ctypes.c_void_p(matrix), ctypes.c_void_p()
        _petsc("PetscObjectReference", own)
        _petsc("MatDenseGetArray", own, ctypes.byref(entries))
        data = entries.value
        _petsc("MatDenseRestoreArray", own, ctypes.byref(entries))
        weakref.finalize(self, _petsc, "MatDestroy", ctypes.byref(own)).atexit = False  # PETSc has ended by then
        self.__array_interface__ = {"data": (data, False), "shape": (count, count), "typestr": "<f8", "version": 3}


def _inside(team: Team, bodies: OwnBodies, asked: AskedOfFactors) -> Any:
    """The bodies where the interface, unknowns of theirs or all of the border, is held."""
    alone = asked._replace(border=sp.csr_array((len(asked.springs), 0)))
    if asked.border.shape[1]:
        return _with_border(team, bodies, alone)
    held = team.comm.bcast(asked.interface).astype(PETSc.IntType)
    first, last = bodies.K.getOwnershipRange()
    springs = asked.springs.copy()
    springs[held[(held >= first) & (held < last)] - first] += 1.0  # an entry on the diagonal, whose value goes
    found = _with_border(team, bodies, alone._replace(springs=springs))
    found.zeroRowsColumns(held if team.first else held[:0])
    return found


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


def hold_factors(team: Team, asked: AskedOfFactors, bodies: int, springs: int, number: int) -> FactorsMade:
    """Factorise the bodies with all other ranks, and keep the factors.

    Parameters
    ----------
    team, asked : the ranks and what this one adds
    bodies, springs, number : under which bodies and springs are held, and the factors will be
    """
    own: OwnBodies = team.held[bodies]
    asked = asked._replace(springs=own.padded(team.held[springs]))
    factors = team.held[number] = OwnFactors(team, own, asked)
    return factors.made()


def solve_factors(team: Team, f: Array, number: int) -> Array:
    """(own, k) Displacements under forces (own, k), see `OwnFactors.solved`.

    Parameters
    ----------
    team, f : the ranks, and forces on what is this one's
    number : under which the factors are held
    """
    found: OwnFactors = team.held[number]
    return found.solved(f)


def solved_there(team: Team, free: Array, bodies: int, number: int) -> Array:
    """Free displacements of this rank under forces on them, see `OwnFactors.solved`.

    Parameters
    ----------
    team, free : the ranks, and forces on the free displacements of this one
    bodies, number : under which bodies and factors are held
    """
    own: OwnBodies = team.held[bodies]
    return solve_factors(team, own.padded(free)[:, None], number)[own.at, 0]


def arbitrary_load(team: Team, diagonal: Array) -> Array:
    """A load that no motion is orthogonal to, of the size of the diagonal; another on every rank.

    Parameters
    ----------
    team, diagonal : the ranks, and the diagonal of the free displacements of this one
    """
    random = np.random.default_rng(team.rank)
    size = np.sqrt(np.abs(diagonal)) * random.uniform(0.5, 1.5, len(diagonal))
    load: Array = size * random.choice([-1.0, 1.0], len(diagonal))
    return load


def diagonal_of(team: Team, number: int) -> Array:
    """The diagonal of the bodies, of the free displacements of this rank.

    Parameters
    ----------
    team, number : the ranks, and under which the bodies are held
    """
    bodies: OwnBodies = team.held[number]
    return np.array(bodies.K.getDiagonal().array[bodies.at])


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
