# SPDX-License-Identifier: BSD-3-Clause
"""What is bonded and torn off: a bar from a plane, and an arm of a double cantilever beam from its symmetry plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.law.cohesion import Cohesion
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.links import RigidBody
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step

BAR_MODULUS, BAR_AREA, BAR_LENGTH = 1000.0, 2.0, 1.0
"""Of the bar, which does not contract: force over area, area of a unit of thickness, and length."""

ARM_MODULUS, ARM_HEIGHT, ARM_LENGTH, CRACK = 1.0e4, 1.0, 16.0, 4.0
"""Of an arm of the double cantilever beam: force over area, height, length, and length that is not bonded."""

ARM_BOND = Cohesion(10.0, opening=0.006, shear="free")
"""Its bond: it softens over some cells of a quarter of the height."""


def bonded_bar(
    cohesion: Cohesion,
    stretch: float = 0.0,
    *,
    kind: Kind = "plane stress",
    compliance: float = 0.0,
    steps: Sequence[Step] | None = None,
) -> Model:
    """A bar that is bonded to a plane and drawn off it by its other end, at factor 1 of "pull" by a stretch.

    Parameters
    ----------
    cohesion : of the bond
    stretch : length
    kind : of the model: a strip, a plug of the area's width as radius, or a bar in space
    compliance : of the interface, length per pressure
    steps : of its history; one to all of "pull" where not given
    """
    solid = kind == "3d"
    strip = rectangle(width=BAR_AREA, height=BAR_LENGTH, nx=1, ny=2)
    across = (0.0,) * (2 if solid else 1)
    return Model(
        box(x=[0.0, BAR_AREA], y=[0.0, 1.0], z=[0.0, 0.5 * BAR_LENGTH, BAR_LENGTH]) if solid else strip,
        kind=kind,
        bodies=[Body("block", Elastic(E=BAR_MODULUS, nu=0.0))],
        supports=[Support("top", u=(*across, stretch), name="pull")],
        contacts=[
            Contact(
                "bottom",
                Plane((*across, 0.0), (*across, 1.0)),
                cohesion=cohesion,
                normal_compliance=compliance,
                name="bond",
            )
        ],
        steps=[Step()] if steps is None else steps,
    )


def cantilever(
    cohesion: Cohesion = ARM_BOND,
    *,
    lift: float = 0.0,
    rotation: float = 0.0,
    cells: int = 64,
    compliance: float = 0.0,
    steps: Sequence[Step] | None = None,
    solid: bool = False,
) -> Model:
    """One arm of a double cantilever beam, bonded to the plane of symmetry, which takes half of the energy of the bond.

    Its end, a rigid "grip", is lifted, or turned: at factor 1 of "peel" by so much.

    Parameters
    ----------
    cohesion : of the bond, of which the plane of symmetry sees half the opening
    lift, rotation : of the end, length and angle; one of them, the other is free
    cells : along the arm
    compliance : of the interface, length per pressure
    steps : of its history; one to all of "peel" where not given
    solid : in space, a strip of unit width that does not contract, instead of in the plane
    """
    along, up = np.linspace(0.0, ARM_LENGTH, cells + 1), np.linspace(0.0, ARM_HEIGHT, 4)
    arm = box(x=along, y=[0.0, 1.0], z=up) if solid else rectangle(x=along, y=up)
    bottom = arm.boundaries["bottom"]
    (facets,) = bottom if isinstance(bottom, tuple) else (bottom,)
    bonded = facets[arm.points[facets, 0].min(axis=1) >= CRACK - 1e-9 * ARM_LENGTH]
    mesh = Mesh(
        points=arm.points,
        cells=arm.cells,
        bodies={"arm": np.arange(arm.number_of_cells)},
        boundaries={"end": arm.boundaries["left"], "far": arm.boundaries["right"], "bond": bonded},
    )
    across = (0.0,) if solid else ()
    lifted = (0.0, *across, lift) if lift else (0.0, *across, None)
    turned = ((0.0, None, 0.0) if lift else (0.0, rotation, 0.0)) if solid else (None if lift else -rotation,)
    normal = (0.0, *across, 1.0)
    return Model(
        mesh,
        kind="3d" if solid else "plane stress",
        bodies=[Body("arm", Elastic(E=ARM_MODULUS, nu=0.0), formulation="incompatible")],
        rigid_bodies=[RigidBody("grip", on="end", point=tuple(0.5 * part for part in (0.0, *across, ARM_HEIGHT)))],
        supports=[Support("grip", u=(*lifted, *turned), name="peel")],
        contacts=[
            Contact(
                "bond",
                Plane((0.0,) * len(normal), normal),
                cohesion=cohesion,
                normal_compliance=compliance,
                name="bond",
            )
        ],
        steps=[Step()] if steps is None else steps,
    )
