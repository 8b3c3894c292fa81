# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems of the plane with sizes, loads, frictions, materials and meshes drawn by a seed.

Meshes to begin with are turned, of uneven cells, of triangles and quadrilaterals, linear and quadratic; those of two
bodies match in no way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.arrays import Array
from signorini.meshing.plane import half_disk, quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane, Profile

_BLOCK = 20.0  # half of its width, and its height; half-widths of contacts in it are about 1

_CELLS: tuple[tuple[Literal["triangle", "quad"], int], ...] = (
    ("triangle", 2),
    ("triangle", 1),
    ("quad", 1),
    ("quad", 2),
)


def _drawn(random: np.random.Generator) -> tuple[Elastic, float, Literal["triangle", "quad"], int]:
    """A material, a friction, a family of cells and their order."""
    material = Elastic(E=10.0 ** random.uniform(1.5, 5.5), nu=random.uniform(0.0, 0.45))
    cells, order = _CELLS[int(random.choice(4, p=(0.55, 0.15, 0.15, 0.15)))]
    return material, float(random.choice((0.0, 0.1, 0.3, 0.6, 1.0))), cells, order


def _modulus(material: Elastic) -> float:
    """In plane strain, ``E / (1 - nu^2)``."""
    return material.E / (1.0 - material.nu**2)


def _uneven(random: np.random.Generator, length: float) -> Array:
    """Coordinates of lines from 0 to a length."""
    steps = random.uniform(0.5, 1.5, int(random.integers(4, 11)))
    return np.concatenate([[0.0], np.cumsum(steps)]) * length / steps.sum()


def line(random: np.random.Generator) -> Model:
    """Half of a block on a rigid circle."""
    material, friction, cells, order = _drawn(random)
    radius, halfwidth = 10.0 ** random.uniform(1.5, 3.0), random.uniform(0.4, 1.5)
    force = -np.pi * _modulus(material) * halfwidth**2 / (8.0 * radius)
    return Model(
        rectangle(x=_uneven(random, _BLOCK), y=_uneven(random, _BLOCK), cells=cells, order=order),
        bodies=[Body("block", material)],
        supports=[Support("left", u=(0.0, None))],
        loads=[Load("top", force=(None, force))],
        contacts=[Contact("bottom", Circle((0.0, -radius), radius), friction=friction, name="seat")],
    )


def disk(random: np.random.Generator) -> Model:
    """A quarter of a disk on a rigid plane."""
    material, friction, cells, order = _drawn(random)
    radius, spacing = random.uniform(4.0, 30.0), random.uniform(0.12, 0.3)
    mesh = quarter_disk(
        radius=radius, contact_length=2 * spacing * radius, contact_spacing=spacing * radius, cells=cells, order=order
    )
    halfwidth = random.uniform(0.03, 0.25)  # of the radius
    return Model(
        mesh,
        bodies=[Body("disk", material)],
        supports=[Support("axis", u=(0.0, None))],
        loads=[Load("cut", force=(None, -np.pi / 8.0 * _modulus(material) * halfwidth**2 * radius))],
        contacts=[Contact("arc", Plane((0.0, 0.0), (0.0, 1.0)), friction=friction, name="seat")],
    )


def turned(random: np.random.Generator) -> Model:
    """Half of a disk, turned about its centre, whose cut is pressed towards a rigid plane."""
    material, friction, cells, order = _drawn(random)
    radius, spacing = random.uniform(4.0, 30.0), random.uniform(0.12, 0.3)
    mesh = half_disk(
        radius=radius, contact_length=2 * spacing * radius, contact_spacing=spacing * radius, cells=cells, order=order
    )
    return Model(
        _turned(mesh, random.uniform(-20.0, 20.0), np.array([0.0, radius])),
        bodies=[Body("disk", material)],
        supports=[Support("cut", u=(0.0, -radius * 10.0 ** random.uniform(-2.7, -1.3)))],
        contacts=[Contact("arc", Plane((0.0, 0.0), (0.0, 1.0)), friction=friction, name="seat")],
    )


def pair(random: np.random.Generator) -> Model:
    """Halves of two disks of other radii and materials, turned, whose meshes do not match."""
    (upper, friction, cells, order), (lower, *_) = _drawn(random), _drawn(random)
    lower = replace(lower, E=upper.E * 10.0 ** random.uniform(-1.5, 1.5))
    radii, meshes = random.uniform(5.0, 20.0, 2), list[Mesh]()
    for radius in radii:
        spacing = radius * random.uniform(0.08, 0.25)
        mesh = half_disk(radius=radius, contact_length=2 * spacing, contact_spacing=spacing, cells=cells, order=order)
        meshes.append(_turned(mesh, random.uniform(-10.0, 10.0), np.array([0.0, radius])))
    meshes[1] = replace(meshes[1], points=-meshes[1].points)  # by half a turn
    return Model(
        join({"upper": meshes[0], "lower": meshes[1]}),
        bodies=[Body("upper", upper), Body("lower", lower)],
        supports=[
            Support("lower.cut", u=(0.0, 0.0)),
            Support("upper.cut", u=(0.0, -float(radii.min()) * 10.0 ** random.uniform(-2.5, -1.3))),
        ],
        contacts=[Contact("upper.arc", "lower.arc", friction=friction, name="seat")],
    )


def punch(random: np.random.Generator) -> Model:
    """Half of a block under a punch with rounded edges."""
    material, friction, cells, order = _drawn(random)
    width, fillet, depth = random.uniform(2.0, 5.0), random.uniform(0.5, 1.9), 10.0 ** random.uniform(-2.3, -1.3)
    mesh = rectangle(x=_uneven(random, _BLOCK), y=_uneven(random, _BLOCK), cells=cells, order=order)
    shape = ((width, 6.0), (width, -depth), (-width, -depth), (-width, 6.0))
    return Model(
        replace(mesh, points=mesh.points - np.array([0.0, _BLOCK])),
        bodies=[Body("block", material)],
        supports=[Support("left", u=(0.0, None)), Support("bottom", u=(0.0, 0.0))],
        contacts=[Contact("top", Profile(shape, fillet=fillet), friction=friction, name="seat")],
    )


FAMILIES: dict[str, Callable[[np.random.Generator], Model]] = {
    "block on a circle": line,
    "quarter of a disk": disk,
    "turned disk": turned,
    "two turned disks": pair,
    "rounded punch": punch,
}


def variation(family: str, number: int) -> Model:
    """A problem of a family.

    Parameters
    ----------
    family : one of `FAMILIES`
    number : seed, with the place of the family
    """
    return FAMILIES[family](np.random.default_rng((list(FAMILIES).index(family), number)))


def _turned(mesh: Mesh, degrees: float, about: Array) -> Mesh:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return replace(mesh, points=(mesh.points - about) @ np.array([[c, s], [-s, c]]) + about)
