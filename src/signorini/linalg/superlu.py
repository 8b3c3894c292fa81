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

from signorini.arrays import Array, Int32Array, IntArray
from signorini.linalg.definite import SUSPICIOUS_PIVOT, check_energy
from signorini.linalg.ordering import nested_dissection, unknowns
from signorini.linalg.protocol import NotPositiveDefinite, Reduced
from signorini.linalg.system import System, WithSchur, as_columns, interface_lift, like, node_graph


@dataclass(frozen=True, kw_only=True)
class SuperLUFactorisation(WithSchur):
    """Factors of ``K + D``, whose solves are told apart into halves by ``S' = S + D``.

    Attributes
    ----------
    interface : (m,) unknowns that are not eliminated
    lu : of ``K + D`` in the order of elimination
    order : (n,) unknowns in that order, interface last
    lifted : (m, m) S'
    """

    interface: IntArray
    lu: SuperLU = field(repr=False)
    order: Int32Array = field(repr=False)
    lifted: Array = field(repr=False)
    name: str = "superlu"
    plan: None = None

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load: with none on the interface ``S' u_c = -K_ci K_ii^-1 f_i``."""
        load = as_columns(f, self.n)
        inner = load.copy()
        inner[self.interface] = 0.0
        u = self._solve(inner)
        gathered = self.lifted @ u[self.interface]
        return Reduced(like(f, load[self.interface] + gathered), lambda u_c: self._expand(f, inner, gathered, u_c))

    def _expand(self, f: Array, inner: Array, gathered: Array, u_c: Array) -> Array:
        edge, given = as_columns(u_c, self.m), inner.copy()
        given[self.interface] = self.lifted @ edge - gathered
        u = self._solve(given)
        u[self.interface] = edge
        return like(f, u)

    def _solve(self, load: Array) -> Array:
        u = np.empty_like(load)
        u[self.order] = self.lu.solve(load[self.order])
        return u


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
    graph = node_graph(system)
    order = np.concatenate([unknowns(graph, nested_dissection(graph)), system.interface.astype(np.int32)])
    shift = interface_lift(system)
    lu = _without_pivoting(system, order, shift)
    if lu is None:  # a pivot was exactly 0: lift it just enough to find the motion without resistance
        lu = _without_pivoting(system, order, shift + np.finfo(np.float64).eps * np.abs(diagonal))
        if lu is None:
            raise NotPositiveDefinite(int(order[0]))
        check_energy(system, _unpack(system, order, lu, shift))
        raise NotPositiveDefinite(int(order[0]))
    factor = _unpack(system, order, lu, shift)
    pivot, entry = lu.U.diagonal()[lu.perm_c[: system.n - system.m]], diagonal[order[: system.n - system.m]]
    if np.any(bad := pivot <= 0):
        raise NotPositiveDefinite(int(order[np.argmax(bad)]))
    if np.any(pivot < SUSPICIOUS_PIVOT * entry):
        check_energy(system, factor)
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
    """Take ``S' = L_cc D_c L_cc^T``.

    SuperLU's postorder may put one body after the interface of another; but an unknown of the interface has no
    descendant except above it in the given order, so that L_cc is lower triangular all the same.
    """
    last = lu.perm_c[system.n - system.m :]
    corner = lu.L.tocsr()[last][:, last].toarray()
    S = (corner * lu.U.diagonal()[last]) @ corner.T
    S = (S + S.T) / 2
    condensed = S - np.diag(shift[system.interface])
    condensed.flags.writeable = False
    return SuperLUFactorisation(
        n=system.n,
        m=system.m,
        interface=system.interface,
        lu=lu,
        order=order,
        lifted=S,
        condensed=condensed,
    )
