# SPDX-License-Identifier: BSD-3-Clause
"""The default back end: multifrontal supernodal Cholesky whose last front, the interface, is never eliminated.

What is left on the interface once the interior is eliminated is the condensed matrix: it costs nothing beyond the
factorisation of the interior.

References
----------
Duff, Reid (1983), The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS 9:302.
Liu (1992), The multifrontal method for sparse matrix solution: theory and practice, SIAM Review 34:82.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy import sparse

from signorini.arrays import Array, Int32Array
from signorini.blas_threads import one_thread
from signorini.cores import number_of_threads
from signorini.crew import Crew, Job
from signorini.errors import InputError
from signorini.linalg import _front_products, _front_solves, _fronts
from signorini.linalg._blas import scratch
from signorini.linalg._graph import Elimination, Rows
from signorini.linalg.definite import SUSPICIOUS_PIVOT, check_energy
from signorini.linalg.plan import Plan, Plans, analyse
from signorini.linalg.protocol import NotPositiveDefinite, Reduced
from signorini.linalg.shared_fronts import factorise_parts
from signorini.linalg.system import System, WithSchur, as_columns, like
from signorini.memory import give_memory_back

SHARED_SOLVE = 2e7
"""Entries of the factor times loads from which threads share a solve: tens of milliseconds of one thread."""

_LOADS_AT_ONCE = 16  # loads that one thread solves for: the factor is read once for all of them


@dataclass(frozen=True, kw_only=True)
class MultifrontalFactorisation(WithSchur):
    """``K_ii = L L^T``, the rows ``K_ci L^-T`` of the interface below it, and the condensed matrix.

    Attributes
    ----------
    plan : order, fronts and cost
    factor : the columns of every front
    slots : (m,) the place in `interface` of every unknown there, in order of elimination
    """

    plan: Plan
    factor: Array = field(repr=False)
    slots: Int32Array = field(repr=False)
    name: str = "multifrontal"

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load."""
        columns = as_columns(f, self.n)
        if not columns.any():
            still = np.zeros((self.m, columns.shape[1]))
            return Reduced(like(f, still), lambda u_c: self._expand(f, np.zeros(columns.T.shape), u_c))
        y = np.ascontiguousarray(columns.T[:, self.plan.order])
        self._forward(y)
        g = np.empty((self.m, len(y)))
        g[self.slots] = y[:, self.n - self.m :].T
        return Reduced(like(f, g), lambda u_c: self._expand(f, y.copy(), u_c))

    def _expand(self, f: Array, y: Array, u_c: Array) -> Array:
        y[:, self.n - self.m :] = as_columns(u_c, self.m)[self.slots].T
        self._backward(y)
        u = np.empty((self.n, len(y)))
        u[self.plan.order] = y.T
        return like(f, u)

    def products(self, M: Array, pattern: sparse.csr_array) -> Array:
        """Entries of ``E M E^T``, E the displacements that follow those of the interface, summed over both triangles.

        Parameters
        ----------
        M : (m, m) symmetric, in the order of the interface
        pattern : (n, n) with entries where the matrix has some, in any order; what they are does not matter

        Returns
        -------
        (nnz,) of the entries of the pattern: the product with data of a symmetric matrix is its sum with ``E M E^T``

        Raises
        ------
        InputError
            Where the factor of the matrix has no room for an entry of the pattern.
        """
        rows = Rows(pattern.indptr.astype(np.int32), pattern.indices.astype(np.int32), np.zeros(pattern.nnz))
        place = np.empty(self.n, dtype=np.int32)
        place[self.plan.order] = np.arange(self.n, dtype=np.int32)
        own, elimination = np.ascontiguousarray(M[np.ix_(self.slots, self.slots)]), Elimination(self.plan.order, place)
        with one_thread():
            inside = _front_products.products(self.plan.fronts, self.factor, own, rows, elimination, scratch())
        if not inside:
            raise InputError("the pattern has an entry where the factor has none; expected those of the matrix")
        return rows.data

    def _forward(self, y: Array) -> None:
        """Eliminate the inside of the loads in the rows of y."""
        self._solve([Job(partial(self._halve, _front_solves.forward, some, ())) for some in _some_at_a_time(y)], y)

    def _backward(self, y: Array) -> None:
        """Solve for the inside of the rows of y: front after front, and branches side by side once those above are."""
        above = [(part.begin, part.end) for part in reversed(self.plan.parts) if not part.branch]
        branches = [(part.begin, part.end) for part in self.plan.parts if part.branch]
        jobs: list[Job] = []
        for some in _some_at_a_time(y):
            first = len(jobs)
            jobs.append(Job(partial(self._halve, _front_solves.backward, some, *above)))
            jobs += [Job(partial(self._halve, _front_solves.backward, some, fronts), (first,)) for fronts in branches]
        self._solve(jobs, y)

    def _halve(self, half: Callable[..., None], y: Array, *fronts: tuple[int, ...]) -> None:
        """One half of a solve for the rows of y, of ranges of fronts."""
        work, memory = np.empty(self.plan.widest * len(y)), scratch()
        for some in fronts:
            half(self.plan.fronts, *some, self.factor, y, work, memory)

    def _solve(self, jobs: Sequence[Job], y: Array) -> None:
        """Do what solves for the rows of y: the same jobs whatever number of threads shares them."""
        worth = self.plan.nnz_factor * len(y) > SHARED_SOLVE
        with one_thread(), Crew(number_of_threads() if worth and len(jobs) > 1 else 1) as crew:
            crew.finish(jobs)


def _some_at_a_time(y: Array) -> Iterator[Array]:
    """Rows of y that one thread solves for at once."""
    return (y[first : first + _LOADS_AT_ONCE] for first in range(0, len(y), _LOADS_AT_ONCE))


def factorise(system: System, plans: Plans | None = None) -> MultifrontalFactorisation:
    """Factorise by fronts; ``plans`` keeps the plan for systems of one pattern.

    Raises
    ------
    NotPositiveDefinite
        If the interior is singular or indefinite.
    """
    plan = analyse(system) if plans is None else plans.of(system)
    inside = system.n - system.m
    place = np.empty(system.n, dtype=np.int32)
    place[plan.order] = np.arange(system.n, dtype=np.int32)
    slots = np.empty(system.m, dtype=np.int32)
    slots[place[system.interface] - inside] = np.arange(system.m, dtype=np.int32)
    made = _fronts.Factors(np.empty(plan.fronts.panel[-1]), np.zeros((system.m, system.m)), np.empty(inside))
    tree = _fronts.Tree(plan.fronts, system.rows, Elimination(plan.order, place), slots, made)
    with one_thread():
        if len(plan.parts) > 1:
            give_memory_back()  # what the plan was made with, a tenth of the matrix and more
            with Crew(number_of_threads()) as crew:
                failed = factorise_parts(tree, plan, crew)
        else:
            failed = _fronts.factorise_whole(tree, plan.stacks)
    if failed >= 0:
        raise NotPositiveDefinite(int(plan.order[failed]))
    made.condensed.flags.writeable = False
    result = MultifrontalFactorisation(
        n=system.n, m=system.m, plan=plan, factor=made.columns, condensed=made.condensed, slots=slots
    )
    if np.any(_front_solves.pivots(plan.fronts, made.columns) < SUSPICIOUS_PIVOT * made.diagonal):
        check_energy(system, result)
    return result
