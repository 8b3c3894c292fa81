# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that stand for half-planes and half-spaces: fine where they touch, bent a little, held by symmetry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.model.conditions import Support
from signorini.model.mesh import Mesh


def graded_lines(fine: float, spacing: float, far: float, growth: float = 1.15) -> Array:
    """Grid lines from 0 to ``far``.

    Parameters
    ----------
    fine, spacing : cells of this length up to there
    far : the last line
    growth : by which every cell beyond is longer than the one before

    Examples
    --------
    >>> graded_lines(1.0, 0.5, 3.0, 2.0).tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    """
    lines = list(np.linspace(0.0, fine, round(fine / spacing) + 1))
    step = spacing * growth
    while lines[-1] + 1.5 * step < far:
        lines.append(lines[-1] + step)
        step *= growth
    return np.array([*lines, far])


def bend(mesh: Mesh, radius: float) -> Mesh:
    """The body on 0 with a lower side that rises by ``r^2 / 2 radius``; its upper side stays."""
    points = np.array(mesh.points)
    rise: Array = (points[:, :-1] ** 2).sum(axis=1) / (2.0 * radius)
    points[:, -1] += rise * (1.0 - points[:, -1] / points[:, -1].max())
    return replace(mesh, points=points)


def flip(mesh: Mesh) -> Mesh:
    """The body above 0 turned upside down, under 0."""
    points = np.array(mesh.points)
    points[:, -1] *= -1.0
    return replace(mesh, points=points)


def with_seat(mesh: Mesh, side: str, radius: float) -> Mesh:
    """The mesh with the facets of a side within a radius of the axis as the boundary "seat"."""
    (facets,) = mesh.facets(side)
    far = np.sqrt((mesh.points[facets][..., :-1] ** 2).sum(axis=-1)).max(axis=1)
    return replace(mesh, boundaries={**mesh.boundaries, "seat": facets[far <= radius * (1.0 + 1e-9)]})


def quarter_supports(body: str) -> list[Support]:
    """The planes of symmetry of a quarter of a body in space."""
    return [Support(f"{body}.start", u=(None, 0.0, None)), Support(f"{body}.end", u=(0.0, None, None))]
