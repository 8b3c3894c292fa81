# SPDX-License-Identifier: BSD-3-Clause
"""Pressures and frictions of contacts beside those that recovered stresses have, and those of the mesh before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from signorini.accuracy.bends import bend_squares, contact_modulus, driven_motion
from signorini.accuracy.meshes import is_linear
from signorini.accuracy.recovery import StressError
from signorini.accuracy.sides import side_errors
from signorini.arrays import Array, BoolArray, IntArray, among, padded
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.stress import DeformedBodies
from signorini.model.model import Model
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import ContactResult

_NEAREST = 16
"""Facets whose middles are nearest to a node, of which one is opposite, along its normal."""

_BEYOND_END = 1e-3
"""Of the length of a facet: as far beyond its end a node is still opposite."""

_FULL = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
"""Places of the entries of a tensor in xx, yy, zz, xy, yz, xz."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactErrors:
    """Squares, summed over contacts with their areas, force squared per area.

    Attributes
    ----------
    pressure, friction : of differences
    scale : of the pressures themselves
    nodes : (p,) in the plane, of the differences of both, at corners of both sides; 0 elsewhere
    """

    pressure: float = 0.0
    friction: float = 0.0
    scale: float = 0.0
    nodes: Array | float = 0.0

    def __add__(self, other: ContactErrors) -> ContactErrors:
        return ContactErrors(
            pressure=self.pressure + other.pressure,
            friction=self.friction + other.friction,
            scale=self.scale + other.scale,
            nodes=self.nodes + other.nodes,
        )

    def scaled(self, share: float) -> ContactErrors:
        """With a share of the squares of differences."""
        return replace(self, pressure=share * self.pressure, friction=share * self.friction)


def trace_errors(
    deformed: DeformedBodies,
    contacts: Sequence[ContactResult],
    stress: StressError,
    motions: Mapping[str, ObstacleMotion],
) -> ContactErrors:
    """Tractions of the law beside those of the recovered stresses on the body's own surface, along the same normals.

    In the plane on the surfaces of both bodies, the larger difference on every facet, and no less than what is lost
    where a side bends.

    Parameters
    ----------
    deformed : bodies
    contacts : at one load, in the order of the model
    stress : recovered at that load
    motions : of moving obstacles by name
    """
    found = ContactErrors()
    for i, result in enumerate(contacts):
        side = boundary(deformed.space, result.nonmortar, ("contact",))
        own = _Surface.of(side, deformed.model, stress)
        if deformed.model.dimension == 2:
            opposed = driven_motion(deformed.model, i, result.points, motions)
            found += _along_side(own, result, deformed, stress, opposed)
        else:
            found += _at_nodes(result, *own.tractions(result, np.searchsorted(own.nodes, result.node)))
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class _Surface:
    """Corners of a side, with the stresses recovered there.

    Attributes
    ----------
    side : of one body
    nodes : (k,) corners, ascending
    normals : (k, 3) outward
    vectors : (k, 3) forces per area on the body
    """

    side: Boundary
    nodes: IntArray
    normals: Array
    vectors: Array

    @staticmethod
    def of(side: Boundary, model: Model, stress: StressError) -> _Surface:
        """Of a boundary of a body."""
        corners, recovered = stress.nodal[int(model.body_of_cells()[side.cells[0]])]
        nodes = side.corner_nodes
        normals = padded(side.nodal_normals[np.searchsorted(side.nodes, nodes)], 3)
        vectors = np.einsum("kij,kj->ki", _tensors(recovered[np.searchsorted(corners, nodes)], 3), normals)
        return _Surface(side=side, nodes=nodes, normals=normals, vectors=vectors)

    def tractions(self, result: ContactResult, rows: IntArray) -> tuple[Array, Array]:
        """Pressures (n,) and frictions (n, d) at the pairs of a contact, which are at some of the corners."""
        return _split(self.vectors[rows], result.normals)

    def areas_over_own(self, result: ContactResult, places: Array, opposite: BoolArray) -> Array:
        """(n,) Area that what is opposite to the facets at a pair has, over that of these; 0 where nothing is.

        Normals fan out where a side is curved: a gap makes areas opposite larger than its tilt alone does.

        Parameters
        ----------
        result : of the contact
        places : (n, d) opposite to the pairs, length
        opposite : (n,) where something is
        """
        count, x = len(self.side.points), self.side.points
        there, known = x.copy(), among([result.node[opposite]], count)
        there[result.node] = places
        ends = self.side.blocks[0].corner_nodes
        ends = ends[known[ends].all(axis=1)]
        sums = [
            np.bincount(ends.ravel(), np.repeat(np.linalg.norm(np.diff(at[ends], axis=1)[:, 0], axis=1), 2), count)
            for at in (there, x)
        ]
        over, under = (total[result.node] for total in sums)
        return np.asarray(over / np.where(under > 0.0, under, 1.0))

    def opposite_tractions(
        self, result: ContactResult, own: _Surface, rows: IntArray, weights: Array
    ) -> tuple[Array, Array]:
        """Pressures and frictions of what presses against a side, on its areas, along whose normals pairs are found.

        Parameters
        ----------
        result : of the contact
        own : surface of the side that has the pairs
        rows, weights : (n, 2) corners that the pairs are between, and of both; 0 for what is beyond an end
        """
        vectors, places = (
            np.einsum("na,nai->ni", weights, part[rows]) for part in (self.vectors, self.side.points[self.nodes])
        )
        areas = own.areas_over_own(result, places, np.asarray(weights.any(axis=1)))
        beyond = areas == 0.0
        pressing, shear = _split(-vectors * areas[:, None], result.normals)
        return np.where(beyond, result.pressure, pressing), np.where(beyond[:, None], result.shear, shear)


