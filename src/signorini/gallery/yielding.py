# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield: tubes, round bodies on a rigid plane, beams, what a cylinder rolls over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.gallery.large_bodies import bend, graded_lines, with_seat
from signorini.meshing.plane import Cells, annulus, rectangle
from signorini.model.body import Body, Formulation
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle, Plane
from signorini.model.plastic import Plastic
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.reference.hertz import contact_modulus

SHEAR_STRENGTH = 1.0
"""k of what is perfectly plastic, force per area."""

PERFECT = Plastic(float(np.sqrt(3.0)) * SHEAR_STRENGTH)

E, NU = 200.0, 0.3
"""Of the round body, as of the elastic ones in `half_planes` and `half_spaces`."""


def tube(
    pressure: float,
    *,
    n: int,
    cells: Cells = "quad",
    kind: Kind = "plane strain",
    nu: float = 0.4999,
    steps: Sequence[Step] = (Step(increments=1),),
) -> Model:
    """A long tube 1..2 with its ends held, E 1000 k: a quarter of its section, or a slice of the meridian.

    Parameters
    ----------
    pressure : inside, at factor 1 of "pressure", force per area
    n : cells through the wall
    cells : "quad", "quad8", ...
    kind : "plane strain" or "axisymmetric"
    nu : Poisson's ratio; Hill's stresses are exact for 0.5
    steps : by default one, of one increment
    """
    if kind == "axisymmetric":
        mesh = rectangle(
            x=1.0 + np.linspace(0.0, 1.0, n + 1), y=np.linspace(0.0, 0.25, max(1, n // 4) + 1), cells=cells
        )
        inside, supports = "left", [Support(name, u=(None, 0.0)) for name in ("bottom", "top")]
    else:
        mesh = annulus(inner=1.0, outer=2.0, n_radial=n, n_angular=n + n // 2, angle=90.0, cells=cells)
        inside, supports = "inner", [Support("start", u=(None, 0.0)), Support("end", u=(0.0, None))]
    (name,) = mesh.bodies
    return Model(
        mesh,
        kind=kind,
        title="Tube that yields",
        bodies=[Body(name, Elastic(E=1000.0 * SHEAR_STRENGTH, nu=nu, plastic=PERFECT))],
        supports=supports,
        loads=[Load(inside, pressure=pressure, name="pressure")],
        steps=steps,
    )


def round_body(
    *,
    n: int,
    plastic: Plastic,
    kind: Kind = "plane strain",
    cells: Cells = "quad",
    radius: float = 1000.0,
    seat: float = 1.5,
    size: float = 160.0,
    approach: float = 0.0,
    steps: Sequence[Step] = (Step(),),
) -> Model:
    """A large block whose lower side is a paraboloid or a parabolic cylinder, on a rigid plane.

    Half of it, or its meridian. At factor 1 of "press" it carries what makes an elastic contact of half-width or radius
    1, or its top has come down by an approach.

    Parameters
    ----------
    n : cells in a length of 1 where it may touch
    plastic : how it yields
    kind : "plane strain" or "axisymmetric"
    cells : "quad", "quad8", ...
    radius : of the body where it touches, length
    seat : where it may touch, and how deep cells are fine, length
    size : half-width and height, length
    approach : of its top, in place of the force
    steps : by default one
    """
    lines = graded_lines(seat, 1.0 / n, size)
    mesh = with_seat(bend(rectangle(x=lines, y=lines, cells=cells), radius), "bottom", seat)
    modulus = contact_modulus((E, NU))
    force = 4.0 * modulus / (3.0 * radius) if kind == "axisymmetric" else 0.5 * np.pi * modulus / (4.0 * radius)
    supports = [] if kind == "axisymmetric" else [Support("left", u=(0.0, None))]
    loads = [Load("top", force=(None, -force), spread="displacement", name="press")]
    if approach:
        supports, loads = [*supports, Support("top", u=(None, -approach), name="press")], []
    (name,) = mesh.bodies
    return Model(
        mesh,
        kind=kind,
        title="Round body that yields on a rigid plane",
        bodies=[Body(name, Elastic(E=E, nu=NU, plastic=plastic))],
        supports=supports,
        loads=loads,
        contacts=[Contact("seat", Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), name="contact")],
        steps=steps,
    )


def indented_block(
    tool: Obstacle,
    depth: float,
    *,
    x: Array,
    y: Array,
    seat: float,
    material: Elastic,
    steps: Sequence[Step],
) -> Model:
    """A cylinder about the y axis, held at its lower end, into whose top a rigid tool is driven without friction.

    Parameters
    ----------
    tool : a solid of revolution, at rest where it touches the top
    depth : to which it is driven at factor 1 of "tool", length
    x, y : lines between the cells, from the axis out, and up to the top at 0
    seat : radius in which it may touch, length
    material : of the cylinder
    steps : of the tool
    """
    mesh = with_seat(rectangle(x=x, y=y), "top", seat)
    (name,) = mesh.bodies
    return Model(
        mesh,
        kind="axisymmetric",
        title="Block that yields under a rigid tool",
        bodies=[Body(name, material)],
        supports=[Support("bottom", u=(0.0, 0.0))],
        contacts=[Contact("seat", "tool", name="contact")],
        obstacles=[Rigid("tool", tool, u=(0.0, -depth))],
        steps=steps,
    )


def bent_beam(*, curvature: float, n: int, cells: Cells = "quad8", formulation: Formulation | None = None) -> Model:
    """A slice of a beam of height 2 and length 1 whose end sections turn but stay plane, E 1000 k, nearly nu 0.5.

    Parameters
    ----------
    curvature : per length; at factor 1 of the supports "turn.0", "turn.1", ... of the nodes of the right end
    n : cells through the height
    cells : "quad", "quad8", ...
    formulation : of the cells
    """
    mesh = rectangle(x=np.linspace(0.0, 1.0, n // 4 + 1), y=np.linspace(-1.0, 1.0, n + 1), cells=cells)
    ends = mesh.points[np.unique(mesh.facets("right")[0])]
    turned = [Support(tuple(at), u=(-curvature * at[1], None), name=f"turn.{i}") for i, at in enumerate(ends)]
    (name,) = mesh.bodies
    return Model(
        mesh,
        title="Beam bent beyond yield",
        bodies=[Body(name, Elastic(E=1000.0 * SHEAR_STRENGTH, nu=0.4999, plastic=PERFECT), formulation)],
        supports=[Support("left", u=(0.0, None)), Support((0.0, -1.0), u=(None, 0.0), name="height"), *turned],
        steps=[Step(name="bend", increments=1)],
    )


def stretched(hardening: float, *, steps: Sequence[Step]) -> Model:
    """NAFEMS NL1: one square of side 1 and thickness 1 whose sides "x" and "y" move by 1e-4, mm and MPa.

    Parameters
    ----------
    hardening : slope of the yield stress
    steps : with the factors of both sides
    """
    mesh = rectangle(x=np.array([0.0, 1.0]), y=np.array([0.0, 1.0]))
    (name,) = mesh.bodies
    return Model(
        mesh,
        title="NAFEMS NL1",
        bodies=[Body(name, Elastic(E=250e3, nu=0.25, plastic=Plastic(5.0, hardening=hardening)))],
        supports=[
            Support("left", u=(0.0, None)),
            Support("bottom", u=(None, 0.0)),
            Support("right", u=(1e-4, None), name="x"),
            Support("top", u=(None, 1e-4), name="y"),
        ],
        steps=steps,
    )


def overlaid_squares(steps: Sequence[Step]) -> Model:
    """NAFEMS: three perfectly plastic squares of side and thickness 1 on the same four nodes, mm and MPa.

    Parameters
    ----------
    steps : of the force 1 on their right side, "pull"
    """
    laws = {"first": (100e3, 3.0), "second": (60e3, 6.0), "third": (40e3, 8.0)}
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    mesh = Mesh(
        points=corners,
        cells={"quad": np.tile(np.arange(4), (len(laws), 1))},
        bodies={name: np.array([i]) for i, name in enumerate(laws)},
        nodes={"left": np.array([0, 3]), "bottom": np.array([0, 1]), "right": np.array([1, 2])},
    )
    return Model(
        mesh,
        kind="plane stress",
        title="NAFEMS: three squares in one place",
        bodies=[Body(name, Elastic(E=E, nu=0.25, plastic=Plastic(Y))) for name, (E, Y) in laws.items()],
        supports=[Support("left", u=(0.0, None)), Support("bottom", u=(None, 0.0))],
        loads=[Load("right", force=(1.0, None), name="pull")],
        steps=steps,
    )


def rolled_half_plane(p_0: float, *, n: int, passes: int) -> Model:
    """A block under the pressure of a cylinder that rolls over it from -4 to 4 half-widths of contact again and again.

    Without friction, and as the pressure of an elastic contact is: from one place to the next, two cells on, the one
    fades as the other comes.

    Parameters
    ----------
    p_0 : largest pressure, force per area; the half-width is 1
    n : cells in a half-width, even
    passes : how often
    """
    run, size = 4.0, 16.0
    fine = run + 1.5
    beyond = fine + graded_lines(2.0 / n, 1.0 / n, size - fine, 1.25)[1:]
    x = np.concatenate([-beyond[::-1], np.linspace(-fine, fine, round(2.0 * fine * n) + 1), beyond])
    mesh = rectangle(x=x, y=-graded_lines(2.0, 1.0 / n, size, 1.25)[::-1])
    nodes = np.unique(mesh.facets("top")[0])
    places = np.linspace(-run, run, round(run * n) + 1)
    order = np.argsort(mesh.points[nodes, 0])
    forces = np.zeros((len(places), len(nodes), 2))
    forces[:, order, 1] = -p_0 * np.array([_hertz_forces(x, place) for place in places])
    names = [f"place {j}" for j in range(len(places))]
    each = np.eye(len(places) + 1, len(places))  # one after the other, then none
    scale = {name: each[:, j].tolist() for j, name in enumerate(names)}
    (name,) = mesh.bodies
    return Model(
        replace(mesh, nodes={**mesh.nodes, "surface": nodes}),
        title="Half-plane that a cylinder rolls over",
        bodies=[Body(name, Elastic(E=1000.0 * SHEAR_STRENGTH, nu=0.3, plastic=PERFECT))],
        supports=[
            Support("bottom", u=(0.0, 0.0)),
            Support("left", u=(0.0, None)),
            Support("right", u=(0.0, None)),
        ],
        loads=[Load("surface", nodal_forces=force, name=word) for word, force in zip(names, forces, strict=True)],
        steps=[Step(name="roll", scale=scale, repeat=passes, increments=1)],
    )


def _hertz_forces(x: Array, place: float) -> Array:
    """Nodal forces of ``sqrt(1 - (x - place)^2)`` on linear facets between coordinates, per thickness."""
    at, share = np.polynomial.legendre.leggauss(4)
    low, high = np.maximum(x[:-1], place - 1.0), np.minimum(x[1:], place + 1.0)
    half = np.maximum(0.5 * (high - low), 0.0)[:, None]
    where = np.where(half > 0.0, 0.5 * (low + high)[:, None] + half * at, place)
    force = np.sqrt(np.maximum(1.0 - (where - place) ** 2, 0.0)) * half * share
    right = (where - x[:-1, None]) / np.diff(x)[:, None]
    found = np.zeros(len(x))
    found[:-1] += (force * (1.0 - right)).sum(axis=1)
    found[1:] += (force * right).sum(axis=1)
    return found
