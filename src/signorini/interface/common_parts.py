# SPDX-License-Identifier: BSD-3-Clause
"""Integrals over what the facets of two sides have in common, and the functions dual to their hats."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.facet_block import FacetBlock
from signorini.interface.coupling import FacetGaps


@dataclass(frozen=True, kw_only=True, eq=False)
class Opposite:
    """Integrals over the common parts of facets with mortar facets of one kind.

    Attributes
    ----------
    first : (p,) the nonmortar facets
    nodes : (p, l) nodes of the mortar facets
    other : (p, c, l, d) ``int N N_l n``, N the hats of the nonmortar corners, N_l the functions of the mortar facet
    """

    first: IntArray
    nodes: IntArray
    other: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class CommonParts:
    """Integrals over the parts of nonmortar facets of one kind that anything is opposite.

    The normals n are outward ones, along which the facets are pressed; gaps count along the line of sight.

    Attributes
    ----------
    block : the facets
    mass : (m, c, c) ``int N N``, N the hats of the corners
    own : (m, c, k, d) ``int N N_j n``, N_j the functions of the facet
    over : (m, c) ``int N (g - g_facets) dA``, g the gap between the smooth surfaces that facets stand for
    opposite : those with the mortar facets of every kind
    gaps : at points of the facets
    curved : whether any of the smooth surfaces is
    """

    block: FacetBlock
    mass: Array
    own: Array
    over: Array
    opposite: tuple[Opposite, ...]
    gaps: FacetGaps
    curved: bool


def dual_functions(mass: Array) -> Array:
    """Coefficients of the functions dual to hats N, (m, c, c): ``psi = A N``, ``A = diag(int N) (int N N^T)^-1``.

    Parameters
    ----------
    mass : (m, c, c) ``int N N^T`` over the covered part of every facet; zero where nothing is covered

    Examples
    --------
    >>> dual_functions(np.array([[[2.0, 1.0], [1.0, 2.0]]]) / 6).round(12).tolist()
    [[[2.0, -1.0], [-1.0, 2.0]]]
    """
    share = mass.sum(axis=2)
    total = share.sum(axis=1)
    covered = total > 0.0
    dual = np.zeros_like(mass)
    inverse = np.linalg.pinv(mass[covered] / total[covered, None, None], 1e-10, hermitian=True)
    dual[covered] = (share[covered] / total[covered, None])[:, :, None] * inverse
    return dual
