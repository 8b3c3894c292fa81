# SPDX-License-Identifier: BSD-3-Clause
"""Blocks: patch tests on meshes that match or not, and a block that slides and sticks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import BoolArray
from signorini.fem.generators import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step


def stacked_blocks(*, friction: float = 0.0, cells: Cells = "quad", across: tuple[int, int] = (4, 4)) -> Model:
    """Patch test P1: two unit blocks, E 2e6, nu 0, the top pressed down by 0.1: p = 1e5, u_y(interface) = -0.05.

    Parameters
    ----------
    across : elements along the interface, of the upper (nonmortar) and of the lower block
    """
    mesh = join(
        {
            "upper": rectangle(nx=across[0], ny=3, origin=(0.0, 1.0), cells=cells),
            "lower": rectangle(nx=across[1], ny=2, cells=cells),
        }
    )
    block = Elastic(E=2e6, nu=0.0)
    return Model(
        mesh,
        title="Patch test P1: two blocks",
        bodies=[Body("upper", block), Body("lower", block)],
        supports=[
            Support("lower.bottom", u=(None, 0.0)),
            Support("upper.top", u=(None, -0.1)),
            Support((0.0, 0.0), u=(0.0, None)),
            Support((0.0, 2.0), u=(0.0, None)),
        ],
        contacts=[Contact("upper.bottom", "lower.top", friction=friction, name="interface")],
    )


def block_on_foundation(*, friction: float = 0.0, cells: Cells = "quad", across: tuple[int, int] = (3, 3)) -> Model:
    """Patch test P2 (Taylor, Papadopoulos): pressure 25 on the block and on the free top of the foundation.

    E 2000, nu 0.3, plane strain: sigma_yy = -25 everywhere, p = 25, no gap.

    Parameters
    ----------
    across : elements along the interface, of the block (nonmortar) and of the foundation
    """
    foundation = rectangle(width=3.0, height=1.0, nx=3 * across[1], ny=3, cells=cells)
    inside = _along_x(foundation, "top", 1.0, 2.0)
    top = foundation.boundaries["top"]
    foundation = replace(foundation, boundaries={**foundation.boundaries, "seat": top[inside], "free": top[~inside]})
    block = rectangle(nx=across[0], ny=3, origin=(1.0, 1.0), cells=cells)
    elastic = Elastic(E=2000.0, nu=0.3)
    return Model(
        join({"block": block, "foundation": foundation}),
        title="Patch test P2: block on a foundation",
        bodies=[Body("block", elastic), Body("foundation", elastic)],
        supports=[
            Support("foundation.bottom", u=(None, 0.0)),
            Support((1.0, 0.0), u=(0.0, None)),
            Support((1.0, 2.0), u=(0.0, None)),
        ],
        loads=[Load("block.top", pressure=25.0), Load("foundation.free", pressure=25.0)],
        contacts=[Contact("block.bottom", "foundation.seat", friction=friction, name="interface")],
    )


def four_blocks(*, cells: Cells = "quad", across: tuple[int, int, int, int] = (3, 3, 3, 3)) -> Model:
    """Patch test P4: four blocks that meet at a corner, pressure 10 on the right and 20 on the top, frictionless.

    Parameters
    ----------
    across : elements along the sides of the southwest, southeast, northwest and northeast block
    """
    names = {"southwest": (0.0, 0.0), "southeast": (1.0, 0.0), "northwest": (0.0, 1.0), "northeast": (1.0, 1.0)}
    mesh = join(
        {
            name: rectangle(nx=count, ny=count, origin=origin, cells=cells)
            for count, (name, origin) in zip(across, names.items(), strict=True)
        }
    )
    return Model(
        mesh,
        title="Patch test P4: four blocks",
        bodies=[Body(name, Elastic(E=1000.0, nu=0.3)) for name in names],
        supports=[
            *(Support(f"{name}.left", u=(0.0, None)) for name in ("southwest", "northwest")),
            *(Support(f"{name}.bottom", u=(None, 0.0)) for name in ("southwest", "southeast")),
        ],
        loads=[
            *(Load(f"{name}.right", pressure=10.0) for name in ("southeast", "northeast")),
            *(Load(f"{name}.top", pressure=20.0) for name in ("northwest", "northeast")),
        ],
        contacts=[
            Contact("southeast.left", "southwest.right"),
            Contact("northeast.left", "northwest.right"),
            Contact("northwest.bottom", "southwest.top"),
            Contact("northeast.bottom", "southeast.top"),
        ],
    )


def dragged_block(*, friction: float = 0.2, increments: int = 10, cells: Cells = "quad") -> Model:
    """A block held by contact alone: pressed, pushed from the side, and let go.

    The push is less than friction can carry, so that the block comes to rest with tractions that only history explains.
    """
    push = Load("left", traction=(0.3, 0.0), name="push")
    return Model(
        rectangle(width=4.0, height=2.0, nx=16, ny=8, cells=cells),
        title="Block on a rough foundation",
        bodies=[Body("block", Elastic(E=100.0, nu=0.3))],
        loads=[Load("top", pressure=1.0, name="press"), push],
        contacts=[Contact("bottom", Plane(point=(0, 0), normal=(0, 1)), friction=friction, name="foundation")],
        steps=[
            Step(name="press", scale={"press": 1.0}, increments=increments),
            Step(name="push", scale={"push": 1.0}, increments=increments),
            Step(name="let go", scale={"push": 0.0}, increments=increments),
        ],
    )


def _along_x(mesh: Mesh, name: str, low: float, high: float) -> BoolArray:
    """Which facets of a boundary have their middle between two coordinates."""
    middle = mesh.points[mesh.boundaries[name]].mean(axis=1)[:, 0]
    return np.asarray((low < middle) & (middle < high))
