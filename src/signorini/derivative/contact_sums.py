# SPDX-License-Identifier: BSD-3-Clause
"""Sums over a history of products of adjoint and actual displacements, from those of the contact nodes alone.

At point i both are those of the contact dofs, E w_i and E u_i with E what follows them inside, and a few fields more,

    w_i = T (E w_i + y_i),    u_i = T E u_i + sum_loads f_i l,

l of the loads with the contact held, y of what pulls on displacements directly. What a parameter makes of K counts by
``sum_i w_i . K' u_i``: of that ``E (sum_i w_i u_i^T) E^T``, where K' has entries, is found without a displacement, in
the time of two factorisations however many points there are; the rest is as many products as there are loads.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.condense.response import ByNodes
from signorini.derivative.adjoint_terms import Adjoint
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.low_rank import state_blocks, term_blocks
from signorini.derivative.points import TapePoint
from signorini.fem.displacement_products import Products
from signorini.fem.node_work import add_node_work
from signorini.fem.stiffness import reduced_stiffness
from signorini.linalg.multifrontal import MultifrontalFactorisation
from signorini.linalg.protocol import Reduced

_SUBSTITUTED = 12  # points of a history: up to so many it takes less time to substitute each back


class ContactSums:
    """Sums over points of the same bodies, which are condensed onto contact nodes.

    Parameters
    ----------
    points : of the history
    numbers : of those that the sums are over
    adjoint : of the output

    Attributes
    ----------
    system : the interface
    motion, forces : (d a, p) J, and the forces of the active pairs
    one : (p,) ones
    factors : by load, (p,)
    """

    def __init__(self, points: Sequence[TapePoint], numbers: Sequence[int], adjoint: Adjoint) -> None:
        self.system = points[numbers[0]].system
        names, right = state_blocks([points[i] for i in numbers])
        left = term_blocks(self.system, numbers, adjoint)
        (h, r, known, offset), (J, resultant) = ([np.moveaxis(part, 0, -1) for part in side] for side in (right, left))
        self.motion, self.forces = J.reshape(-1, len(numbers)), r.reshape(-1, len(numbers))
        self.one = known[0]
        self.factors = {name: factor for name, factor in zip(names, known[1:], strict=True) if factor.any()}
        condensed, m = self.system.condensed, len(self.system.condensed.dofs)
        still, load = np.zeros((m, len(numbers))), np.zeros((m, len(numbers)))
        for name, factor in self.factors.items():
            load += np.outer(self.system.unit(name).load, factor)
        self._w = condensed.response.displacement(Reduced(still, _kept), self.motion, lambda _: resultant)
        self._u = condensed.displacement(Reduced(load, _kept), h, r, offset)
        self._pulled = {k: adjoint.pulled[i] for k, i in enumerate(numbers) if i in adjoint.pulled}

    @staticmethod
    def knows(system: InterfaceSystem, points: int) -> bool:
        """Whether the bodies are condensed onto contact nodes, by a factorisation that knows products, for many points.

        Parameters
        ----------
        system, points : the interface, and how many points the sums are over
        """
        response = system.condensed.response
        by_nodes = isinstance(response, ByNodes) and isinstance(response.factorisation, MultifrontalFactorisation)
        return by_nodes and points > _SUBSTITUTED

    def of_stiffness(self, K: sp.csr_array) -> float:
        """The sum of ``w_i . K u_i``, for a matrix (dofs, dofs) that has entries where the stiffness has some."""
        of_free = reduced_stiffness(K, self._transform)
        w, u = self.fields
        return float(self.products(of_free) @ of_free.data + np.vdot(w, K @ u))

    def products(self, of_free: sp.csr_array) -> Array:
        """(nnz,) Of the entries of a matrix of free displacements, the sum without `fields`, both triangles in one."""
        response = self.system.condensed.response
        assert isinstance(response.factorisation, MultifrontalFactorisation)
        M = self._w @ self._u.T
        return response.factorisation.products(0.5 * (M + M.T), of_free)

    def by_places(self) -> Array:
        """(nodes d,) How the sum of ``w_i . K u_i`` changes with the place of every node."""
        prepared = self.system.prepared
        found = np.zeros_like(prepared.space.mesh.points)
        add_node_work(found, prepared.space, prepared.model, self._of_cells())
        return found.ravel()

    def _of_cells(self) -> Products:
        """The sum for dofs that share a cell; no dof follows from others in equations."""
        K, prepared = self.system.prepared.K, self.system.prepared
        of_free = reduced_stiffness(sp.csr_array((np.ones(K.nnz), K.indices, K.indptr), K.shape), self._transform)
        w, u = (np.ascontiguousarray(part) for part in self.fields)
        indptr, indices = (part.astype(np.int64) for part in (of_free.indptr, of_free.indices))
        free = prepared.constraints.free
        return Products(w, u, free, indptr, indices, self.products(of_free))

    @cached_property
    def fields(self) -> tuple[Array, Array]:
        """(dofs, k) Displacements of both sides beyond those that contact dofs alone cause: k pairs."""
        rows = np.array(list(self.factors.values())).reshape(len(self.factors), len(self.one))
        first, second = [self._inside[:, : len(rows)]], [self._lifted]
        for at, (k, y) in enumerate(self._pulled.items()):
            first.append((self._transform @ y)[:, None])
            second.append(self._inside[:, len(rows) + at, None] + self._lifted @ rows[:, k, None])
        return np.concatenate(first, axis=1), np.concatenate(second, axis=1)

    @cached_property
    def weighted(self) -> dict[str, Array]:
        """(dofs,) By load, the sum of ``f_i w_i``."""
        found = {name: self._inside[:, at].copy() for at, name in enumerate(self.factors)}
        for k, y in self._pulled.items():
            for name, factor in self.factors.items():
                found[name] += factor[k] * (self._transform @ y)
        return found

    def on_contact(self, rows: sp.csr_array) -> tuple[Array, Array]:
        """(k, p) Rows (k, dofs) that meet the contact dofs alone, times adjoint and actual displacements."""
        kept = sp.csr_array(rows @ self._transform)[:, self.system.condensed.dofs]
        w, u = np.asarray(kept @ self._w), np.asarray(kept @ self._u)
        for k, y in self._pulled.items():
            w[:, k] += rows @ (self._transform @ y)
        for name, factor in self.factors.items():
            if name in self.system.prepared.constraints.prescribed:
                u += np.outer(rows @ self.system.prepared.constraints.prescribed[name], factor)
        return w, u

    def meets(self, rows: sp.csr_array) -> bool:
        """Whether rows (k, dofs) meet the contact dofs alone, of those that are free."""
        seen = sp.csr_array(rows @ self._transform)
        outside = np.ones(seen.shape[1], dtype=np.bool_)
        outside[self.system.condensed.dofs] = False
        return not (outside[seen.indices] & (seen.data != 0.0)).any()

    @property
    def _transform(self) -> sp.csr_array:
        return self.system.prepared.constraints.transform

    @cached_property
    def _inside(self) -> Array:
        """(dofs, k) Of sums of ``f_i w_i`` by load, and of the points that are pulled, what contact dofs cause."""
        condensed = self.system.condensed
        columns = [self._w @ factor for factor in self.factors.values()] + [self._u[:, k] for k in self._pulled]
        kept = np.array(columns).reshape(len(columns), len(condensed.dofs)).T
        still = condensed.reduce(np.zeros((self._transform.shape[1], kept.shape[1])))
        return np.asarray(self._transform @ still.expand(kept))

    @cached_property
    def _lifted(self) -> Array:
        """(dofs, loads) Displacements under each of the loads while the contact dofs are held."""
        prescribed = self.system.prepared.constraints.prescribed
        columns = [self._transform @ self.system.inside(name) + prescribed.get(name, 0.0) for name in self.factors]
        return np.array(columns).reshape(len(columns), self._transform.shape[0]).T


def _kept(displacements: Array) -> Array:
    """Displacements of the contact dofs as they are, without those that follow them."""
    return displacements