def _split(vectors: Array, normals: Array) -> tuple[Array, Array]:
    """Forces per area (n, 3) along normals (n, d), and what is left of them, (n, d)."""
    traction = vectors[:, : normals.shape[1]]
    pressing = np.einsum("ki,ki->k", traction, normals)
    return pressing, traction - pressing[:, None] * normals


def _along_side(
    own: _Surface, result: ContactResult, deformed: DeformedBodies, stress: StressError, opposed: Array
) -> ContactErrors:
    """Of one contact in the plane, opposite to what is rigid and has moved by (n, 2), or to another body."""
    model, linear = deformed.model, is_linear(deformed.model)
    recovered = own.tractions(result, np.searchsorted(own.nodes, result.node))
    errors = side_errors(own.side, result, recovered, linear=linear)
    nodes, sides = np.zeros(len(model.mesh.points)), [own]
    if result.coupling != "obstacle" and not model.mesh.bounds_nothing(result.mortar):
        opposite = _Surface.of(boundary(deformed.space, result.mortar, ("contact",)), model, stress)
        rows, weights = _opposite(deformed, result, opposite)
        recovered = opposite.opposite_tractions(result, own, rows, weights)
        errors = errors.larger(side_errors(own.side, result, recovered, linear=linear))
        opposed = np.einsum("na,nai->ni", weights, deformed.displacement[opposite.nodes[rows], :2])
        sides.append(opposite)
    modulus = contact_modulus(model, [int(model.body_of_cells()[each.side.cells[0]]) for each in sides])
    moved = deformed.displacement[result.node, :2] - opposed
    errors = errors.at_least(*bend_squares(own.side.blocks[0].corner_nodes, result, moved, modulus))
    if len(sides) > 1:
        shares = errors.at_nodes(len(nodes))[result.node]
        np.add.at(nodes, opposite.nodes[rows], weights * shares[:, None])
    nodes += errors.at_nodes(len(nodes))
    return ContactErrors(
        pressure=float(errors.pressure.sum()),
        friction=float(errors.friction.sum()),
        scale=float(errors.scale.sum()),
        nodes=nodes,
    )


def _opposite(deformed: DeformedBodies, result: ContactResult, surface: _Surface) -> tuple[IntArray, Array]:
    """Between which corners (n, 2) of the other side pairs are, and the weights of both; 0 beyond its ends.

    Along the normals of the pairs, where bodies are before they move, as pairs are found.

    Parameters
    ----------
    deformed : bodies
    result : of the contact
    surface : of the mortar body
    """
    (block,) = surface.side.blocks
    points = deformed.space.mesh.points
    pairs, ends = points[result.node], points[block.corner_nodes]
    spans, across = ends[:, 1] - ends[:, 0], np.column_stack([-result.normals[:, 1], result.normals[:, 0]])
    near = cKDTree(ends.mean(axis=1)).query(pairs, min(_NEAREST, len(ends)))[1].reshape(len(pairs), -1)
    there, length = (np.einsum("nki,ni->nk", part, across) for part in (pairs[:, None] - ends[near, 0], spans[near]))
    along = there / np.where(length == 0.0, np.inf, length)
    inside = np.clip(along, 0.0, 1.0)
    best, every = np.argmin(np.abs(there - inside * length), axis=1), np.arange(len(pairs))
    share, beyond = inside[every, best], np.abs(along - inside)[every, best] > _BEYOND_END
    weights = np.where(beyond[:, None], 0.0, np.column_stack([1.0 - share, share]))
    return np.searchsorted(surface.nodes, block.corner_nodes[near[every, best]]), weights


def _at_nodes(result: ContactResult, pressing: Array, shear: Array) -> ContactErrors:
    """Of one contact, beside other pressures and frictions at its nodes."""
    return ContactErrors(
        pressure=float(result.area @ (pressing - result.pressure) ** 2),
        friction=float(result.area @ ((shear - result.shear) ** 2).sum(axis=1)),
        scale=float(result.area @ result.pressure**2),
    )


def level_errors(contacts: Sequence[ContactResult], before: Sequence[tuple[Array, Array]]) -> ContactErrors:
    """Tractions beside those of a coarser mesh, carried to this one.

    Parameters
    ----------
    contacts : at one load
    before : of every contact pressures (nodes,) and frictions (nodes, d) of the coarser mesh at the nodes of this one
    """
    found = ContactErrors()
    for result, (pressing, shear) in zip(contacts, before, strict=True):
        found += _at_nodes(result, pressing[result.node], shear[result.node])
    return found


def _tensors(stress: Array, d: int) -> Array:
    """Stresses (k, 4 or 6) as matrices (k, d, d)."""
    whole = np.zeros((len(stress), 6))
    whole[:, : stress.shape[1]] = stress
    return whole[:, _FULL[:d, :d]]
