# SPDX-License-Identifier: BSD-3-Clause
"""A shaft pressed into a hub, plane and in space."""

from __future__ import annotations

from dataclasses import replace

from signorini.meshing.plane import Cells, annulus
from signorini.meshing.solid import extruded
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model


def press_fit(
    *,
    n_radial: int = 4,
    n_angular: int | tuple[int, int] = 12,
    kind: Kind = "plane stress",
    interference: float = 0.01,
    drawn: float = 0.0,
    friction: float = 0.0,
    cells: Cells = "quad",
) -> Model:
    """A quarter of a hollow shaft 1..2 (E 2000) in a hub 2..3 (E 1000), nu 0.3, radial interference.

    Parameters
    ----------
    n_radial, n_angular : cells in each ring; along the fit one number, or those of shaft and hub
    kind : "plane stress" or "plane strain"
    interference : by which the shaft overlaps the bore, length
    drawn : by how much the shaft that is meshed is larger than the bore, length
    friction : Coulomb's coefficient
    cells : "quad", "quad8", "triangle", ...
    """
    along = (n_angular, n_angular) if isinstance(n_angular, int) else n_angular
    mesh = join(
        {
            name: annulus(inner=a, outer=b, n_radial=n_radial, n_angular=n, angle=90.0, cells=cells)
            for name, a, b, n in (("shaft", 1.0, 2.0 + drawn, along[0]), ("hub", 2.0, 3.0, along[1]))
        }
    )
    return Model(
        mesh,
        kind=kind,
        title="Press fit",
        bodies=[Body("shaft", Elastic(E=2000.0, nu=0.3)), Body("hub", Elastic(E=1000.0, nu=0.3))],
        supports=[
            *(Support(f"{name}.start", u=(None, 0.0)) for name in ("shaft", "hub")),
            *(Support(f"{name}.end", u=(0.0, None)) for name in ("shaft", "hub")),
        ],
        contacts=[Contact("shaft.outer", "hub.inner", friction=friction, interference=interference, name="fit")],
    )


def press_fit_in_space(
    *, n_radial: int = 4, n_angular: int | tuple[int, int] = 12, friction: float = 0.0, cells: Cells = "quad"
) -> Model:
    """A slab of `press_fit`, thickness 1, whose faces stay plane: plane strain, and normals that turn with the fit.

    Parameters
    ----------
    n_radial, n_angular : cells in each ring; along the fit one number, or those of shaft and hub
    friction : Coulomb's coefficient
    cells : of the plane, "quad" or "quad8", which are raised to hexahedra
    """
    flat = press_fit(n_radial=n_radial, n_angular=n_angular, kind="plane strain", friction=friction, cells=cells)
    return Model(
        extruded(flat.mesh, z=[0.0, 0.5, 1.0]),
        title="Press fit in space",
        bodies=flat.bodies,
        supports=[
            *(replace(support, u=(*support.u, None)) for support in flat.supports),
            Support("bottom", u=(None, None, 0.0)),
            Support("top", u=(None, None, 0.0)),
        ],
        contacts=flat.contacts,
    )
