# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of every family of plane cells, crooked ones too."""

from dataclasses import replace

import numpy as np

from signorini.meshing.plane import rectangle
from signorini.model.mesh import Mesh

FAMILIES = ("triangle", "quad", "triangle6", "quad8", "quad9")
MIXED = ("triangle+quad", "triangle6+quad8", "triangle6+quad9", "quad8+quad9")
KINDS = ("plane strain", "plane stress", "axisymmetric")


def lame(model):
    """Lame's parameters of the only body; lambda is the plane one in plane stress."""
    (body,) = model.bodies
    E, nu = body.material.E, body.material.nu
    shear = E / (2 * (1 + nu))
    return (2 * shear * nu / (1 - nu) if model.kind == "plane stress" else 2 * shear * nu / (1 - 2 * nu)), shear


def block(family, *, n=3, x=(1.0, 2.0), crooked=0.03):
    """A block from x to x, 1 high; its edges bend where the family allows it."""
    names = family.split("+")
    mesh = rectangle(x=np.linspace(*x, 2 * n + 1), y=np.linspace(0.0, 1.0, n + 1), cells=names[0])
    if len(names) == 2:
        mesh = half_and_half(
            mesh, rectangle(x=np.linspace(*x, 2 * n + 1), y=np.linspace(0.0, 1.0, n + 1), cells=names[1])
        )
    return bent(mesh, crooked)


def bent(mesh, amount=0.03):
    """All nodes moved by a smooth map: cells differ, edges of quadratic ones bend, none folds."""
    x, y = mesh.points.T
    moved = mesh.points + amount * np.column_stack([np.sin(4.0 * y + x), np.sin(5.0 * x)])
    return replace(mesh, points=moved)


def half_and_half(one, other):
    """The left half of one mesh and the right half of another on the same points."""
    points = np.unique(np.round(np.vstack([one.points, other.points]), 12), axis=0)

    def number_of(mesh):
        gap = np.linalg.norm(mesh.points[:, None] - points, axis=2)
        return np.argmin(gap, axis=1)

    middle = 0.5 * (points[:, 0].min() + points[:, 0].max())
    cells = {}
    for mesh, side in ((one, -1.0), (other, 1.0)):
        ((family, nodes),) = mesh.cells.items()
        here = side * (mesh.points[nodes].mean(axis=1)[:, 0] - middle) > 0
        cells[family] = number_of(mesh)[nodes[here]]
    boundaries = {name: number_of(one)[facets][:, :2] for name, facets in one.boundaries.items()}
    count = sum(len(nodes) for nodes in cells.values())
    return Mesh(points=points, cells=cells, bodies={"block": np.arange(count)}, boundaries=boundaries)
