# SPDX-License-Identifier: BSD-3-Clause
"""A stress at a node as an output: it is found on the cells around the node alone, however large the mesh is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.derivative.view import HistoryView
from signorini.distributed.pieces import PartOfBodies
from signorini.errors import InputError, one_of
from signorini.fem.probe import StressProbe
from signorini.fem.space import Space, make_space
from signorini.fem.stress import DeformedBodies
from signorini.model.conditions import Load
from signorini.model.model import Model
from signorini.model.outputs import COMPONENTS, Stress

_STEP = 1e-5  # of the size of the cells of a node: differences of its stress are right to 1e-10 then


class StressOutput:
    """A stress at a point of a history, by what moves at the nodes that it depends on.

    Attributes
    ----------
    nodes : (k,) these, ascending
    points : (k, d) where they are
    step : by how much they are moved for differences, length

    Parameters
    ----------
    output, view : the stress, and the history

    Raises
    ------
    InputError
        If there is no such body or node.
    """

    def __init__(self, output: Stress, view: HistoryView) -> None:
        names, space = [body.name for body in view.model.bodies], view.space
        if output.body not in names:
            raise InputError(one_of(output.body, names, "body"))
        node, self._component = node_of(output.node, view), COMPONENTS.index(output.component)
        self._factors = view.points[view.number(output.load_factor)].load.factors
        around = [(block.cells == node).any(axis=1) for block in space.blocks]
        cells = [block.cells[own] for block, own in zip(space.blocks, around, strict=True)]
        self.nodes = distinct(np.concatenate([part.ravel() for part in cells]))
        self.step = _STEP * float(np.ptp(space.mesh.places_of(self.nodes), axis=0).max())
        if view.model.cyclic_symmetries:  # cells at the other side of a sector have a part in it: no mesh of a few
            self._space, self._model, self._at = space, view.model, np.array([[names.index(output.body), node]])
            within = StressProbe.at_nodes(space, view.model, self._at).within
            self.nodes = self._own = distinct(np.concatenate([group.cells.ravel() for group in within]))
        else:
            self._space, self._model = _part(view, self.nodes, around)
            body = [body.name for body in self._model.bodies].index(output.body)
            self._own = np.arange(len(self.nodes))
            self._at = np.array([[body, int(np.searchsorted(self.nodes, node))]])
        self.points: Array = space.mesh.places_of(self.nodes)

    def under(self, u: Array, points: Array | None = None) -> float:
        """The stress, force per area, at the temperatures of the point of the history.

        Parameters
        ----------
        u : (k, c) displacements of the nodes
        points : (k, d) where they are; None: where the view has them
        """
        space = self._space
        if points is not None:
            places = space.mesh.points.copy()
            places[self._own] = points
            space = space.at(places, space.displacement)
        displacement = np.zeros((space.mesh.number_of_nodes, u.shape[1]))
        displacement[self._own] = u
        deformed = DeformedBodies.of(space, self._model, displacement, self._factors)
        return float(StressProbe.at_nodes(space, self._model, self._at).stress(deformed)[0][0, self._component])

    def weights(self, components: int) -> Array:
        """(k, c) How it changes with displacements of the nodes, c of each."""
        found, still = np.zeros((2, len(self.nodes), components))
        none = self.under(still)
        for at in np.ndindex(found.shape):
            moved = still.copy()
            moved[at] = 1.0
            found[at] = self.under(moved) - none
        return found

    def by_places(self, u: Array) -> Array:
        """(k, d) How it changes with the places of the nodes while they have displacements u (k, c)."""
        found = np.zeros_like(self.points)
        for at in np.ndindex(found.shape):
            step = np.zeros_like(found)
            step[at] = self.step
            found[at] = (self.under(u, self.points + step) - self.under(u, self.points - step)) / (2.0 * self.step)
        return found


def node_of(node: int, view: HistoryView) -> int:
    """The number of a node, if there is such a one.

    Raises
    ------
    InputError
        Otherwise.
    """
    count = view.model.mesh.number_of_nodes
    if not 0 <= node < count:
        raise InputError(f"is {node}; expected a node from 0 to {count - 1}", where=("node",))
    return node


def _part(view: HistoryView, nodes: IntArray, around: list[Array]) -> tuple[Space, Model]:
    """Some cells of a view alone.

    Parameters
    ----------
    view : the bodies
    nodes : of the cells, ascending
    around : of every block which of its cells
    """
    model, blocks = view.model, list(zip(view.space.blocks, around, strict=True))
    owner = np.concatenate([np.flatnonzero(own) + block.first for block, own in blocks])
    numbers, body = np.unique(model.body_of_cells()[owner], return_inverse=True)
    part = PartOfBodies(
        nodes=nodes,
        points=view.space.mesh.places_of(nodes),
        cells={block.family: np.searchsorted(nodes, block.cells[own]) for block, own in blocks if own.any()},
        bodies=[model.bodies[i] for i in numbers],
        body=body,
        kind=model.kind,
        thickness=model.thickness,
    )
    names = [each.name for each in part.bodies]
    heats = [load for load in model.loads if load.temperature is not None and load.on in names]
    alone = part.model(loads=[_at_nodes(load, nodes) for load in heats])
    return make_space(alone.mesh, kind=model.kind), alone


def _at_nodes(load: Load, nodes: IntArray) -> Load:
    """A temperature at some nodes; one that is a function of places is so still."""
    given = load.temperature
    return replace(load, temperature=given[nodes]) if isinstance(given, np.ndarray) else load
