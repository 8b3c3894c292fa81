# SPDX-License-Identifier: BSD-3-Clause
"""Values of data that vary, at nodes and on facets."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where, spell_point
from signorini.fem.boundary import Boundary
from signorini.fem.space import Space
from signorini.model.varying import ArcLength, NodeValues, Varying


def at_nodes(given: Varying, space: Space, nodes: IntArray, where: Where, side: Boundary | None = None) -> Array:
    """Values at nodes, (k,); those of functions of the place go along with nodes that have moved.

    Parameters
    ----------
    given : a number or what varies
    space : its mesh has the nodes
    nodes : (k,)
    where : what errors call it
    side : the boundary that the nodes are of, for what varies over its arc length

    Raises
    ------
    InputError
        If a node has no value, or a place one that is no finite number.
    """
    if isinstance(given, float | int):
        return np.full(len(nodes), float(given))
    if isinstance(given, NodeValues):
        found = _listed(given, space, nodes, where)
    elif isinstance(given, ArcLength):
        found = given.on(_arc_lengths(given, space, nodes, side, where))
    else:
        found = _evaluated(given, space.undeformed[nodes], (len(nodes),), where)
    return found


def on_facets(given: Varying, space: Space, side: Boundary, where: Where) -> list[Array]:
    """Values at the quadrature points of every block of facets of a side, (m, q).

    Values that are known at nodes are in between as displacements are.

    Parameters
    ----------
    given : a number or what varies
    space : of the side
    side : the boundary
    where : what errors call it

    Raises
    ------
    InputError
        As :func:`at_nodes`.
    """
    if isinstance(given, float | int):
        return [np.full(block.at.shape[:2], float(given)) for block in side.blocks]
    nodal = at_nodes(given, space, side.nodes, where, side)
    if isinstance(given, NodeValues | ArcLength):
        places = [np.searchsorted(side.nodes, block.facets) for block in side.blocks]
        return [nodal[place] @ block.shapes[0].T for place, block in zip(places, side.blocks, strict=True)]
    return [
        _evaluated(given, block.at.reshape(-1, block.dimension), (block.at[..., 0].size,), where).reshape(
            block.at.shape[:2]
        )
        for block in side.blocks
    ]


def _evaluated(given: Varying, points: Array, shape: tuple[int, ...], where: Where) -> Array:
    """What a function makes of points (k, d)."""
    assert callable(given)
    try:
        found = np.asarray(given(points), float)
    except InputError as error:
        raise InputError(error.message, where=where) from error
    except (TypeError, ValueError, IndexError) as error:
        raise InputError(
            f"is a function that says '{error}' of points {points.shape}; expected one of points (k, "
            f"{points.shape[1]}) that gives (k,)",
            where=where,
        ) from error
    if found.shape != shape:
        raise InputError(
            f"is a function that gives shape {found.shape} for points {points.shape}; expected {shape}", where=where
        )
    wrong = np.flatnonzero(~np.isfinite(found))
    if len(wrong):
        raise InputError(
            f"is {found[wrong[0]]} at {spell_point(points[wrong[0]])}; expected a finite number", where=where
        )
    return found


def _listed(given: NodeValues, space: Space, nodes: IntArray, where: Where) -> Array:
    """From a table of the nodes."""
    if given.nodes is None:
        count = len(space.mesh.points)
        if len(given.values) != count:
            raise InputError(f"has {len(given.values)} values; expected one per node of the mesh, {count}", where=where)
        found: Array = given.values[nodes]
        return found
    order = np.argsort(given.nodes)
    labels = np.asarray(space.mesh.labels)[nodes]
    place = np.minimum(np.searchsorted(given.nodes[order], labels), len(order) - 1)
    lacks = np.flatnonzero(given.nodes[order][place] != labels)
    if len(lacks):
        raise InputError(
            f"has no value at node {labels[lacks[0]]}; expected one at each of the {len(nodes)} nodes there",
            where=where,
        )
    return np.asarray(given.values[order][place])


def _arc_lengths(given: ArcLength, space: Space, nodes: IntArray, side: Boundary | None, where: Where) -> Array:
    """Of nodes of a plane boundary, (k,): chords from its end, or its node, that is nearest to where it starts."""
    if side is None or side.dimension != 2:
        raise InputError(
            "varies over an arc length; expected it on a boundary of plane or axisymmetric bodies", where=where
        )
    facets = np.concatenate([block.facets for block in side.blocks])
    # first end, middle if there is one, second end
    links = facets[:, [0, 2, 1]] if facets.shape[1] == 3 else facets
    pairs = np.concatenate([links[:, i : i + 2] for i in range(links.shape[1] - 1)])
    following = dict(pairs.tolist())
    preceding = dict(pairs[:, ::-1].tolist())
    ends = [node for node in side.nodes.tolist() if (node in following) != (node in preceding)]
    points = space.mesh.points
    if len(following) != len(pairs) or len(preceding) != len(pairs) or len(ends) not in (0, 2):
        raise InputError("varies over an arc length, but the boundary is not one line; expected one", where=where)
    from_here = ends or side.nodes.tolist()
    first = min(from_here, key=lambda node: float(np.linalg.norm(points[node] - np.array(given.start))))
    way = following if first in following else preceding
    chain = [first]
    while (node := way.get(chain[-1])) is not None and node != first:
        chain.append(node)
    if len(chain) != len(side.nodes):
        raise InputError("varies over an arc length, but the boundary is not one line; expected one", where=where)
    steps = np.linalg.norm(np.diff(points[chain], axis=0), axis=1)
    length = np.full(len(points), np.nan)
    length[chain] = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(length[nodes])
