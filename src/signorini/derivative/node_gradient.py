# SPDX-License-Identifier: BSD-3-Clause
"""An output by the place of every node: cells in one pass, loads and pairs by differences of those near a node.

What a motion of nodes changes is (see `body_changes`) the sum over the points of the history of

    w . (f' + B'^T r - K' u) + J . (B' u + C' r + g')

with adjoint displacements w, and what the output has of areas, normals and places itself.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, distinct
from signorini.derivative.adjoint_terms import Adjoint
from signorini.derivative.body_side import at_pieces, multiplier, places_matter, under_load
from signorini.derivative.contact_sums import ContactSums
from signorini.derivative.low_rank import combinations_of, of_same_bodies
from signorini.derivative.node_differences import NodeDifferences, within
from signorini.derivative.node_sides import SideSums
from signorini.derivative.stress_output import StressOutput
from signorini.derivative.view import HistoryView
from signorini.engine.examine import on_ranks
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.foundation import make_springs
from signorini.fem.loads import forces_at, load_forces
from signorini.fem.space import ON_AXIS, Space
from signorini.model.conditions import BODY_LOADS, Load
from signorini.model.model import Model
from signorini.model.outputs import Output, Stress, WeightedSum
from signorini.sparse_rows import chosen_columns, seen_by, selection

_SPREAD = ("force", "bearing", "torque")  # loads that are given as a sum


def node_gradient(view: HistoryView, adjoint: Adjoint, output: Output) -> Any:
    """(nodes d,) An output by the places of all nodes, per length; radii of nodes on the axis stay.

    Where vectors of all displacements are: here, or on the ranks of MPI.

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
    model, space, constraints = view.model, view.space, prepared.constraints
    if places_matter(model):
        words = (
            "rigid bodies, equations or supports that vary hold nodes by where they are; derivatives by nodes do not"
        )
        words += " know that, shape(motion) does where such nodes stay"
        raise InputError(words, where=("nodes",))
    free, found = _free_places(space, model), NodeSums(prepared)
    weighted: dict[str, Any] = {load.label: constraints.zeros for load in model.loads}
    sides = SideSums(view=view, adjoint=adjoint, output=output)
    for own in of_same_bodies(view.every, adjoint):
        sums = _sums(view, own, adjoint, sides.rows)
        if sums is not None:
            found.add(-adjoint.work_by_places(own, [sums]))
            for name in sums.weighted.keys() & weighted.keys():
                weighted[name] += sums.weighted[name]
            sides.add(sums.system, sums.motion, sums.forces, *sums.on_contact(sides.rows), sums.one)
            continue
        for columns in combinations_of(view.every, own, adjoint):
            w, u = columns.adjoint, columns.displacement
            found.add(-columns.by_places())
            if model.foundations:
                found.add_at(*_of_foundations(view, free, w, u), -1.0)
            for name, share in weighted.items():
                weighted[name] = share + w @ columns.factor(name)
            seen = seen_by(sides.rows, w), seen_by(sides.rows, u)
            sides.add(columns.system, columns.motion, columns.forces, *seen, columns.one)
    for i, load in enumerate(model.loads):
        if _has_shape(load, model.mesh.boundaries) and weighted[load.label].any():
            size = multiplier(prepared, load.label)
            if load.kind in BODY_LOADS or load.temperature is not None:
                found.add(size * _of_body_load(prepared, i, weighted[load.label]))
            else:
                found.add_at(*_of_load(view, free, i, weighted[load.label]), size)
    found.add_at(*sides.gradient(free))
    found.add_at(*sides.places)
    for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
        if isinstance(part, Stress):
            stress = StressOutput(part, view)
            moved = view.displacement(view.number(part.load_factor))[space.dofs(stress.nodes)]
            found.add_at(stress.nodes, stress.by_places(moved), factor)
    return np.where(found.placed(free), found.total, 0.0)


class NodeSums:
    """Sums by the places of all nodes, where vectors of all displacements are.

    Attributes
    ----------
    total : (nodes d,)

    Parameters
    ----------
    prepared : the bodies
    """

    def __init__(self, prepared: Prepared) -> None:
        self._K, self._d = prepared.K, prepared.space.dimension
        count = prepared.space.mesh.number_of_nodes * self._d
        self.total: Any = self._K.places.zeros if on_ranks(self._K) else np.zeros(count)

    def placed(self, values: Any) -> Any:
        """(nodes d,) Values (nodes, d) there."""
        return self._K.places.of(values.ravel()) if on_ranks(self._K) else values.ravel()

    def add(self, values: Any) -> None:
        """Add values (nodes d,) that are there."""
        self.total = self.total + values

    def add_at(self, nodes: IntArray, values: Array, factor: float = 1.0) -> None:
        """Add values (k, d) times a factor at some nodes (k,), each of which is there once."""
        at = (self._d * nodes[:, None] + np.arange(self._d)).ravel()
        if on_ranks(self._K):
            self.add(self._K.places.spread(at, factor * values.ravel()))
        else:
            self.total[at] += factor * values.ravel()


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


