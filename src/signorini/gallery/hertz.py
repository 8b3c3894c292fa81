# SPDX-License-Identifier: BSD-3-Clause
"""Two large blocks that touch as half-planes or half-spaces do: Hertz's line and point contact at small a/R."""

from __future__ import annotations

import numpy as np

from signorini.gallery.large_bodies import bend, flip, graded_lines, with_seat
from signorini.meshing.plane import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.reference.hertz import contact_modulus

UPPER, LOWER = Elastic(E=200.0, nu=0.3), Elastic(E=70.0, nu=0.2)
MODULUS = contact_modulus((UPPER.E, UPPER.nu), (LOWER.E, LOWER.nu))
RADIUS = 1000.0
"""Of the upper body; the half-width or radius of contact is 1."""

LINE_FORCE = float(np.pi * MODULUS / (4.0 * RADIUS))
POINT_FORCE = 4.0 * MODULUS / (3.0 * RADIUS)
"""Forces under which contact has this half-width (force per length) or radius, by Hertz."""

SEAT = 1.2
"""Half-width of the part with even cells, where the bodies may touch."""


_SIZE = 160.0  # width and height of each body: half-widths of contact


def hertz_contact(*, kind: Kind = "plane strain", across: tuple[int, int], cells: Cells = "quad") -> Model:
    """One half of a round body on a flat one, or their meridian; other material, no friction, a/R = 0.001.

    Parameters
    ----------
    kind : "plane strain": two cylinders under ``LINE_FORCE``; "axisymmetric": two spheres under ``POINT_FORCE``
    across : cells of the upper (nonmortar) and of the lower body where they may touch, 0 <= x <= 1.2
    cells : "quad", "quad8", "triangle", ...

    Examples
    --------
    >>> hertz_contact(across=(6, 9)).contacts[0].label
    'contact'
    """
    upper, lower = (_block(SEAT / count, cells) for count in across)
    force = POINT_FORCE if kind == "axisymmetric" else 0.5 * LINE_FORCE
    supports = [Support("lower.top", u=(None, 0.0))]
    if kind != "axisymmetric":
        supports += [Support(f"{name}.left", u=(0.0, None)) for name in ("upper", "lower")]
    return Model(
        join({"upper": bend(upper, RADIUS), "lower": flip(lower)}),
        kind=kind,
        title="Hertz contact of two elastic bodies",
        bodies=[Body("upper", UPPER), Body("lower", LOWER)],
        supports=supports,
        loads=[Load("upper.top", force=(None, -force), spread="displacement", name="press")],
        contacts=[Contact("upper.seat", "lower.seat", name="contact")],
    )


def _block(spacing: float, cells: Cells) -> Mesh:
    """A block over y = 0, x = 0 its left side, "seat" the part of its lower side that may touch."""
    mesh = rectangle(x=graded_lines(SEAT, spacing, _SIZE), y=graded_lines(6.0 * spacing, spacing, _SIZE), cells=cells)
    return with_seat(mesh, "bottom", SEAT)
