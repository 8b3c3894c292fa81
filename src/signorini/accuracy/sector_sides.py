# SPDX-License-Identifier: BSD-3-Clause
"""Sides of cyclic sectors on finer meshes: edges are halved on both, so that nodes go on rotating onto nodes."""

from __future__ import annotations

import numpy as np

from signorini.arrays import IntArray
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.stress import space_of
from signorini.meshing.simplices import Simplices, corner_numbers
from signorini.meshing.twin_edges import NO_TWINS, twin_edges
from signorini.model.model import Model


def sector_twins(model: Model, simplices: Simplices) -> IntArray:
    """(k, 4) Edges of sides of sectors that are halved alike, see :func:`signorini.meshing.twin_edges.twin_edges`.

    Parameters
    ----------
    model : in the plane, on the mesh to begin with
    simplices : of that

    Raises
    ------
    InputError
        If a node of a side has no partner on the other.

    Examples
    --------
    >>> from signorini.gallery.sectors import ring_on_pads
    >>> ring = ring_on_pads(whole=False)
    >>> len(sector_twins(ring, Simplices.of(ring.mesh))), len(ring.mesh.facets("ring.start")[0])
    (6, 3)
    """
    space, number, found = space_of(model), corner_numbers(model.mesh), [NO_TWINS]
    for j in range(len(model.cyclic_symmetries)):
        _, first, second = cyclic_sides(space, model, j)
        pairs = number[np.column_stack([first, second])]
        found.append(twin_edges(simplices.cells, pairs[(pairs >= 0).all(axis=1)]))
    return np.vstack(found)
