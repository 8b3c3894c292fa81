# SPDX-License-Identifier: BSD-3-Clause
"""Blocks: patch tests on meshes that match or not, and a block that slides and sticks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import BoolArray
from signorini.meshing.plane import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step


def stacked_blocks(*, friction: float = 0.0, cells: Cells = "quad", across: tuple[int, int] = (4, 4)) -> Model:
    """Patch test P1: two unit blocks, E 2e6, nu 0, the top pressed down by 0.1: p = 1e5, u_y(interface) = -0.05.

    Parameters
    ----------
    friction : Coulomb's coefficient
    cells : "quad", "quad8", "triangle", ...
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
    friction : Coulomb's coefficient
    cells : "quad", "quad8", "triangle", ...
    across : elements along the interface, of the block (nonmortar) and of the foundation
    """
    foundation = rectangle(width=3.0, height=1.0, nx=3 * across[1], ny=3, cells=cells)
    inside = _along_x(foundation, "top", 1.0, 2.0)
    (top,) = foundation.facets("top")
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


def curved_blocks(
    *,
    kind: Kind = "plane strain",
    friction: float = 0.0,
    cells: Cells = "quad8",
    across: tuple[int, int] = (3, 5),
    angle: float = 0.0,
) -> Model:
    """Patch test P5: two blocks that meet on the parabola y = 1 + 0.3 x^2, pressure 10 on all other sides.

    E 1000, nu 0.3: the stress is -10 in every direction, p = 10, wherever the interface points. Quadratic facets of any
    mesh hold the parabola exactly. The nodes that keep the blocks in place move as the exact solution does.

    Parameters
    ----------
    kind : "plane strain" or "axisymmetric", where y is the axis
    friction : Coulomb's coefficient
    cells : "quad", "quad8", "triangle", ...
    across : elements along the interface, of the upper (nonmortar) and of the lower block
    angle : by which the blocks are turned, degrees
    """
    straight = join(
        {
            "upper": rectangle(nx=across[0], ny=2, origin=(0.0, 1.0), cells=cells),
            "lower": rectangle(nx=across[1], ny=2, cells=cells),
        }
    )
    x, y = straight.points.T
    bent = np.column_stack([x, y + 0.3 * x**2 * np.minimum(y, 2.0 - y)])
    turn = np.radians(angle)
    points = bent @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    E, nu, pressure = 1000.0, 0.3, 10.0
    strain = -pressure * (1.0 - 2.0 * nu) / E * (1.0 if kind == "axisymmetric" else 1.0 + nu)

    def place(x: float, y: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """A corner of the unturned blocks: where it is, and how it moves."""
        at = points[np.abs(straight.points - [x, y]).sum(axis=1).argmin()]
        return (float(at[0]), float(at[1])), (float(strain * at[0]), float(strain * at[1]))

    (origin, still), (end, moved), (top, shifted) = place(0.0, 0.0), place(1.0, 0.0), place(0.0, 2.0)
    held = [Support(origin, u=still), Support(end, u=(None, moved[1])), Support(top, u=(shifted[0], None))]
    sides = [f"{name}.{side}" for name in ("upper", "lower") for side in ("left", "right")]
    if kind == "axisymmetric":
        held, sides = held[:1], ["upper.right", "lower.right"]
    return Model(
        replace(straight, points=points),
        kind=kind,
        title="Patch test P5: blocks that meet on a parabola",
        bodies=[Body(name, Elastic(E=E, nu=nu)) for name in ("upper", "lower")],
        supports=held,
        loads=[Load(name, pressure=pressure) for name in (*sides, "upper.top", "lower.bottom")],
        contacts=[Contact("upper.bottom", "lower.top", friction=friction, name="interface")],
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


def dragged_block(*, friction: float = 0.2) -> Model:
    """A block held by contact alone: pressed, pushed from the side, and let go.

    The push is less than friction can carry, so that the block comes to rest with tractions that only history explains.
    """
    push = Load("left", traction=(0.3, 0.0), name="push")
    return Model(
        rectangle(width=4.0, height=2.0, nx=16, ny=8),
        title="Block on a rough foundation",
        bodies=[Body("block", Elastic(E=100.0, nu=0.3))],
        loads=[Load("top", pressure=1.0, name="press"), push],
        contacts=[Contact("bottom", Plane(point=(0, 0), normal=(0, 1)), friction=friction, name="foundation")],
        steps=[
            Step(name="press", scale={"press": 1.0}, increments=10),
            Step(name="push", scale={"push": 1.0}, increments=10),
            Step(name="let go", scale={"push": 0.0}, increments=10),
        ],
    )


def _along_x(mesh: Mesh, name: str, low: float, high: float) -> BoolArray:
    """Whether each facet of a boundary has its middle between two coordinates."""
    (facets,) = mesh.facets(name)
    middle = mesh.points[facets].mean(axis=1)[:, 0]
    return np.asarray((low < middle) & (middle < high))
