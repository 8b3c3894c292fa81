# SPDX-License-Identifier: BSD-3-Clause
"""Facets of one kind, flat or curved: which way is out, how large they are, and integrals over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.fem.facets import facet_nodes, facet_pieces, facet_rule, facet_shapes
from signorini.meshing.facets import facet_corners

_PARALLEL_TOL = 1e-10  # of the largest face: rounding of coordinates is below it


@dataclass(frozen=True, kw_only=True, eq=False)
class FacetBlock:
    """Facets with one number of nodes: edges in the plane, triangles or quadrilaterals in space.

    Attributes
    ----------
    facets : (m, k) nodes. In the plane first and second end, the body on the left of the way between them, and the
        middle; in space corners, anticlockwise seen from outside, then middles
    points : (m, k, d) their coordinates, length
    cells : (m,) numbers of the cells that they bound
    """

    facets: IntArray
    points: Array
    cells: IntArray

    @cached_property
    def nodes(self) -> IntArray:
        """(n,) Sorted nodes."""
        return distinct(self.facets)

    @property
    def dimension(self) -> int:
        """Of space."""
        return int(self.points.shape[2])

    @property
    def count(self) -> int:
        """Nodes of a facet, k."""
        return int(self.facets.shape[1])

    @property
    def corners(self) -> int:
        """Corners of a facet; its other nodes are in the middle of an edge, or of the facet."""
        return facet_corners(self.dimension, self.count)

    @property
    def corner_nodes(self) -> IntArray:
        """(m, 2, 3 or 4) Nodes of the facets that carry pairs."""
        return self.facets[:, : self.corners]

    @property
    def quadratic(self) -> bool:
        """Whether the facets have nodes in the middle."""
        return self.count > self.corners

    @cached_property
    def shapes(self) -> tuple[Array, Array]:
        """Shape functions of a facet at its quadrature points (q, k), and their derivatives (q, k, d - 1)."""
        return facet_shapes(self.count, self.places)

    @cached_property
    def hats(self) -> Array:
        """The linear or bilinear functions of the corners at the quadrature points, (q, corners)."""
        return facet_shapes(self.corners, self.places)[0]

    @cached_property
    def plane_pieces(self) -> Array:
        """(p, 3 or 4, 3) Corners of the plane pieces that stand for faces, piece after piece of every face."""
        reference = facet_pieces(self.count)
        weights = facet_shapes(self.count, reference.reshape(-1, 2))[0].reshape(*reference.shape[:2], -1)
        return np.einsum("sac,mcd->msad", weights, self.points).reshape(-1, reference.shape[1], 3)

    @cached_property
    def parallelograms(self) -> bool:
        """Whether every piece is a triangle or a parallelogram, which quadrature of low degree integrates exactly."""
        corners = self.plane_pieces
        if corners.shape[1] == 3:
            return True
        skew = np.abs(corners[:, 0] - corners[:, 1] + corners[:, 2] - corners[:, 3]).max(initial=0.0)
        return bool(skew <= _PARALLEL_TOL * np.ptp(corners, axis=1).max(initial=0.0))

    @cached_property
    def at(self) -> Array:
        """Quadrature points of every facet, (m, q, d)."""
        return np.einsum("qa,mai->mqi", self.shapes[0], self.points)

    @cached_property
    def outward(self) -> Array:
        """Outward normal at every quadrature point times its share of the length or area, (m, q, d)."""
        return outward_normals(self.points, self.shapes[1]) * self._rule[1][:, None]

    @cached_property
    def weights(self) -> Array:
        """Length or area that belongs to every quadrature point, (m, q)."""
        return np.linalg.norm(self.outward, axis=-1)

    @property
    def lengths(self) -> Array:
        """Of every facet, (m,); in space the side of a square of its area."""
        total: Array = self.weights.sum(axis=1)
        return total if self.dimension == 2 else np.sqrt(total)

    @cached_property
    def normals(self) -> Array:
        """Outward unit normal of every facet, of a curved one the mean, (m, d)."""
        total = self.outward.sum(axis=1)
        normals: Array = total / np.linalg.norm(total, axis=1, keepdims=True) + 0.0
        return normals

    def nodal(self, integrand: Array, *, corners: bool = False) -> Array:
        """``int N_k f`` at every node, (n, ...) in the order of ``nodes``.

        Parameters
        ----------
        integrand : (m, q, ...) f at the quadrature points times what belongs to them, ``weights`` in the plane
        corners : N are the hats of the corners; 0 at other nodes
        """
        shapes = self.hats if corners else self.shapes[0]
        return self._summed(np.einsum("qa,mq...->ma...", shapes, integrand))

    @cached_property
    def nodal_spans(self) -> Array:
        """Outward unit normals of the facets at the nodes times their sizes, summed, (n, d)."""
        own = outward_normals(self.points, facet_shapes(self.count, facet_nodes(self.dimension, self.count))[1])
        length = np.linalg.norm(own, axis=-1)  # 0 where a side of the facet is, at its ends
        own *= (self.weights.sum(axis=1)[:, None] / np.where(length > 0.0, length, 1.0))[..., None]
        return self._summed(own)

    @property
    def level_spans(self) -> Array:
        """Mean normals of the facets times their sizes, summed at the nodes, (n, d)."""
        return self._summed(np.repeat(self.outward.sum(axis=1)[:, None], self.count, axis=1))

    def _summed(self, shares: Array) -> Array:
        """Shares (m, corners or k, ...) of the nodes of facets, summed at every node, (n, ...)."""
        total = np.zeros((len(self.nodes), *shares.shape[2:]))
        np.add.at(total, np.searchsorted(self.nodes, self.facets[:, : shares.shape[1]]), shares)
        return total

    @property
    def places(self) -> Array:
        """Reference coordinates of the quadrature points, (q, d - 1)."""
        return self._rule[0]

    @property
    def _rule(self) -> tuple[Array, Array]:
        return facet_rule(self.dimension, self.count)


def unit_tangents(normals: Array) -> Array:
    """Unit vectors across unit normals (..., d), (..., d - 1, d): in the plane ``(n_y, -n_x)``; ``t1 x t2 = n``."""
    if normals.shape[-1] == 2:
        return np.stack([normals[..., 1], -normals[..., 0]], axis=-1)[..., None, :]
    least = np.eye(3)[np.argmin(np.abs(normals), axis=-1)]
    first = np.cross(normals, least)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    return np.stack([first, np.cross(normals, first)], axis=-2)


def outward_normals(points: Array, slopes: Array) -> Array:
    """Outward normals of facets (m, k, d) from the derivatives (q, k, d - 1) of their shape functions, (m, q, d)."""
    along = np.einsum("qas,mai->mqsi", slopes, points)
    if points.shape[-1] == 2:
        return np.stack([along[..., 0, 1], -along[..., 0, 0]], axis=-1)
    return np.cross(along[..., 0, :], along[..., 1, :])
