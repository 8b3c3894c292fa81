# SPDX-License-Identifier: BSD-3-Clause
"""What no mesh may be: with radii below zero, nodes too far apart for digits, or cells that are folded."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray, extent
from signorini.errors import InputError, spell_point
from signorini.fem.jacobian import cell_determinants
from signorini.meshing.facets import corner_volumes, refuse_folded
from signorini.model.mesh import CORNERS, Mesh

_DIGITS = 1e12  # how many times the shortest edge of a cell a mesh may extend


def refuse_negative_radii(mesh: Mesh, on_axis: float) -> None:
    """Refuse an axisymmetric mesh that reaches over the axis.

    Parameters
    ----------
    mesh : whose first coordinate is the radius
    on_axis : of the largest radius, what counts as none

    Raises
    ------
    InputError
        With the node.
    """
    radii = mesh.points[:, 0]
    used = np.concatenate([cells.ravel() for cells in mesh.cells.values()])
    node = used[np.argmin(radii[used])]
    if radii[node] < -on_axis * np.abs(radii[used]).max():
        raise InputError(
            f"node {mesh.labels[node]} has the radius {radii[node]:g}; expected x = r >= 0 in an axisymmetric model",
            where=("mesh", "points"),
        )


def refuse_far_nodes(mesh: Mesh, used_nodes: IntArray) -> None:
    """Refuse nodes at one place, which leave no cell, and one far away, which leaves no digits to the others.

    Parameters
    ----------
    mesh, used_nodes : and nodes of any cell

    Raises
    ------
    InputError
        With the cell or the node.
    """
    points, labels = mesh.points, mesh.labels
    used = points[used_nodes]
    least, first = float(extent(used / _DIGITS).max()), 0
    for cells in mesh.cells.values():
        edges = np.abs(points.T[:, cells[:, 1]] - points.T[:, cells[:, 0]]).max(axis=0)
        cell = int(np.argmin(edges))
        first += len(cells)
        if (shortest := float(edges[cell])) >= least:
            continue
        number, (one, two) = first - len(cells) + cell, cells[cell, :2]
        name = mesh.cell_name(number)
        away = np.abs(used - np.median(used, axis=0)).max(axis=1)
        if shortest < float(np.median(away)) / _DIGITS:
            raise InputError(
                f"{name} has an edge of length {shortest:.3g}, from node {labels[one]} to node {labels[two]} at "
                f"{spell_point(points[one], 6)}; expected corners at places of their own",
                where=("mesh",),
                cell=number,
            )
        far = used_nodes[np.argmax(away)]
        raise InputError(
            f"node {labels[far]} at {spell_point(points[far], 6)} is more than {_DIGITS:.0e} times as far away as "
            f"{name} is long ({shortest:.3g}); expected nodes whose places differ in the digits that numbers have",
            where=("mesh",),
        )


def refuse_shape(mesh: Mesh, family: str, first: int, gradients: Array, corners: Array) -> None:
    """Refuse cells of a family that are folded at a node or a quadrature point; of linear plane ones corners say it.

    The determinant of their Jacobian is linear in each reference coordinate.

    Parameters
    ----------
    mesh, family, first : and the number of the first of the cells
    gradients, corners : (q, k, d), (k, k, d) of the shape functions, at quadrature points and nodes

    Raises
    ------
    InputError
        With the cell and where it is.
    """
    points, cells = mesh.points, mesh.cells[family]
    simplex = cells.shape[1] == points.shape[1] + 1  # linear ones are the same everywhere
    if points.shape[1] == 2 and cells.shape[1] == CORNERS[family]:
        volumes = corner_volumes(points, family, cells, 1 if simplex else None)
    else:
        inner = cell_determinants(points, cells, gradients)
        outer = inner if simplex else cell_determinants(points, cells, corners)
        volumes = np.hstack([outer, inner])
    refuse_folded(mesh, family, first, volumes)
