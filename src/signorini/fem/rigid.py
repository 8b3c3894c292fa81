# SPDX-License-Identifier: BSD-3-Clause
"""Connected parts: which rigid motions are left to them, and how to say these."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from signorini.arrays import Array, BoolArray, IntArray, among, extent, index_type
from signorini.dense import symmetric_eigen
from signorini.fem._kernels import connected_pieces
from signorini.fem.obstacles import arm
from signorini.fem.space import Space
from signorini.model.model import Model
from signorini.sparse_rows import gram

_HELD_LEAST = 1e-12  # of the largest eigenvalue of the Gram matrix of the motions: below it a motion is not held
_REST_TOL = 1e-10  # of the largest coefficient of a motion: what eigenvectors leave to parts that are at rest
_TRANSLATION = "move along"


@dataclass(frozen=True, kw_only=True, eq=False)
class ConnectedBody:
    """A connected piece of the mesh.

    Attributes
    ----------
    bodies : names of the bodies it is made of
    nodes : (k,) its nodes
    centre : (d,) their mean, length
    size : half the diagonal of its bounding box, length
    obstacle : number of the rigid obstacle, or rigid body, that it is instead, otherwise -1: no nodes, the point about
        which it rotates and the length that goes with its rotation
    axes : along which it can move
    rotations : about how many axes it can rotate
    kind : what it is called: "body", "obstacle", "rigid body", "node"
    """

    bodies: tuple[str, ...]
    nodes: IntArray
    centre: Array
    size: float
    obstacle: int = -1
    axes: tuple[int, ...] = (0, 1)
    rotations: int = 1
    kind: str = "body"

    @property
    def label(self) -> str:
        """As in "body 'disk'"."""
        if self.kind == "node":
            return f"node {self.bodies[0]}"
        kind = self.kind if len(self.bodies) == 1 else "bodies"
        return f"{kind} " + " and ".join(f"'{name}'" for name in self.bodies)

    @property
    def motions(self) -> int:
        """How many rigid motions it has."""
        return len(self.axes) + self.rotations

    def among(self, kept: BoolArray) -> ConnectedBody:
        """What is left of a piece that keeps some of (nodes of the mesh,)."""
        return replace(self, nodes=self.nodes[kept[self.nodes]])


def connected_bodies(space: Space, model: Model) -> tuple[ConnectedBody, ...]:
    """The connected pieces of the mesh in the order of their first nodes, then what moves without being meshed.

    Those are rigid obstacles, rigid bodies, and nodes of no cell that equations name.
    """
    return (*_pieces(space, model), *_rigid(model), *_loose_nodes(space))


def hinged(space: Space, part: ConnectedBody) -> bool:
    """Whether cells of a piece of the mesh are joined without a common facet, so that they can turn about a node.

    Parameters
    ----------
    space : the mesh
    part : the piece
    """
    own = np.isin(np.concatenate([block.cells[:, 0] for block in space.blocks]), part.nodes)
    pairs = [(f.cell[:-1][same], f.cell[1:][same]) for f in space.facets.values() if len(same := _twice(f.key))]
    one, two = (np.concatenate(cells) for cells in zip(*pairs, strict=True)) if pairs else (np.zeros(0, int),) * 2
    graph = sp.csr_array((np.ones(len(one), np.int8), (one, two)), shape=(len(own), len(own)))
    _, joined = connected_components(graph, directed=False)
    return len(np.unique(joined[own])) > 1


def _twice(key: IntArray) -> IntArray:
    """Where a sorted number stands before an equal one."""
    return np.flatnonzero(key[1:] == key[:-1])


def _freedom(model: Model) -> dict[str, Any]:
    """Axes along which a body can move, and the number of those about which it can rotate."""
    d = model.dimension
    return (
        {"axes": (1,), "rotations": int(model.twists)}
        if model.axisymmetric
        else {"axes": tuple(range(d)), "rotations": len(rotation_planes(d))}
    )


def _pieces(space: Space, model: Model) -> list[ConnectedBody]:
    """Pieces of the mesh."""
    points, count = space.mesh.points, len(space.mesh.points)
    sizes = np.repeat([block.cells.shape[1] for block in space.blocks], [len(block.cells) for block in space.blocks])
    corner = np.concatenate([block.cells.ravel() for block in space.blocks]).astype(np.int32)
    piece = connected_pieces(np.append(0, np.cumsum(sizes)), corner, count)
    number, owner = int(piece.max()) + 1, model.body_of_cells()
    pieces_of = [
        among([piece[b.cells[owner[b.first : b.first + len(b.cells)] == i, 0]] for b in space.blocks], number)
        for i in range(len(model.bodies))
    ]
    parts = []
    for i in np.flatnonzero(among([piece[space.used_nodes]], number)):
        nodes = np.nonzero(piece == i)[0].astype(index_type(space.number_of_dofs))
        names = tuple(body.name for body, own in zip(model.bodies, pieces_of, strict=True) if own[i])
        at = points[nodes]
        centre, size = at.mean(axis=0), float(np.linalg.norm(extent(at)) / 2.0)
        parts.append(ConnectedBody(bodies=names, nodes=nodes, centre=centre, size=size, **_freedom(model)))
    return parts


def _rigid(model: Model) -> list[ConnectedBody]:
    """Rigid obstacles, then rigid bodies."""
    rigid = [(obstacle.name, obstacle.about, "obstacle") for obstacle in model.obstacles]
    rigid += [(body.name, body.point, "rigid body") for body in model.rigid_bodies]
    if not rigid:
        return []
    given = {"nodes": np.empty(0, int), "size": arm(model), **_freedom(model)}
    return [
        ConnectedBody(bodies=(name,), centre=np.array(about), obstacle=j, kind=kind, **given)
        for j, (name, about, kind) in enumerate(rigid)
    ]


def _loose_nodes(space: Space) -> list[ConnectedBody]:
    """Nodes of no cell, which do not rotate."""
    points, labels = space.mesh.points, space.mesh.labels
    given: dict[str, Any] = {"axes": tuple(range(space.components)), "rotations": 0, "kind": "node"}
    return [
        ConnectedBody(bodies=(str(labels[i]),), nodes=np.array([i]), centre=points[i], size=1.0, **given)
        for i in space.loose_nodes
    ]


def rotation_planes(dimension: int) -> tuple[tuple[int, int], ...]:
    """Of every rotation the axis that it turns into the other."""
    return ((0, 1),) if dimension == 2 else ((1, 2), (2, 0), (0, 1))


def free_motions(resisted: Array, seen: sp.csr_array) -> Array:
    """Rigid motions that supports and elastic foundations allow and of which nothing else that is held sees any.

    Parameters
    ----------
    resisted : (motions of all parts, motions of all parts), see :func:`signorini.fem.rigid_motions.resistance`
    seen : (rows, motions of all parts) what further components that are held, of unit size, see of the motions

    Returns
    -------
    (motions of all parts, k) coefficients, a basis as simple as it can be
    """
    values, vectors = symmetric_eigen(resisted + gram(seen))
    return _readable(vectors[:, values <= _HELD_LEAST * max(1.0, values[-1])])


def describe_motion(parts: tuple[ConnectedBody, ...], motion: Array) -> str:
    """A rigid motion in words: of every part that moves, along what or about where.

    Parameters
    ----------
    motion : coefficients of the rigid motions

    Examples
    --------
    >>> block = ConnectedBody(bodies=("block",), nodes=np.arange(4), centre=np.array([1.0, 0.5]), size=1.0)
    >>> describe_motion((block,), np.array([1.0, 0.0, 0.0]))
    "body 'block' can move along x"
    """
    return " while ".join(f"{part.label} can {' '.join(_way(part, own))}" for part, own in _moving(parts, motion))


def describe_motions(parts: tuple[ConnectedBody, ...], motions: Array) -> list[str]:
    """Several rigid motions in words, one sentence for all that the same parts can do.

    Parameters
    ----------
    motions : (motions of all parts, k) coefficients of the rigid motions

    Examples
    --------
    >>> block = ConnectedBody(bodies=("block",), nodes=np.arange(4), centre=np.array([1.0, 0.5]), size=1.0)
    >>> describe_motions((block,), np.eye(3))
    ["body 'block' can move along x and y, and rotate about (1, 0.5)"]
    """
    alike: dict[tuple[int, ...], list[Array]] = {}
    for motion in motions.T:
        alike.setdefault(tuple(id(part) for part, _ in _moving(parts, motion)), []).append(motion)
    return [_sentence(parts, group) for group in alike.values()]


def describe_approach(parts: tuple[ConnectedBody, ...], motion: Array, loose: Array) -> list[str]:
    """How far parts have moved before they touched, a sentence for each that did.

    Parameters
    ----------
    motion : coefficients of the rigid motions
    loose : what of it nothing but resistance to motion decided

    Examples
    --------
    >>> block = ConnectedBody(bodies=("block",), nodes=np.arange(4), centre=np.array([1.0, 0.5]), size=2.0)
    >>> describe_approach((block,), np.array([0.0, -0.25, 0.002]), np.zeros(3))
    ["body 'block' approaches by 0.25 along -y and turns by 0.001 before contact can hold it"]
    """
    free = {id(part): own for part, own in _moving(parts, loose)} if loose.any() else {}
    sentences = []
    for part, own in _moving(parts, motion):
        ways, turn = [], np.linalg.norm(own[len(part.axes) :])
        along = np.zeros(len(part.centre))
        along[list(part.axes)] = own[: len(part.axes)]
        if along.any():
            ways.append(f"approaches by {np.linalg.norm(along):.4g} along {_direction(along)}")
        if turn:
            ways.append(f"turns by {turn / part.size:.4g}")
        said = f"{part.label} {' and '.join(ways)} before contact can hold it"
        if id(part) in free and free[id(part)][len(part.axes) :].any():
            said += "; the loads do not say how it turns on the way, taken is what a body of one density would do"
        sentences.append(said)
    return sentences


def _direction(vector: Array) -> str:
    """Of a vector, as in "-y", or its components."""
    unit = vector / np.linalg.norm(vector)
    k = int(np.argmax(np.abs(unit)))
    return f"{'-' if unit[k] < 0 else ''}{'xyz'[k]}" if np.count_nonzero(unit) == 1 else _spell(unit)


def _sentence(parts: tuple[ConnectedBody, ...], motions: list[Array]) -> str:
    """Motions of the same parts in words."""
    moving = [_moving(parts, motion) for motion in motions]
    if len(moving[0]) > 1:
        return ", and ".join(describe_motion(parts, motion) for motion in motions)
    ways: dict[str, list[str]] = {_TRANSLATION: []}
    for ((part, own),) in moving:
        how, what = _way(part, own)
        ways.setdefault(how, []).append(what)
    words = [
        f"{how.replace('the axis', 'the axes') if len(what) > 1 else how} {_listed(what)}"
        for how, what in ways.items()
        if what
    ]
    return f"{moving[0][0][0].label} can {', and '.join(words)}"


def _moving(parts: tuple[ConnectedBody, ...], motion: Array) -> list[tuple[ConnectedBody, Array]]:
    """The parts that move, and their coefficients without rounding."""
    clean = np.where(np.abs(motion) < 1e-6 * np.abs(motion).max(), 0.0, motion)
    ends = np.cumsum([part.motions for part in parts])
    return [(part, own) for part, own in zip(parts, np.split(clean, ends[:-1]), strict=True) if own.any()]


def _way(part: ConnectedBody, own: Array) -> tuple[str, str]:
    """How a part moves, and along which direction or about which point (in space an axis)."""
    along, turn = np.zeros(max(len(part.centre), len(part.axes))), own[len(part.axes) :]
    along[list(part.axes)] = own[: len(part.axes)]
    if part.axes == (1,):
        ways = [_TRANSLATION] * bool(along.any()) + ["turn about"] * bool(turn.any())
        return " and ".join(ways), "the axis"
    if not turn.any():
        direction = along / np.linalg.norm(along)
        named = "xyz"[int(np.argmax(np.abs(direction)))]
        return _TRANSLATION, named if np.count_nonzero(along) == 1 else _spell(direction)
    if len(turn) == 1:
        centre = part.centre + part.size * np.array([-along[1], along[0]]) / turn
        return "rotate about", _spell(centre, part.size)
    rate = float(np.linalg.norm(turn))
    axis: Array = turn / rate
    centre = part.centre + part.size * np.cross(axis, along) / rate
    upward = axis * np.sign(axis[np.argmax(np.abs(axis))])
    screw = " while it moves along it" if abs(along @ axis) >= 1e-6 * rate else ""
    return f"rotate about the axis through {_spell(centre, part.size)} along", f"{_spell(upward)}{screw}"


def _listed(words: list[str]) -> str:
    """As in "x, y and z"."""
    return " and ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)


def _spell(values: Array, size: float = 1.0) -> str:
    return f"({', '.join(f'{0.0 if abs(x) < 1e-9 * size else x:.4g}' for x in values)})"


def _readable(motions: Array) -> Array:
    """A basis of the same motions (motions, k) with as few parts and directions in each as can be (row echelon)."""
    basis = motions.T.copy()
    row = 0
    for column in range(basis.shape[1]):
        if row == len(basis):
            break
        pivot = row + int(np.argmax(np.abs(basis[row:, column])))
        if abs(basis[pivot, column]) < 1e-6:
            continue
        basis[[row, pivot]] = basis[[pivot, row]]
        basis[row] /= basis[row, column]
        others = np.arange(len(basis)) != row
        basis[others] -= np.outer(basis[others, column], basis[row])
        row += 1
    # what does not move is exactly at rest, or rounding would be taken for a motion of it
    return np.where(np.abs(basis) > _REST_TOL * np.abs(basis).max(axis=1, initial=0.0)[:, None], basis, 0.0).T
