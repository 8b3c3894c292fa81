# SPDX-License-Identifier: BSD-3-Clause
"""Sections between the halves of a body that is given in two, and equations that keep halves opposite each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.errors import InputError, Where, one_of
from signorini.meshing.cut import HALF_ABOVE, HALF_BELOW, facet_areas
from signorini.meshing.facets import make_facets, outer_facets
from signorini.model.links import AXES, Equation, Term
from signorini.model.mesh import Mesh

_MATCH_TOL = 1e-6  # of the size of the mesh: how far nodes of one half may be from those of the other


def section(mesh: Mesh, name: str, below: str, above: str, *, node: bool = True) -> Mesh:
    """The mesh with a section between two halves of a body, as :func:`signorini.cut` makes one inside a body.

    The facets of both are also called ``name.below`` and ``name.above``, and the node set ``name`` is one node of no
    cell, in the middle of the section.

    Parameters
    ----------
    mesh : with both halves, which share no node
    name : of the section
    below, above : outer boundaries of the halves, whose nodes lie in the same places, or which lie in one plane
    node : whether to make the node apart

    Raises
    ------
    InputError
        If nodes of the halves do not lie in the same places, nor all in one plane, or these look the same way.

    Examples
    --------
    >>> import signorini as sg
    >>> halves = {"foot": sg.rectangle(nx=1, ny=1, width=1, height=1), "head": sg.rectangle(x=[0, 1], y=[1, 2])}
    >>> section(sg.join(halves), "shank", "foot.top", "head.bottom").nodes["shank"]
    array([8])
    """
    where: Where = ("mesh", "boundaries")
    for own in (below, above):
        if own not in mesh.boundaries:
            raise InputError(one_of(own, mesh.boundaries, "boundary"), where=where)
    if name in mesh.boundaries:
        raise InputError(f"there is a boundary '{name}'; expected a new name of a section", where=where)
    facets = make_facets(mesh)
    both = [tuple(nodes for nodes, _ in outer_facets(facets, mesh, own, where)) for own in (below, above)]
    low, high = (np.unique(np.concatenate([part.ravel() for part in own])) for own in both)
    shared = np.intersect1d(low, high)
    if len(shared):
        raise InputError(
            f"'{below}' and '{above}' share node {mesh.labels[shared[0]]}; expected halves with nodes of their own, or "
            "a body that is cut",
            where=where,
        )
    try:
        _opposite(mesh, low, high, (below, above), where)
    except InputError:
        if not _in_one_plane(mesh.points[np.concatenate([low, high])]):
            raise
    one, other = (np.concatenate([facet_areas(mesh, part) for part in own]).sum(axis=0) for own in both)
    if one @ other >= 0.0:
        raise InputError(
            f"'{below}' and '{above}' look the same way; expected halves that face each other", where=where
        )
    middle = mesh.points[low].mean(axis=0)[None, :] if node else np.empty((0, mesh.points.shape[1]))
    return replace(
        mesh,
        points=np.concatenate([mesh.points, middle]),
        boundaries={**mesh.boundaries, name + HALF_BELOW: both[0], name + HALF_ABOVE: both[1]},
        nodes={**mesh.nodes, **({name: np.array([len(mesh.points)])} if node else {})},
        node_numbers=np.concatenate([mesh.labels, mesh.labels.max() + 1 + np.arange(len(middle))]),
    )


def halves_match(mesh: Mesh, section: str) -> bool:
    """Whether the nodes of both halves of a section lie in the same places."""
    low, high = (mesh.nodes_of(section + half) for half in (HALF_BELOW, HALF_ABOVE))
    try:
        _opposite(mesh, low, high, (section, section), ())
    except InputError:
        return False
    return True


def _in_one_plane(points: Array) -> bool:
    """Whether points lie in a plane, in the plane on a line."""
    arms = points - points.mean(axis=0)
    normal = np.linalg.svd(arms, full_matrices=False)[2][-1]
    return bool(np.abs(arms @ normal).max() <= _MATCH_TOL * float(np.ptp(points, axis=0).max()))


def facets_opposite(mesh: Mesh, name: str) -> tuple[IntArray, ...]:
    """Facets (m, k) of cells in the place of an outer boundary; none where it is inside a body, or nothing is there."""
    from scipy.spatial import cKDTree  # takes longer to load than a deck without bolts to read

    facets = make_facets(mesh)
    try:
        outer_facets(facets, mesh, name, ())
    except InputError:
        return ()
    low = mesh.nodes_of(name)
    distance, _ = cKDTree(mesh.points[low]).query(mesh.points)
    there = distance <= _MATCH_TOL * float(np.ptp(mesh.points, axis=0).max())
    there[low] = False
    return tuple(own for every in facets.values() if len(own := every.nodes[there[every.nodes].all(axis=1)]))


def section_equations(mesh: Mesh, section: str, node: str | int, normal: Array, *, name: str = "") -> list[Equation]:
    """``u_above - u_below + d n = 0`` at every node of a section, d the first displacement of its node.

    Parameters
    ----------
    mesh : with the section
    section : its name
    node : its node: a set or a number
    normal : (d,) n, of length 1
    name : of the equations, what messages call them
    """
    low, high = (mesh.nodes_of(section + half) for half in (HALF_BELOW, HALF_ABOVE))
    halves: list[tuple[str | int, str | int]] = [(section + HALF_BELOW, section + HALF_ABOVE)]
    partner = _opposite(mesh, low, high, (section + HALF_BELOW, section + HALF_ABOVE), ("mesh", "boundaries"))
    if (partner[1:] < partner[:-1]).any():  # sets go together in ascending order, these do not
        halves = list(zip(mesh.labels[low].tolist(), mesh.labels[high[partner]].tolist(), strict=True))
    equations = []
    for below, above in halves:
        for axis, part in zip(AXES, normal.tolist(), strict=False):
            terms: list[Term] = [(above, axis, 1.0), (below, axis, -1.0)]
            equations.append(Equation([*terms, *([(node, "x", part)] if part else [])], name=name))
    return equations


def _opposite(mesh: Mesh, low: IntArray, high: IntArray, names: tuple[str, str], where: Where) -> IntArray:
    """(k,) Which node of the half above lies where each of the half below does."""
    if len(low) == len(high) and (mesh.points[low] == mesh.points[high]).all():
        return np.arange(len(low))
    from scipy.spatial import cKDTree  # takes longer to load than a deck without bolts to read

    distance, partner = cKDTree(mesh.points[high]).query(mesh.points[low])
    apart = distance > _MATCH_TOL * float(np.ptp(mesh.points, axis=0).max())
    if len(low) != len(high) or apart.any() or len(distinct(partner)) < len(partner):
        worst = int(np.argmax(distance))
        raise InputError(
            f"node {mesh.labels[low[worst]]} of '{names[0]}' is {distance[worst]:.4g} away from the next node of "
            f"'{names[1]}', and these are {len(low)} and {len(high)} nodes; expected halves whose nodes lie in the "
            "same places, or halves that lie in one plane",
            where=where,
        )
    return np.asarray(partner)
