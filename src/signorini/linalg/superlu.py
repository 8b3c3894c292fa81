# SPDX-License-Identifier: BSD-3-Clause
"""The plain back end and referee: SuperLU of SciPy on a nested dissection order, the interface last.

Without pivoting the factors of the whole matrix contain the Schur complement: ``S = L_cc U_cc`` [Davis2006]_. A
diagonal D is added to the interface before and taken off S after, since S alone may be singular.

References
----------
.. [Davis2006] Davis, Direct Methods for Sparse Linear Systems, SIAM, section 6.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from signorini.arrays import Array
from signorini.linalg._triangular import solve_lower, solve_lower_transposed
from signorini.linalg.definite import SUSPICIOUS_PIVOT, check_energy
from signorini.linalg.ordering import elimination_order
from signorini.linalg.protocol import NotPositiveDefinite, Reduced
from signorini.linalg.system import Int32Array, System, as_columns, interface_lift, like, node_graph


@dataclass(frozen=True, kw_only=True)
class SuperLUFactorisation:
    """``K_ii = L D L^T`` with unit lower triangular L, and the rows ``K_ci L^-T D^-1`` of the interface below it.

    Attributes
    ----------
    order : (n,) unknowns in their order of elimination, interface last
    lower : (n, n - m) columns of L, the diagonal left out
    pivot : (n - m,) D
    """

    n: int
    m: int
    order: Int32Array
    lower: sparse.csc_array
    pivot: Array
    condensed: Array = field(repr=False)
    name: str = "superlu"

    @property
    def nnz_factor(self) -> int:
        """Entries of the factor."""
        return int(self.lower.nnz) + len(self.pivot)

    def schur(self) -> Array:
        """Give S, (m, m)."""
        return self.condensed.copy()

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load."""
        y = as_columns(f, self.n)[self.order]
        solve_lower(self.lower.indptr, self.lower.indices, self.lower.data, y)
        return Reduced(like(f, y[self.n - self.m :]), lambda u_c: self._expand(f, y.copy(), u_c))

    def _expand(self, f: Array, y: Array, u_c: Array) -> Array:
        inside = self.n - self.m
        y[:inside] /= self.pivot[:, None]
        y[inside:] = as_columns(u_c, self.m)
        solve_lower_transposed(self.lower.indptr, self.lower.indices, self.lower.data, y)
        u = np.empty_like(y)
        u[self.order] = y
        return like(f, u)

    def held(self, load: Array) -> Array:
        """Give the displacement with the interface held."""
        return self.reduce(load).expand(np.zeros(self.m))


def factorise(system: System) -> SuperLUFactorisation:
    """Factorise by SuperLU.

    Raises
    ------
    NotPositiveDefinite
        If the interior is singular or indefinite.
    """
    diagonal = system.matrix.diagonal()
    if np.any(bad := (diagonal <= 0) & system.inside):
        raise NotPositiveDefinite(int(np.argmax(bad)))
    order = np.concatenate([elimination_order(node_graph(system)), system.interface.astype(np.int32)])
    shift = interface_lift(system)
    lu = _without_pivoting(system, order, shift)
    if lu is None:  # a pivot was exactly 0: lift it just enough to find the motion without resistance
        lu = _without_pivoting(system, order, shift + np.finfo(np.float64).eps * np.abs(diagonal))
        if lu is None:
            raise NotPositiveDefinite(int(order[0]))
        check_energy(system, _unpack(system, order, lu, shift).held)
        raise NotPositiveDefinite(int(order[0]))
    factor = _unpack(system, order, lu, shift)
    entry = diagonal[factor.order[: len(factor.pivot)]]
    if np.any(bad := factor.pivot <= 0):
        raise NotPositiveDefinite(int(factor.order[np.argmax(bad)]))
    if np.any(factor.pivot < SUSPICIOUS_PIVOT * entry):
        check_energy(system, factor.held)
    return factor


def _without_pivoting(system: System, order: Int32Array, shift: Array) -> SuperLU | None:
    """Factorise in the given order, up to a postorder of SuperLU's own; None where a pivot is exactly 0."""
    K = (system.matrix + sparse.diags_array(shift, format="csr"))[order][:, order].tocsc()
    K.indptr, K.indices = K.indptr.astype(np.int32), K.indices.astype(np.int32)
    try:
        lu = splu(K, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:
        return None
    return lu if np.array_equal(lu.perm_r, lu.perm_c) else None


def _unpack(system: System, order: Int32Array, lu: SuperLU, shift: Array) -> SuperLUFactorisation:
    """Take the interior columns of L, D, and ``S = L_cc D_c L_cc^T - shift``.

    SuperLU's postorder may put one body after the interface of another; interior unknowns are moved first again, which
    keeps L lower triangular, for an unknown of the interface has no descendant but above it in the given order.
    """
    inside = system.n - system.m
    place = np.argsort(lu.perm_c)  # place[p]: which entry of `order` SuperLU put at p
    final = np.concatenate([place[place < inside], np.arange(inside, system.n)])
    pick = lu.perm_c[final]
    lower = lu.L.tocsc()[:, pick][pick].tocsc()
    pivot = lu.U.diagonal()[pick]
    lower.eliminate_zeros()
    corner = lower[inside:, inside:].toarray()
    S = (corner * pivot[inside:]) @ corner.T - np.diag(shift[system.interface])
    return SuperLUFactorisation(
        n=system.n,
        m=system.m,
        order=order[final],
        lower=sparse.tril(lower, -1, format="csc")[:, :inside],
        pivot=pivot[:inside],
        condensed=(S + S.T) / 2,
    )
