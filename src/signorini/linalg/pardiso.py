# SPDX-License-Identifier: BSD-3-Clause
"""The optional back end: PARDISO of Intel's MKL through pypardiso (``pip install signorini[mkl]``).

PARDISO keeps the interface out of the elimination where parameter 36 is 2, and hands out the Schur complement from
the factorisation; its split solve then stops between the forward and the backward half. It also looks at the pivots of
the interface, so a diagonal is added there before and taken off S after, since S alone may be singular.

References
----------
Schenk, Gartner (2004), Solving unsymmetric sparse systems of linear equations with PARDISO, Future Gener. Comput. Syst.
20:475. Intel oneMKL reference, section "oneMKL PARDISO parameters": iparm(31), iparm(36).
"""

from __future__ import annotations

import copy
import functools
import importlib
import importlib.util
import weakref
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy import sparse

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.linalg import multifrontal
from signorini.linalg.definite import check_energy
from signorini.linalg.protocol import Factorisation, NotPositiveDefinite, Reduced
from signorini.linalg.system import System, WithSchur, as_columns, interface_lift, like

SYMMETRIC_POSITIVE_DEFINITE = 2  # its number among kinds of matrices
SETTINGS = {1: 1, 2: 2, 18: -1, 21: 0, 24: 0}
"""Parameters (counted from 1): own values, METIS order, count the factor, no Bunch-Kaufman, classic factorisation."""

SCHUR, FORWARD, BACKWARD, ANALYSE, FACTORISE, RELEASE = 36, 331, 333, 11, 22, -1
NOT_POSITIVE = -4  # what it returns then
FAILURES = {-1: "inconsistent input", -2: "not enough memory", -3: "reordering", -8: "integers too small", -9: "memory"}


@dataclass(frozen=True, kw_only=True)
class PardisoFactorisation(WithSchur):
    """A factorisation that lives in MKL until this object is collected.

    Attributes
    ----------
    interface : (m,) unknowns that are not eliminated
    upper : the upper triangle that PARDISO was given
    """

    interface: IntArray
    upper: sparse.csr_array = field(repr=False)
    solver: Any = field(repr=False)
    name: str = "pardiso"
    plan: None = None

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load."""
        y = self._half(FORWARD, as_columns(f, self.n))
        return Reduced(like(f, y[self.interface]), lambda u_c: self._expand(f, y.copy(), u_c))

    def _expand(self, f: Array, y: Array, u_c: Array) -> Array:
        y[self.interface] = as_columns(u_c, self.m)
        u = self._half(BACKWARD, y)
        u[self.interface] = as_columns(u_c, self.m)
        return like(f, u)

    def _half(self, phase: int, y: Array) -> Array:
        return _call(self.solver, phase, self.upper, np.asfortranarray(y))


def available() -> bool:
    """Tell whether pypardiso is installed; does not load it."""
    return importlib.util.find_spec("pypardiso") is not None


def factorise(system: System) -> Factorisation:
    """Factorise by PARDISO.

    Raises
    ------
    InputError
        If pypardiso is not installed or does not find MKL, or PARDISO gives up.
    NotPositiveDefinite
        If the interior is singular or indefinite.
    """
    if not available():
        raise InputError("the back end 'pardiso' needs pypardiso: pip install signorini[mkl]")
    if not system.n:
        return multifrontal.factorise(system)  # no unknowns, which MKL calls an inconsistent input
    diagonal = system.matrix.diagonal()
    if np.any(bad := (diagonal <= 0) & system.inside):
        raise NotPositiveDefinite(int(np.argmax(bad)))
    solver = _solver()
    for number, value in SETTINGS.items():
        solver.set_iparm(number, value)
    lift = interface_lift(system)
    upper = _upper(system, lift)
    if system.m:
        solver.set_iparm(SCHUR, 2)
        solver.perm = np.where(system.inside, 0, 1).astype(np.int32)
    flat = np.zeros(system.m**2)
    _call(solver, ANALYSE, upper, flat)
    condensed = _call(solver, FACTORISE, upper, flat).reshape(system.m, system.m)
    result = PardisoFactorisation(
        n=system.n,
        m=system.m,
        interface=system.interface,
        upper=upper,
        solver=solver,
        condensed=_in_order(condensed, system.interface, lift[system.interface]),
    )
    weakref.finalize(result, _call, solver, RELEASE, upper, np.zeros(1))
    check_energy(system, result)
    return result


def _solver() -> Any:
    """A solver of its own; looking for the library, a tenth of a second, is done once."""
    solver = copy.copy(_first_solver())
    solver.pt, solver.iparm = np.zeros_like(solver.pt), np.zeros_like(solver.iparm)
    return solver


@functools.cache
def _first_solver() -> Any:
    try:
        return importlib.import_module("pypardiso").PyPardisoSolver(mtype=SYMMETRIC_POSITIVE_DEFINITE)
    except (ImportError, OSError) as error:  # MKL itself is looked for when a solver is made
        raise InputError(
            f"the back end 'pardiso' does not find MKL ({error}); pip install signorini[mkl], or take another back end"
        ) from error


def _upper(system: System, lift: Array) -> sparse.csr_array:
    """Give the upper triangle of ``K + diag(lift)`` with sorted rows and a full diagonal."""
    return sparse.csr_array(sparse.triu(system.matrix + sparse.diags_array(lift), format="csr"))


def _in_order(condensed: Array, interface: IntArray, lift: Array) -> Array:
    """Permute S from ascending unknowns to the order of the interface; make it symmetric and take the lift off."""
    rank = np.argsort(np.argsort(interface))
    S = condensed[np.ix_(rank, rank)]
    S = (S + S.T) / 2 - np.diag(lift)
    S.flags.writeable = False
    return S


def _call(solver: Any, phase: int, upper: sparse.csr_array, b: Array) -> Array:
    """Run one phase.

    Raises
    ------
    NotPositiveDefinite
        If a pivot is not positive.
    InputError
        For any other failure: memory, most of all.
    """
    from_mkl = importlib.import_module("pypardiso.pardiso_wrapper").PyPardisoError
    solver.set_phase(phase)
    try:
        result: Array = solver._call_pardiso(upper, b)
    except from_mkl as error:
        if error.value != NOT_POSITIVE:
            why = FAILURES.get(error.value, "see its reference")
            raise InputError(
                f"the back end 'pardiso' failed with MKL's error {error.value} ({why}); expected another back end"
            ) from error
        raise NotPositiveDefinite(max(0, int(solver.get_iparm(30)) - 1)) from error
    return result
