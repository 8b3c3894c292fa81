# SPDX-License-Identifier: BSD-3-Clause
"""Sides that wear: a worn depth at the corners of their facets, which the pairs give to it and feel as a wider gap.

A pair wears both sides where it presses. On the nonmortar side a depth of the hats of the corners is felt by the pair
of the same corner alone, because multipliers are dual to them: ``int psi_k N_l = delta_kl area_k``. On the mortar side
the pair sees the nodes l with the weights m_kl that the normal rows of B have, some of them negative, and wears them
with the shares s_kl >= 0, on the same places, that give all of what it wears, and to uniform wear a uniform depth:

    gap_k = d_k + sum_l m_kl d_l,    area_l d_l = sum_k s_kl w_k,    sum_l s_kl = area_k,
    sum_k s_kl = area_l = sum_k m_kl area_k,

so that the worn volume is that by which gaps grow, whatever the meshes, and no depth is negative. Both follow B: where
pairs change, the depths at the nodes stay and are weighed anew.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.boundary import boundary
from signorini.fem.facets import facet_nodes, facet_shapes
from signorini.fem.measure import facet_areas
from signorini.fem.space import Space
from signorini.interface.interface import Interface
from signorini.model.model import Model
from signorini.model.wear import Wear

_SHARED = 1e-13  # of an area: how well shares add up to it
_ROUNDS = 1000  # of sharing: some dozens are enough where facets are of like sizes
_STAYS = 0.99  # of what shares lacked a round before: sides that cover each other in part have none that fit all sums


@dataclass(frozen=True, kw_only=True, eq=False)
class WornSides:
    """Corners of the facets of all sides that wear, contact after contact, the nonmortar side first.

    Attributes
    ----------
    contact, node : (m,) index of the contact, and node of the mesh
    mortar : (m,) whether the corner is on the mortar side
    coefficient : (m,) worn depth over what wears, area per force
    by_energy : (n,) pairs that the work of friction wears, not pressure and distance
    gap : (n, m) what the pairs feel of the depths
    area : (m,) of the corners as the pairs see them, 0 where none does; where sides slide far, of the facets there
    volume : (m, n) worn volume at the corners over what wears per area of the pairs
    """

    contact: IntArray
    node: IntArray
    mortar: BoolArray
    coefficient: Array
    by_energy: BoolArray
    gap: sp.csr_array
    area: Array
    volume: sp.csr_array

    def __len__(self) -> int:
        return len(self.node)

    def depth(self, volume: Array) -> Array:
        """(m,) Depth of worn volumes (m,) at the corners, length; 0 where no pair sees one."""
        return np.divide(volume, self.area, out=np.zeros_like(volume), where=self.area > 0.0)

    @property
    def rate(self) -> Array:
        """(n,) What the gap of a pair grows by where pairs around it wear alike, over what wears it: area per force."""
        return np.asarray(self.gap @ self.coefficient, dtype=np.float64)


def worn_sides(space: Space, model: Model, interface: Interface) -> WornSides:
    """The sides of all contacts that wear, as the pairs of an interface see them.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    interface : the n pairs

    """
    parts = [
        (i, mortar, *_corners(space, interface, i, mortar=mortar))
        for i, contact in enumerate(model.contacts)
        if contact.wear is not None
        for mortar in ((False, True) if _coefficients(model, interface, i)[1] else (False,))
    ]
    none = (np.zeros(0, np.int64), sp.csr_array((len(interface), 0)))
    sizes = [len(nodes) for _, _, nodes, _ in parts]
    weights = [seen for *_, seen in parts] or [none[1]]
    gap = sp.csr_array(sp.hstack(weights))
    seen = np.asarray(gap.T @ interface.area, dtype=np.float64)
    node = np.concatenate([none[0], *(nodes for _, _, nodes, _ in parts)])
    contact = np.repeat(np.array([i for i, *_ in parts], np.int64), sizes)
    coefficient = np.repeat(
        [_coefficients(model, interface, i)[int(mortar)] for i, mortar, *_ in parts] or np.zeros(0), sizes
    )
    slides = np.array([contact.slides for contact in model.contacts], np.bool_)
    whole = [_of_facets(space, model, interface, i, mortar=mortar) for i, mortar, *_ in parts]
    area = np.where(slides[contact], np.concatenate([np.zeros(0), *whole]), seen)
    energies = np.array([contact.wear is not None and contact.wear.by_energy for contact in model.contacts], np.bool_)
    return WornSides(
        contact=contact,
        node=node,
        mortar=np.repeat(np.array([mortar for _, mortar, *_ in parts], np.bool_), sizes),
        coefficient=coefficient,
        by_energy=energies[interface.contact],
        gap=gap,
        area=area,
        volume=sp.csr_array(sp.diags_array(coefficient) @ _shares(gap, interface.area, seen, sizes)),
    )


def _shares(gap: sp.csr_array, pairs: Array, corners: Array, sizes: list[int]) -> sp.csr_array:
    """(m, n) Shares of the pairs at the corners, none negative, by scaling the positive weights by rows and columns.

    Parameters
    ----------
    gap : (n, m) weights of the corners
    pairs, corners : (n,) and (m,) areas, what shares add up to
    sizes : numbers of corners of every side

    References
    ----------
    Sinkhorn, Knopp (1967), Concerning nonnegative matrices and doubly stochastic matrices, Pacific J. Math. 21:343.
    """
    sides, begin = [], 0
    for size in sizes:
        weights = sp.coo_array(gap[:, begin : begin + size])
        positive = weights.data > 0.0
        shares = _scaled(
            weights.row[positive],
            weights.col[positive],
            (pairs[weights.row] * weights.data)[positive],
            pairs,
            corners[begin : begin + size],
        )
        sides.append(sp.csr_array(shares.T))
        begin += size
    return sp.csr_array(sp.vstack(sides)) if sides else sp.csr_array((0, len(pairs)))


def _scaled(k: IntArray, at: IntArray, shares: Array, pairs: Array, corners: Array) -> sp.coo_array:
    """(n, corners) Shares with the sums of rows, and as far as their places allow of columns.

    Parameters
    ----------
    k, at : (entries,) rows and columns
    shares : (entries,) before they are scaled
    pairs, corners : (n,) and (corners,) sums
    """
    n, m, last = len(pairs), len(corners), np.inf
    seen = np.bincount(k, minlength=n) > 0
    for _ in range(_ROUNDS):
        shares = shares * _over(corners, np.bincount(at, shares, m).astype(np.float64))[at]
        total = np.bincount(k, shares, n).astype(np.float64)
        shares = shares * _over(pairs, total)[k]
        lacks = float(np.abs(total - pairs)[seen].max(initial=0.0)) / float(pairs.max(initial=1.0))
        if lacks <= _SHARED or lacks > _STAYS * last:
            break
        last = lacks
    return sp.coo_array((shares, (k, at)), shape=(n, m))


def _over(wanted: Array, found: Array) -> Array:
    return np.divide(wanted, found, out=np.zeros_like(wanted), where=found > 0.0)


def _coefficients(model: Model, interface: Interface, i: int) -> tuple[float, float]:
    """Of the sides as they were taken, nonmortar first: the coarser one may be the one that is named second."""
    contact = model.contacts[i]
    wear: Wear | None = contact.wear
    assert wear is not None
    turned = interface.sides[i].nonmortar != contact.nonmortar
    return (wear.mortar, wear.nonmortar) if turned else (wear.nonmortar, wear.mortar)


def _corners(space: Space, interface: Interface, i: int, *, mortar: bool) -> tuple[IntArray, sp.csr_array]:
    """Corners of a side of a contact, and (n, corners) what all pairs feel of a depth there."""
    n, sides = len(interface), interface.sides[i]
    own = np.flatnonzero(interface.contact == i)
    if not mortar:
        nodes = boundary(space, sides.nonmortar, ("contact", i)).corner_nodes
        at = np.searchsorted(nodes, interface.node[own])
        return nodes, sp.csr_array((np.ones(len(own)), (own, at)), shape=(n, len(nodes)))
    side = boundary(space, sides.mortar, ("contact", i))
    dofs = space.dofs(side.nodes)
    seen = sp.csr_array((len(own), len(side.nodes)))
    for k in range(space.dimension):  # along the pair's own normal the weights of the mortar side sum to 1
        seen = seen - sp.diags_array(interface.normals[own, k]) @ interface.B[own][:, dofs[:, k]]
    hats = sp.csr_array(seen @ _hats(space, sides.mortar, i)).tocoo()
    return side.corner_nodes, sp.csr_array((hats.data, (own[hats.row], hats.col)), shape=(n, hats.shape[1]))


def _of_facets(space: Space, model: Model, interface: Interface, i: int, *, mortar: bool) -> Array:
    """Areas of the corners of a side, whatever is opposite them: what slides over a corner wears all around it."""
    sides = interface.sides[i]
    side = boundary(space, sides.mortar if mortar else sides.nonmortar, ("contact", i))
    areas = side.nodal((facet_areas(model, block) for block in side.blocks), corners=True)
    return areas[np.searchsorted(side.nodes, side.corner_nodes)]


def _hats(space: Space, side: str, i: int) -> sp.csr_array:
    """(nodes, corners) Hats of the corners of a side at its nodes, also at those in the middle of quadratic facets."""
    found = boundary(space, side, ("contact", i))
    hats = sp.csr_array((len(found.nodes), len(found.corner_nodes)))
    for block in found.blocks:
        shape = facet_shapes(block.corners, facet_nodes(block.dimension, block.count))[0]
        rows = np.searchsorted(found.nodes, block.facets)[:, :, None]
        columns = np.searchsorted(found.corner_nodes, block.corner_nodes)[:, None, :]
        rows, columns, values = np.broadcast_arrays(rows, columns, shape[None])
        # facets that share a node give it the same weights
        first = np.unique(np.column_stack([rows.ravel(), columns.ravel()]), axis=0, return_index=True)[1]
        hats = hats.maximum(
            sp.csr_array((values.ravel()[first], (rows.ravel()[first], columns.ravel()[first])), shape=hats.shape)
        )
    return sp.csr_array(hats)
