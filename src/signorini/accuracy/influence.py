# SPDX-License-Identifier: BSD-3-Clause
"""How much the error of the stress in a cell counts for the pressures of contacts: the less the farther it is away."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import Array
from signorini.model.mesh import CORNERS, Mesh
from signorini.solution.results import ContactResult


def influence(mesh: Mesh, contacts: Sequence[ContactResult]) -> Array:
    """(m,) Of the square of an error of stress in energy: its effect on the square of the pressures, 1 / length.

    What a stress in a cell of size h does at a distance r falls as ``(h / r)^d``, on a surface of the size r; and the
    mean of an error over the cells around is small, as those of Galerkin's method are, which is another ``h / r``:
    ``h^(d + 1) / r^(d + 2)``, at the surface itself ``1 / h``.

    Parameters
    ----------
    mesh : of the bodies
    contacts : at one load; where none presses all cells count alike

    Examples
    --------
    >>> from signorini.meshing.plane import rectangle
    >>> influence(rectangle(nx=2, ny=2), []).tolist()
    [1.0, 1.0, 1.0, 1.0]
    """
    from scipy.spatial import KDTree  # not before an accuracy is asked for

    pressing = [contact.points[contact.closed] for contact in contacts]
    if not any(map(len, pressing)):
        return np.ones(mesh.number_of_cells)
    nearest, d = KDTree(np.concatenate(pressing)), mesh.points.shape[1]
    found = []
    for family, cells in mesh.cells.items():
        corners = mesh.points[cells[:, : CORNERS[family]]]
        size = np.linalg.norm(corners - corners.mean(axis=1, keepdims=True), axis=2).mean(axis=1)
        away = nearest.query(corners.reshape(-1, d))[0].reshape(len(cells), -1).min(axis=1)
        found.append((size / np.maximum(away, size)) ** (d + 2) / size)
    return np.concatenate(found)