def _free_places(space: Space, model: Model) -> BoolArray:
    """(nodes, d) Which coordinates may change: not radii of nodes on the axis."""
    points = space.mesh.points
    free = np.ones(points.shape, dtype=np.bool_)
    if model.axisymmetric:
        free[points[:, 0] <= ON_AXIS * points[:, 0].max(), 0] = False
    return free


def _has_shape(load: Load, boundaries: Collection[str]) -> bool:
    """Whether the nodal forces of a load depend on where nodes are."""
    return load.nodal_forces is None and (
        load.kind in BODY_LOADS or load.kind == "temperature" or load.on in boundaries
    )


def _of_load(view: HistoryView, free: BoolArray, i: int, weight: Any) -> tuple[IntArray, Array]:
    """Nodes (m,), and (m, d) by their places of the work of load i, on a boundary, on displacements (dofs,)."""
    model, load, space = view.model, view.model.loads[i], view.space
    facets = [block.facets for block in boundary(space, str(load.on), ("load", i, "on")).blocks]
    own = np.unique(np.concatenate([part.ravel() for part in facets]))
    moved: Array = weight[space.dofs(own)]

    def work(at: Space) -> Array:
        nodes, forces = forces_at(at, model, load, ("load", i))
        return np.asarray((forces * moved[np.searchsorted(own, nodes)]).sum(axis=1))

    if load.kind in _SPREAD:  # over an area that depends on all of them
        k = len(own)
        near = sp.csr_array((np.ones(k * k), np.tile(own, k), np.arange(0, k * k + 1, k)), shape=(k, len(free)))
    else:
        near = within(selection(own, len(free)), facets, 1)
    return NodeDifferences(space=space, near=near, free=free).gradient(work)


def _of_body_load(prepared: Prepared, i: int, weight: Any) -> Any:
    """(nodes d,) Of the work of the forces of load i, on a body, on displacements (dofs,), where these are."""
    load, K = prepared.model.loads[i], prepared.K
    table, given = prepared.constraints.beside([weight]), load.temperature
    if on_ranks(K) and not callable(given):  # a function of places may be known here alone
        return K.by_places(_body_load_by_places, [table], *at_pieces(K, load))
    found = _body_load_by_places(prepared.space, prepared.model, np.asarray(table), load, given).ravel()
    return K.places.of(found) if on_ranks(K) else found


def _body_load_by_places(space: Space, model: Model, weight: Array, load: Load, temperature: Any) -> Array:
    """(nodes, d) Of the work of the forces of a load on displacements (dofs, 1), in all cells or those of a piece."""
    found = np.zeros_like(space.mesh.points)
    if all(body.name != load.on for body in model.bodies):
        return found
    model, load = under_load(model, load, temperature)
    cells = [block.cells for block in space.blocks]
    own = distinct(np.concatenate([part.ravel() for part in cells]))

    def work(at: Space) -> Array:
        return at.at_nodes(load_forces(at, model, load, ("load",)) * weight[:, 0]).sum(axis=1)[own]

    near = within(selection(own, len(found)), cells, 1)
    nodes, values = NodeDifferences(space=space, near=near, free=_free_places(space, model)).gradient(work)
    found[nodes] = values
    return found


def _of_foundations(view: HistoryView, free: BoolArray, w: Any, u: Any) -> tuple[IntArray, Array]:
    """Nodes (m,), and (m, d) by their places of the work of all foundations on displacements w (dofs, k) under u."""
    space, model = view.space, view.model
    every = sp.coo_array(sp.vstack(list(make_springs(space, model).values())))
    seen = distinct(every.col)
    moved, pushed = w[seen], u[seen]

    def work(at: Space) -> Array:
        springs = chosen_columns(sp.csr_array(sp.vstack(list(make_springs(at, model).values()))), seen)
        return np.asarray(((springs @ moved) * (springs @ pushed)).sum(axis=1))

    at_nodes = (np.ones(every.nnz), (every.row, every.col // space.components))
    near = sp.csr_array(at_nodes, shape=(every.shape[0], len(free)))
    return NodeDifferences(space=space, near=near, free=free).gradient(work)
