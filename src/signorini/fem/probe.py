# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at some places of the bodies: only cells around them are looked at, in any number of states."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.elasticity import elasticities, elasticity
from signorini.fem.kinematics import Group, groups
from signorini.fem.path import located
from signorini.fem.space import Space
from signorini.fem.stress import DeformedBodies, nodal_averages
from signorini.model.model import Model

_DEPTH = 1e-3  # of a cell: how far below a surface stresses are compared with those on it


@dataclass(frozen=True, kw_only=True, eq=False)
class StressProbe:
    """Places whose stresses are weighted sums of those at nodes of bodies.

    Attributes
    ----------
    space, model : of the bodies
    body : (p,) index of the body of every place
    nodes : (e, 2) bodies and nodes that they depend on
    weights : (p, e) of these
    within : the cells around them
    slopes : (p, e) weights of derivatives along a direction, per length; None where none is asked for
    """

    space: Space
    model: Model
    body: IntArray
    nodes: IntArray
    weights: sp.csr_array
    within: tuple[Group, ...]
    slopes: sp.csr_array | None = None

    @classmethod
    def of(cls, space: Space, model: Model, nodes: IntArray, weights: sp.csr_array, body: IntArray) -> StressProbe:
        """Places by the nodes that they depend on; the arguments are the attributes ``space`` to ``body``.

        Parameters
        ----------
        space, model, nodes, weights, body : see `StressProbe`
        """
        wanted = np.zeros((len(model.bodies), len(space.mesh.points)), bool)
        wanted[nodes[:, 0], nodes[:, 1]] = True
        for j in range(len(model.cyclic_symmetries)):  # cells beside a sector are those at its other side
            _, first, second = cyclic_sides(space, model, j)
            wanted[:, first] = wanted[:, second] = wanted[:, first] | wanted[:, second]
        within = []
        for group in groups(space, model):
            own = wanted[group.body[:, None], group.cells].any(axis=1)
            if own.any():
                within.append(replace(group, index=group.index[own], body=group.body[own]))
        return cls(space=space, model=model, body=body, nodes=nodes, weights=weights, within=tuple(within))

    @classmethod
    def at_nodes(cls, space: Space, model: Model, nodes: IntArray) -> StressProbe:
        """At nodes of bodies.

        Parameters
        ----------
        space, model : of the bodies
        nodes : (p, 2) body and node of the mesh
        """
        return cls.of(space, model, nodes, sp.csr_array(sp.eye_array(len(nodes))), nodes[:, 0])

    @classmethod
    def at_points(cls, space: Space, model: Model, points: Array, body: IntArray) -> StressProbe:
        """At points (p, k, d) of which every place is the mean of k, between the nodes of their cells.

        Parameters
        ----------
        space, model : of the bodies
        points : undeformed coordinates, length
        body : (p,) index of the body of every place

        Raises
        ------
        InputError
            If a point lies outside its body.
        """
        count, k = points.shape[:2]
        rows, columns, values = [], [], []
        for own in np.unique(body):
            places = np.flatnonzero(body == own)
            for block, index, cells, shape in located(space, model, points[places].reshape(-1, points.shape[2]), own):
                nodes = block.cells[cells]
                rows.append(np.repeat(places[index // k], nodes.shape[1]))
                columns.append(np.column_stack([np.full(nodes.size, own), nodes.ravel()]))
                values.append(shape.ravel() / k)
        every, at = np.unique(np.concatenate(columns), axis=0, return_inverse=True)
        found = sp.coo_array((np.concatenate(values), (np.concatenate(rows), at.ravel())), shape=(count, len(every)))
        return cls.of(space, model, every, found.tocsr(), body)

    @classmethod
    def together(cls, probes: Sequence[StressProbe]) -> StressProbe:
        """The places of several probes of one model, one after the other."""
        first = probes[0]
        nodes = np.concatenate([probe.nodes for probe in probes])
        weights = sp.block_diag([probe.weights for probe in probes], format="csr")
        return cls.of(first.space, first.model, nodes, sp.csr_array(weights), np.concatenate([p.body for p in probes]))

    @classmethod
    def on_surface(cls, space: Space, model: Model, nodes: IntArray, inward: Array) -> StressProbe:
        """At nodes of surfaces, with the derivatives into the bodies there.

        Parameters
        ----------
        space, model : of the bodies
        nodes : (p, 2) body and node of the mesh
        inward : (p, d) unit normals

        Raises
        ------
        InputError
            If a normal leaves its body at once, at the end of a side.
        """
        points = model.mesh.points[nodes[:, 1]]
        depth = _DEPTH * _cell_sizes(space, nodes[:, 1])
        here = cls.at_nodes(space, model, nodes)
        below = cls.at_points(space, model, (points + depth[:, None] * inward)[:, None], nodes[:, 0])
        both, p = cls.together([here, below]), len(nodes)
        slopes = sp.diags_array(1.0 / depth) @ (both.weights[p:] - both.weights[:p])
        return replace(both, body=nodes[:, 0], weights=both.weights[:p], slopes=sp.csr_array(slopes))

    def stress(self, deformed: DeformedBodies) -> tuple[Array, Array]:
        """(p, 6) Stresses of bodies in one state, as those of `signorini.fem.stress.body_stresses`, and derivatives.

        Derivatives are (0, 6) where none are asked for.
        """
        components = elasticities(self.model).shape[1]
        found = deformed.in_space(self._at_nodes(deformed.stress, components), self.nodes[:, 1])
        slopes = np.zeros((0, 6)) if self.slopes is None else self.slopes @ found
        return np.asarray(self.weights @ found), np.asarray(slopes)

    def mean(self, at_best: Callable[[Group], Array], components: int) -> Array:
        """(p, components) Values that cells have at their best points, see `signorini.fem.stress.nodal_averages`."""
        return np.asarray(self.weights @ self._at_nodes(at_best, components))

    def elastic_strain(self, stress: Array) -> Array:
        """Strains (p, ..., 6), as tensors, that stresses (p, ..., 6) are due to."""
        kind = "3d" if self.model.components == 3 else "plane strain"
        C = np.array([np.linalg.inv(elasticity(body.material, kind)) for body in self.model.bodies])
        strain, n = np.zeros_like(stress), C.shape[1]
        strain[..., :n] = np.einsum("pcd,p...d->p...c", C[self.body], stress[..., :n])
        strain[..., 3:] *= 0.5
        return strain

    def _at_nodes(self, at_best: Callable[[Group], Array], components: int) -> Array:
        """(e, components) Averages at the nodes."""
        found = np.zeros((len(self.nodes), components))
        for body, (nodes, values) in enumerate(
            nodal_averages(self.space, self.model, at_best, components, self.within)
        ):
            own = self.nodes[:, 0] == body
            found[own] = values[np.searchsorted(nodes, self.nodes[own, 1])]
        return found


def _cell_sizes(space: Space, nodes: IntArray) -> Array:
    """(p,) Smallest extents of the cells at nodes, length."""
    smallest = np.full(len(space.mesh.points), np.inf)
    for block in space.blocks:
        size = np.ptp(space.mesh.points[block.cells], axis=1).min(axis=1)
        np.minimum.at(smallest, block.cells, size[:, None])
    return np.asarray(smallest[nodes])
