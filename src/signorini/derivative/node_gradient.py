# SPDX-License-Identifier: BSD-3-Clause
"""An output by the place of every node: cells in one pass, loads and pairs by differences of those near a node.

What a motion of nodes changes is (see `body_changes`) the sum over the points of the history of

    w . (f' + B'^T r - K' u) + J . (B' u + C' r + g')

with adjoint displacements w, and what the output has of areas, normals and places itself.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.derivative.adjoint_terms import Adjoint
from signorini.derivative.body_side import multiplier, places_matter
from signorini.derivative.contact_sums import ContactSums
from signorini.derivative.functionals import nodes_around, stress_at
from signorini.derivative.low_rank import combinations_of, of_same_bodies
from signorini.derivative.node_differences import NodeDifferences, within
from signorini.derivative.node_sides import SideSums
from signorini.derivative.view import HistoryView
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.displacement_products import Products
from signorini.fem.foundation import make_springs
from signorini.fem.loads import load_forces
from signorini.fem.node_work import add_node_work
from signorini.fem.space import ON_AXIS, Space
from signorini.model.conditions import BODY_LOADS, Load
from signorini.model.outputs import Output, Stress, WeightedSum
from signorini.sparse_rows import selection

_SPREAD = ("force", "bearing", "torque")  # loads that are given as a sum
_STRESS_STEP = 1e-5  # of the size of the cells of a node: differences of its stress are right to 1e-10 then


def node_gradient(view: HistoryView, adjoint: Adjoint, output: Output) -> Array:
    """(nodes, d) An output by the places of all nodes, per length; radii of nodes on the axis stay.

    Parameters
    ----------
    view, adjoint : the history, and the output's way back through it
    output : what is differentiated

    Raises
    ------
    InputError
        Where supports or rigid bodies hold nodes by where they are.
    """
    prepared = view.points[-1].system.prepared
    model, space = view.model, view.space
    if places_matter(model):
        words = (
            "rigid bodies, equations or supports that vary hold nodes by where they are; derivatives by nodes do not"
        )
        words += " know that, shape(motion) does where such nodes stay"
        raise InputError(words, where=("nodes",))
    free, found = _free(view), np.zeros_like(space.mesh.points)
    weighted = {load.label: np.zeros(space.number_of_dofs) for load in model.loads}
    sides = SideSums(view=view, adjoint=adjoint, output=output)
    for own in of_same_bodies(view.every, adjoint):
        sums = _sums(view, own, adjoint, sides.rows)
        if sums is not None:
            found -= adjoint.work_by_places(own, prepared, (part.of_cells() for part in (sums,)))
            for name in sums.weighted.keys() & weighted.keys():
                weighted[name] += sums.weighted[name]
            sides.add(sums.system, sums.motion, sums.forces, *sums.on_contact(sides.rows), sums.one)
            continue
        for columns in combinations_of(view.every, own, adjoint):
            w, u = columns.adjoint, columns.displacement
            add_node_work(found, space, model, Products.of(-w, u))
            if model.foundations:
                found -= _of_foundations(view, free, w, u)
            for name, share in weighted.items():
                share += w @ columns.factor(name)
            sides.add(columns.system, columns.motion, columns.forces, sides.rows @ w, sides.rows @ u, columns.one)
    for i, load in enumerate(model.loads):
        if _has_shape(load, model.mesh.boundaries) and weighted[load.label].any():
            found += multiplier(prepared, load.label) * _of_load(view, free, i, weighted[load.label])
    found += sides.gradient(free) + sides.shape.places
    for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
        if isinstance(part, Stress):
            found += factor * _of_stress(view, part)
    return np.where(free, found, 0.0)


def _sums(view: HistoryView, own: Sequence[int], adjoint: Adjoint, rows: sp.csr_array) -> ContactSums | None:
    """Sums over points of the same bodies; None where they do not tell all that is asked for.

    Parameters
    ----------
    view, own, adjoint : the history, numbers of the points, and the output's way back
    rows : (k, dofs) of displacements that pairs may see
    """
    system = view.every[own[0]].system
    if len(system.prepared.constraints.dependent) or view.model.foundations or not ContactSums.knows(system, len(own)):
        return None
    sums = ContactSums(view.every, own, adjoint)
    return sums if sums.meets(rows) else None


def _free(view: HistoryView) -> BoolArray:
    """(nodes, d) Which coordinates may change: not radii of nodes on the axis."""
    points = view.space.mesh.points
    free = np.ones(points.shape, dtype=np.bool_)
    if view.model.axisymmetric:
        free[points[:, 0] <= ON_AXIS * points[:, 0].max(), 0] = False
    return free


def _has_shape(load: Load, boundaries: Collection[str]) -> bool:
    """Whether the nodal forces of a load depend on where nodes are."""
    return load.nodal_forces is None and (
        load.kind in BODY_LOADS or load.kind == "temperature" or load.on in boundaries
    )


def _of_load(view: HistoryView, free: BoolArray, i: int, weight: Array) -> Array:
    """(nodes, d) Of the work of the forces of load i on displacements (dofs,)."""
    model, load, space = view.model, view.model.loads[i], view.space
    if load.on in model.mesh.boundaries:
        facets = [block.facets for block in boundary(space, str(load.on), ("load", i, "on")).blocks]
    else:
        facets = [block.cells for block in space.blocks]
    own = np.unique(np.concatenate([part.ravel() for part in facets]))

    def work(at: Space) -> Array:
        return at.at_nodes(load_forces(at, model, load, ("load", i)) * weight).sum(axis=1)[own]

    if load.kind in _SPREAD:  # over an area that depends on all of them
        near = sp.csr_array(np.ones((len(own), 1)) @ np.bincount(own, minlength=len(free))[None].clip(max=1))
    else:
        near = within(selection(own, len(free)), facets, 1)
    return NodeDifferences(space=space, near=near, free=free).gradient(work)


def _of_foundations(view: HistoryView, free: BoolArray, w: Array, u: Array) -> Array:
    """(nodes, d) Of the work of all foundations on displacements w (dofs, k) under u."""
    space, model = view.space, view.model

    def work(at: Space) -> Array:
        springs = sp.csr_array(sp.vstack(list(make_springs(at, model).values())))
        return np.asarray(((springs @ w) * (springs @ u)).sum(axis=1))

    springs = sp.coo_array(sp.vstack(list(make_springs(space, model).values())))
    at_nodes = (np.ones(springs.nnz), (springs.row, springs.col // space.components))
    near = sp.csr_array(at_nodes, shape=(springs.shape[0], len(free)))
    return NodeDifferences(space=space, near=near, free=free).gradient(work)


def _of_stress(view: HistoryView, output: Stress) -> Array:
    """(nodes, d) Of a stress while displacements stay: by the nodes of the cells of its node."""
    i, space, found = view.number(output.load_factor), view.space, np.zeros_like(view.space.mesh.points)
    u, around = view.displacement(i), nodes_around(output.node, view)
    step = _STRESS_STEP * float(np.ptp(space.mesh.points[around], axis=0).max())
    for node in around:
        for axis in range(space.dimension):
            motion = np.zeros_like(found)
            motion[node, axis] = step
            high, low = (
                stress_at(
                    output, replace(view, space=space.at(space.mesh.points + way * motion, space.displacement)), u, i
                )
                for way in (1.0, -1.0)
            )
            found[node, axis] = (high - low) / (2.0 * step)
    return found
