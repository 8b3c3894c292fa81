# SPDX-License-Identifier: BSD-3-Clause
"""How the nodes of one side see the other side: what every way of coupling gives back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.sparse_rows import added, scaled_rows

_KNOWN = 1e-7  # of what facets are beside the surface that they stand for: it is not known better


@dataclass(frozen=True, kw_only=True, eq=False)
class FacetGaps:
    """Gaps at points of facets, not in the mean.

    Attributes
    ----------
    corners : (m, c) nodes of the facets
    ends : (m, c) gaps there, length; infinite where nothing is opposite a corner
    low, high : (m,) smallest and largest one on each facet
    """

    corners: IntArray
    ends: Array
    low: Array
    high: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Coupling:
    """Pairs of one contact, by what pressing them does: exact for uniform pressure on curved sides too.

    A unit pressure of pair k alone, of the shape psi_k, puts forces ``int psi_k N_j n dA`` on the nodes j of the
    nonmortar side and minus ``int psi_k N_l n dA`` on those of the mortar side, with the normals n that the nonmortar
    side has there (between both sides where they are tilted against each other), not with a mean of them. Virtual work
    makes the same numbers the weights of the gap: ``gap_k = sum_ji forces_kji x_ji / area_k``.

    Attributes
    ----------
    nodes : (k,) nonmortar nodes, sorted
    normal_areas : (k, d) ``int psi_k n dA``, the sum of the forces on the nonmortar side; n into the nonmortar body
    forces : d sparse arrays (k, nodes of the mesh), one a direction; every row sums to 0 (to ``normal_areas`` where a
        rigid obstacle is the other side)
    facets : gaps at points of the facets that pairs take means over; None where a pair sees one point
    smoothing : (k,) ``int psi_k (g - g_facets) dA``, g the gap between the smooth surfaces that facets stand for, see
        :mod:`signorini.interface.smooth`; None where they stand for themselves

    References
    ----------
    Puso, Laursen (2004), Computer Methods in Applied Mechanics and Engineering 193:601-629, section 3.
    """

    nodes: IntArray
    normal_areas: Array
    forces: tuple[sp.csr_array, ...]
    facets: FacetGaps | None = None
    smoothing: Array | None = None

    @cached_property
    def area(self) -> Array:
        """(k,) Length of ``normal_areas``: that of the surface as far as it is flat."""
        size: Array = np.linalg.norm(self.normal_areas, axis=1)
        return size

    @cached_property
    def normals(self) -> Array:
        """(k, d) Unit vectors along ``normal_areas``."""
        return np.asarray(self.normal_areas / self.area[:, None])

    @cached_property
    def relative(self) -> sp.csr_array:
        """(k, nodes of the mesh) What a pair sees along its own normal: weights of the nonmortar side, which sum to 1,
        minus those of the mortar side, which sum to 1 too.
        """
        return scaled_rows(along(self.forces, self.normals), 1.0 / self.area)


def geometric_gap(coupling: Coupling, points: Array) -> Array:
    """(k,) Gaps between the smooth surfaces at pairs, length.

    Parameters
    ----------
    points : (n, d) of all nodes
    """
    seen = np.asarray(sum(force @ x for force, x in zip(coupling.forces, points.T, strict=True)))
    if coupling.smoothing is not None:
        total = seen + coupling.smoothing
        seen = np.where(np.abs(total) > _KNOWN * np.abs(coupling.smoothing), total, 0.0)
    return np.asarray(seen / coupling.area)


def joined_gaps(parts: Sequence[FacetGaps]) -> FacetGaps:
    """Of facets of all kinds; one with fewer corners than others names its first ones twice."""
    width = max(part.corners.shape[1] for part in parts)
    columns = [np.arange(width) % part.corners.shape[1] for part in parts]
    return FacetGaps(
        corners=np.concatenate([part.corners[:, own] for part, own in zip(parts, columns, strict=True)]),
        ends=np.concatenate([part.ends[:, own] for part, own in zip(parts, columns, strict=True)]),
        low=np.concatenate([part.low for part in parts]),
        high=np.concatenate([part.high for part in parts]),
    )


def along(forces: tuple[sp.csr_array, ...], directions: Array) -> sp.csr_array:
    """Component of the vectors of every pair along a direction of its own (k, d), (k, nodes of the mesh)."""
    first, *others = (scaled_rows(force, directions[:, i]) for i, force in enumerate(forces))
    return reduce(added, others, first)


def point_coupling(
    nodes: IntArray, normal_areas: Array, relative: sp.csr_array, *, fallen: Array | None = None
) -> Coupling:
    """Of pairs with one normal each.

    Parameters
    ----------
    nodes : (k,) nonmortar nodes
    normal_areas : (k, d) normal into the nonmortar body times area
    relative : (k, nodes of the mesh) weights of the nonmortar side minus those of the mortar side
    fallen : (k,) how far the facets opposite lie behind the surfaces that they stand for, length; None: nowhere
    """
    forces = tuple(scaled_rows(relative, part) for part in normal_areas.T)
    smoothing = None if fallen is None else -fallen * np.linalg.norm(normal_areas, axis=1)
    return Coupling(nodes=nodes, normal_areas=normal_areas, forces=forces, smoothing=smoothing)


def spread(rows: IntArray, columns: IntArray, values: Array, n: int) -> tuple[sp.csr_array, ...]:
    """Entries of facets, summed into d matrices (n, n).

    Parameters
    ----------
    rows, columns : (k, a) and (k, b) nodes
    values : (d, k, a, b)
    n : nodes of the mesh
    """
    i, j = (np.broadcast_to(part, values.shape[1:]).ravel() for part in (rows[:, :, None], columns[:, None, :]))
    return tuple(sp.csr_array((part.ravel(), (i, j)), shape=(n, n)) for part in values)
