# SPDX-License-Identifier: BSD-3-Clause
"""Fields along a path: which cell a point is in, and what the cell says there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, one_of
from signorini.fem.jacobian import solved
from signorini.fem.space import Block, Space, shape_functions
from signorini.fem.stress import body_stresses
from signorini.model.model import Model
from signorini.short import Short

_OUTSIDE = 1e-6  # of a cell: how far a point may lie beside its body, and is taken to its edge
_NEWTON = 20
_SETTLED = 1e-14  # of a cell: a last step
_OBLIQUE = {"triangle": 2, "tetra": 3, "wedge": 2}
"""How many reference coordinates add up to 1 at most; the others reach 1 each."""
_BENT = 1.3  # of the distance of the farthest node, or of a box beside it: how far a bent edge may reach


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PathResult(Short):
    """Displacement and stress at points of a body.

    Attributes
    ----------
    body : its name
    points : (n, d) undeformed coordinates, length
    distance : (n,) along the path from its first point, length
    displacement : (n, d) length
    stress : (n, 6) force per area: xx, yy, zz, xy, yz, xz; axisymmetric: radial, axial, hoop and their shear
    """

    body: str
    points: Array
    distance: Array
    displacement: Array
    stress: Array


def along(
    space: Space,
    model: Model,
    displacement: Array,
    points: Array,
    *,
    body: str,
    factors: Mapping[str, float] | None = None,
    plastic: Mapping[str, Array] | None = None,
) -> PathResult:
    """Displacement and recovered stress of a body at points: interpolated in the cells from their nodes.

    Parameters
    ----------
    space, model : through which the path leads
    displacement : (nodes, d) length
    points : (n, d) coordinates in the undeformed body, length
    body : the stress is that of this body, also where it touches another
    factors : load factors by name, for the temperatures
    plastic : plastic strains, see :func:`signorini.fem.stress.body_stresses`

    Raises
    ------
    InputError
        If there is no such body, or a point lies outside it: the number of the point is said.
    """
    names = [b.name for b in model.bodies]
    if body not in names:
        raise InputError(one_of(body, names, "body"))
    points = np.atleast_2d(np.asarray(points, float))
    found = body_stresses(space, model, displacement, factors, plastic)[names.index(body)]
    stress = np.zeros((len(space.mesh.points), 6))
    stress[found.nodes] = found.stress
    if points.shape[1] != space.dimension:
        raise InputError(f"points have {points.shape[1]} coordinates; expected {space.dimension}")
    moved, stressed = np.zeros((len(points), space.components)), np.zeros((len(points), 6))
    for block, index, cells, values in located(space, model, points, names.index(body)):
        moved[index] = np.einsum("nk,nki->ni", values, displacement[block.cells[cells]])
        stressed[index] = np.einsum("nk,nki->ni", values, stress[block.cells[cells]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return PathResult(
        body=body,
        points=points,
        distance=np.concatenate([[0.0], np.cumsum(steps)]),
        displacement=moved,
        stress=stressed,
    )


def located(space: Space, model: Model, points: Array, body: int) -> Iterator[tuple[Block, IntArray, IntArray, Array]]:
    """For every block: which points are in its cells, in which, and the shape functions there.

    Parameters
    ----------
    space, model : through which points are looked for
    points : (n, d) undeformed coordinates, length
    body : index of the body that they are in

    Raises
    ------
    InputError
        If a point lies outside it: its number is said.
    """
    owner = model.body_of_cells()
    beside = np.full(len(points), np.inf)
    best: list[tuple[Block, IntArray, IntArray, Array]] = []
    home = np.full(len(points), -1)
    for number, block in enumerate(space.blocks):
        own = np.nonzero(owner[block.first : block.first + len(block.cells)] == body)[0]
        point, cell = _candidates(space.mesh.points[block.cells[own]], points)
        at, outside = _inverse(block, space.mesh.points[block.cells[own[cell]]], points[point])
        order = np.lexsort((outside, point))
        first = np.unique(point[order], return_index=True)[1]
        chosen = order[first]
        chosen = chosen[outside[chosen] < beside[point[chosen]]]
        beside[point[chosen]], home[point[chosen]] = outside[chosen], number
        best.append((block, point[chosen], own[cell[chosen]], shape_functions(block.family, at[chosen].T)[0]))
    lost = np.nonzero(beside > _OUTSIDE)[0]
    if len(lost):
        where = tuple(float(x) for x in points[lost[0]])
        raise InputError(f"point {lost[0] + 1} at {where} is not in the body '{model.bodies[body].name}'")
    for number, (block, index, cells, values) in enumerate(best):
        here = home[index] == number
        yield block, index[here], cells[here], values[here]


def _candidates(corners: Array, points: Array) -> tuple[IntArray, IntArray]:
    """Points and cells whose circles and boxes hold them, as pairs; one tree for every size of cells."""
    centres = corners.mean(axis=1)
    radii = _BENT * np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    low, high = corners.min(axis=1), corners.max(axis=1)
    beyond = (_BENT - 1.0) * (high - low).max(axis=1, keepdims=True)
    size = np.floor(np.log2(radii)).astype(int) if len(radii) else np.empty(0, int)
    pairs = [(np.empty(0, int), np.empty(0, int))]
    for one in np.unique(size):
        cells = np.nonzero(size == one)[0]
        near = KDTree(centres[cells]).query_ball_point(points, radii[cells].max())
        counts = np.array([len(part) for part in near])
        flat = np.concatenate([np.asarray(part, int) for part in near])
        point, cell = np.repeat(np.arange(len(points)), counts), cells[flat]
        apart = np.abs(points[point] - 0.5 * (low + high)[cell])
        within = (apart <= (0.5 * (high - low) + beyond)[cell]).all(axis=1)
        pairs.append((point[within], cell[within]))
    return np.concatenate([p for p, _ in pairs]), np.concatenate([c for _, c in pairs])


def _inverse(block: Block, corners: Array, points: Array) -> tuple[Array, Array]:
    """Reference coordinates (n, d) of points in cells by Newton's method, and how far outside they are, (n,)."""
    d = points.shape[1]
    oblique = next((axes for family, axes in _OBLIQUE.items() if block.family.startswith(family)), 0)
    middle = np.where(np.arange(d) < oblique, 1.0 / (1.0 + oblique), 0.5)
    at = np.tile(middle, (len(points), 1))
    moving = np.arange(len(points))
    for _ in range(_NEWTON):
        here, nodes = at[moving], corners[moving]
        values, gradients = shape_functions(block.family, here.T)
        miss = points[moving] - np.einsum("nk,nki->ni", values, nodes)
        step = solved(nodes.transpose(0, 2, 1) @ gradients, miss)
        at[moving] = np.clip(here + step, -2.0, 3.0)
        moving = moving[np.abs(at[moving] - here).max(axis=1) >= _SETTLED]
        if not len(moving):
            break
    far = at[:, :oblique].sum(axis=1, keepdims=True) - 1.0
    outside = np.hstack([-at, far, at[:, oblique:] - 1.0]).max(axis=1)
    values, _ = shape_functions(block.family, at.T)
    size = np.ptp(corners, axis=1).max(axis=1) if len(corners) else np.empty(0)
    miss = np.linalg.norm(points - np.einsum("nk,nki->ni", values, corners), axis=1)
    return at, np.where(miss > _OUTSIDE * size, np.inf, np.maximum(outside, 0.0))
