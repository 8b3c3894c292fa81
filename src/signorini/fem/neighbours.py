# SPDX-License-Identifier: BSD-3-Clause
"""A sector with its neighbours: copies of its mesh, turned, for what reaches across its sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.obstacles import arm
from signorini.fem.space import Space, make_space
from signorini.fem.supports import Constraints
from signorini.model.mesh import Facets, Mesh
from signorini.model.model import Model
from signorini.model.step import Step

_COPIES = 3  # sectors: the sector itself and two on either side
_SAME_TURN_TOL = 1e-12  # entry of a rotation, or length over the size of the mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class Neighbourhood:
    """A sector and its neighbours on one mesh, whose first nodes are those of the sector.

    Attributes
    ----------
    space, model, constraints : of all of them; of the model what contacts need
    shares : (its dofs, dofs of the sector) what displacements of the sector are there
    source : (nodes,) of which node of the sector every node is a copy
    ahead : (its dofs,) how many sectors on from the sector they are; 0 of obstacles
    turn : (d, d) rotation R of a sector onto the next
    original : (nodes of the sector,) which node of the first side R takes to one of the second; of all others itself
    """

    space: Space
    model: Model
    constraints: Constraints
    shares: sp.csr_array
    source: IntArray
    ahead: IntArray
    turn: Array
    original: IntArray


def neighbourhood(space: Space, model: Model, constraints: Constraints) -> Neighbourhood:
    """A sector with its neighbours.

    Parameters
    ----------
    space, model, constraints : of the sector

    Raises
    ------
    InputError
        If it has sides that turn onto each other differently.
    """
    turn, centre, first, second = _sides(space, model)
    sectors, n = model.cyclic_symmetries[0].sectors, len(space.mesh.points)
    count = min(sectors, _COPIES)
    after, before = count // 2, (count - 1) // 2
    index = np.arange(count * n).reshape(count, n)  # row k is the sector k turns on, which from the end are those back
    for k in range(1, after + 1):
        index[k, first] = index[k - 1, second]
    for k in range(1, before + 1):
        index[-k, second] = index[1 - k, first]
    if count == sectors:
        index[after, second] = index[-before, first]
    on = np.array([*range(after + 1), *range(-before, 0)])
    turns = np.stack([np.linalg.matrix_power(turn, k) for k in on.tolist()])
    index[:, first[first == second]] = first[first == second]
    mesh = _mesh(space.mesh, model, index, np.concatenate([(space.mesh.points - centre) @ t.T + centre for t in turns]))
    given: dict[str, Any] = {
        "supports": (),
        "foundations": (),
        "loads": (),
        "equations": (),
        "bolts": (),
        "cyclic_symmetries": (),
    }
    whole = replace(model, mesh=mesh, steps=(Step(),), fatigue=(), **given)
    source, which = np.tile(np.arange(n), len(turns)), np.repeat(np.arange(len(turns)), n)
    shares = _shares(space, turns[which], source, arm(whole) / arm(model))
    held = (abs(shares) @ (~constraints.held).astype(float)) == 0.0
    original = np.arange(n)
    original[second] = first
    return Neighbourhood(
        space=make_space(mesh, obstacles=space.obstacles),
        model=whole,
        constraints=replace(
            constraints,
            free=np.where(held, -1, 0),
            prescribed={name: shares @ moved for name, moved in constraints.prescribed.items()},
        ),
        shares=shares,
        source=source,
        ahead=np.concatenate([np.repeat(on[which], space.components), np.zeros(shares.shape[0], int)])[
            : shares.shape[0]
        ],
        turn=turn,
        original=original,
    )


def _sides(space: Space, model: Model) -> tuple[Array, Array, IntArray, IntArray]:
    """R and the point that it turns about, and the nodes of all first sides and those of all second sides."""
    turn, *sides = cyclic_sides(space, model, 0)
    first, second = [sides[0]], [sides[1]]
    one = model.cyclic_symmetries[0]
    centre = np.array(one.point or (0.0,) * space.dimension)
    close = _SAME_TURN_TOL * float(np.ptp(space.mesh.points, axis=0).max())
    for j, other in enumerate(model.cyclic_symmetries[1:], start=1):
        way, low, high = cyclic_sides(space, model, j)
        away = centre - np.array(other.point or (0.0,) * space.dimension)
        if np.abs(away - turn @ away).max() > close:
            raise InputError("turns about another point than the first one", where=("cyclic_symmetry", j, "point"))
        if np.abs(way - turn).max() > _SAME_TURN_TOL:
            if np.abs(way - turn.T).max() > _SAME_TURN_TOL:
                words = "turns otherwise than the first one; expected sides that turn alike where they cut contacts"
                raise InputError(words, where=("cyclic_symmetry", j))
            low, high = high, low
        first.append(low)
        second.append(high)
    low, once = np.unique(np.concatenate(first), return_index=True)
    return turn, centre, low, np.concatenate(second)[once]


def _mesh(mesh: Mesh, model: Model, index: IntArray, points: Array) -> Mesh:
    """The copies together; of boundaries those of contacts go on."""
    shift, cells = 0, {}
    numbers = [np.empty(mesh.number_of_cells, np.int64) for _ in index]
    ends = np.cumsum([0, *(len(own) for own in mesh.cells.values())])
    for (family, own), first in zip(mesh.cells.items(), ends, strict=False):
        cells[family] = np.concatenate([nodes[own] for nodes in index])
        for number in numbers:
            number[first : first + len(own)] = shift + np.arange(len(own))
            shift += len(own)
    touching = {name for contact in model.contacts for name in (contact.nonmortar, contact.mortar)}
    boundaries: Mapping[str, Facets] = {
        name: tuple(np.concatenate([nodes[own] for nodes in index]) for own in mesh.facets(name))
        if name in touching
        else given
        for name, given in mesh.boundaries.items()
    }
    labels = mesh.labels
    return replace(
        mesh,
        points=points,
        cells=cells,
        bodies={name: np.concatenate([number[own] for number in numbers]) for name, own in mesh.bodies.items()},
        boundaries=boundaries,
        node_numbers=np.concatenate([labels, labels.max() + 1 + np.arange(len(points) - len(labels))]),
        cell_numbers=None,
    )


def _shares(space: Space, turns: Array, source: IntArray, longer: float) -> sp.csr_array:
    """(dofs, dofs of the sector) ``u = R u_source``; of obstacles the same, with rotations times a longer arm."""
    d, n = space.dimension, len(space.mesh.points)
    rows = np.arange(len(source) * d).reshape(-1, d, 1)
    columns = np.broadcast_to(space.dofs(source)[:, None, :], turns.shape)
    entries = (turns.ravel(), (np.broadcast_to(rows, turns.shape).ravel(), columns.ravel()))
    nodes = sp.csr_array(entries, shape=(len(source) * d, n * d))
    nodes.eliminate_zeros()
    moved = sp.diags_array(np.tile(np.repeat([1.0, longer], d), space.obstacles))
    return sp.csr_array(sp.block_diag([nodes, moved])) if space.obstacles else nodes
