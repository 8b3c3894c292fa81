# SPDX-License-Identifier: BSD-3-Clause
"""Two large blocks that touch as half-planes or half-spaces do: Hertz's line and point contact at small a/R."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.gallery.half_planes import graded
from signorini.meshing.plane import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Kind, Model
from signorini.reference.hertz import contact_modulus

UPPER, LOWER = Elastic(E=200.0, nu=0.3), Elastic(E=70.0, nu=0.2)
MODULUS = contact_modulus((UPPER.E, UPPER.nu), (LOWER.E, LOWER.nu))
RADIUS = 1000.0
"""Of the upper body; the half-width or radius of contact is 1."""

LINE_FORCE = float(np.pi * MODULUS / (4.0 * RADIUS))
POINT_FORCE = 4.0 * MODULUS / (3.0 * RADIUS)
SEAT = 1.2
"""Half-width of the part with even cells, where the bodies may touch."""


def hertz_contact(
    *, kind: Kind = "plane strain", across: tuple[int, int] = (24, 24), cells: Cells = "quad", size: float = 160.0
) -> Model:
    """One half of a round body on a flat one, or their meridian; other material, no friction, a/R = 0.001.

    Parameters
    ----------
    kind : "plane strain": two cylinders under ``LINE_FORCE``; "axisymmetric": two spheres under ``POINT_FORCE``
    across : cells of the upper (nonmortar) and of the lower body where they may touch, 0 <= x <= 1.2
    size : width and height of each body

    Examples
    --------
    >>> hertz_contact(across=(6, 9)).contacts[0].label
    'contact'
    """
    upper, lower = (_block(count, size, cells) for count in across)
    points = np.array(upper.points)
    points[:, 1] += points[:, 0] ** 2 / (2.0 * RADIUS) * (1.0 - points[:, 1] / size)
    upside_down = np.array(lower.points) * [1.0, -1.0]
    force = POINT_FORCE if kind == "axisymmetric" else 0.5 * LINE_FORCE
    supports = [Support("lower.far", u=(None, 0.0))]
    if kind != "axisymmetric":
        supports += [Support(f"{name}.left", u=(0.0, None)) for name in ("upper", "lower")]
    return Model(
        join({"upper": replace(upper, points=points), "lower": replace(lower, points=upside_down)}),
        kind=kind,
        title="Hertz contact of two elastic bodies",
        bodies=[Body("upper", UPPER), Body("lower", LOWER)],
        supports=supports,
        loads=[Load("upper.far", force=(None, -force), spread="displacement", name="press")],
        contacts=[Contact("upper.seat", "lower.seat", name="contact")],
    )


def _block(count: int, size: float, cells: Cells) -> Mesh:
    """A block over y = 0, x = 0 its left side, "seat" the part of its lower side that may touch, "far" the upper."""
    spacing = SEAT / count
    mesh = rectangle(x=graded(SEAT, spacing, size), y=graded(6.0 * spacing, spacing, size), cells=cells)
    (bottom,) = mesh.facets("bottom")
    inside = mesh.points[bottom][:, :, 0].max(axis=1) <= SEAT * (1.0 + 1e-9)
    boundaries = {"left": mesh.boundaries["left"], "far": mesh.boundaries["top"], "seat": bottom[inside]}
    return replace(mesh, boundaries=boundaries)
