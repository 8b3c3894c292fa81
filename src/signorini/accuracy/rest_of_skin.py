# SPDX-License-Identifier: BSD-3-Clause
"""Facets of the skin of a mesh that no boundary names: where it is refined they follow its geometry, too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import IntArray
from signorini.meshing.facets import facet_corners, facet_keys, make_facets, unshared
from signorini.model.mesh import Mesh

REST = "the rest of the skin"
"""What these are called while the mesh is refined."""


def with_rest(mesh: Mesh) -> Mesh:
    """A mesh whose facets with one cell all have a name.

    Examples
    --------
    >>> from signorini.meshing.plane import rectangle
    >>> square = rectangle(nx=2)
    >>> part = replace(square, boundaries={"top": square.boundaries["top"]})
    >>> len(with_rest(part).boundaries[REST]), sorted(without_rest(with_rest(part)).boundaries)
    (4, ['top'])
    """
    d, found = mesh.points.shape[1], dict[int, list[IntArray]]()
    for count, own in make_facets(mesh).items():
        corners = facet_corners(d, count)
        named = [np.empty(0, own.key.dtype)]
        for name in mesh.boundaries:
            parts = (part for part in mesh.facets(name) if facet_corners(d, part.shape[1]) == corners)
            named += [facet_keys(part[:, :corners], len(mesh.points)) for part in parts]
        rest = unshared(own.key) & ~np.isin(own.key, np.concatenate(named))
        if rest.any():
            found.setdefault(corners, []).append(own.nodes[rest][:, :corners])
    kinds = tuple(np.concatenate(parts) for parts in found.values())
    return replace(mesh, boundaries={**mesh.boundaries, REST: kinds if d > 2 else kinds[0]}) if kinds else mesh


def without_rest(mesh: Mesh) -> Mesh:
    """A mesh with the names that were given."""
    if REST not in mesh.boundaries:
        return mesh
    return replace(mesh, boundaries={name: own for name, own in mesh.boundaries.items() if name != REST})
