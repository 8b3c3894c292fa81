# SPDX-License-Identifier: BSD-3-Clause
"""Displacements and stresses of the bodies, as files and pictures show them: computed once for all of them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, places_among
from signorini.fem.space import Space
from signorini.fem.stress import (
    BodyStress,
    DeformedBodies,
    body_stresses,
    body_tensors,
    point_strains,
    point_stresses,
    principal_stresses,
    space_of,
    von_mises,
)
from signorini.model.model import Model
from signorini.plasticity.fields import PlasticFields, by_family, joined, mean_fields, nodal_fields, point_fields
from signorini.solution.results import Instant, StepResult

State = StepResult | Instant


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyFields:
    """Fields of all bodies in one state; every body has points of its own, so that no stress is averaged across bodies.

    Attributes
    ----------
    points, displacement : (n, d) undeformed coordinates, of a mesh that has moved with what is worn, and displacement,
        length
    stress : (n, 6) force per area: xx, yy, zz, xy, yz, xz, tension positive
    node : (n,) number in the mesh or deck
    families : of every block of cells
    cells : of every block (m, k), points in the order of meshio
    body : of every block (m,), which body its cells belong to
    plastic : at the points; None where no body yields
    in_cells : of every block, the means over its cells; empty where no body yields
    depth : (n,) worn, at the corners of sides that wear, otherwise 0; None where none does
    strain : (n, 6) as tensors, components as those of the stress; None unless asked for
    tensors_in_cells : of every block (m, 12), means of stress and strain over its cells; empty unless asked for
    reaction, contact_force : (n, d) forces of supports, and of contacts, on the bodies; None where they are not known
    further : (n,) other values by name
    """

    points: Array
    displacement: Array
    stress: Array
    node: IntArray
    families: tuple[str, ...]
    cells: tuple[IntArray, ...]
    body: tuple[IntArray, ...]
    plastic: PlasticFields | None = None
    in_cells: tuple[PlasticFields, ...] = ()
    depth: Array | None = None
    strain: Array | None = None
    tensors_in_cells: tuple[Array, ...] = ()
    reaction: Array | None = None
    contact_force: Array | None = None
    further: Mapping[str, Array] = field(default_factory=dict)

    @cached_property
    def von_mises(self) -> Array:
        """Von Mises equivalent of the stress, (n,) force per area."""
        return von_mises(self.stress)

    @cached_property
    def principal_stress(self) -> Array:
        """Principal values of the stress, the largest first, (n, 3) force per area."""
        return principal_stresses(self.stress)

    def among(self, kept: Sequence[BoolArray]) -> BodyFields:
        """The fields of some of the cells, with the points of these.

        Parameters
        ----------
        kept : of every block (m,) whether a cell stays
        """
        blocks = [k for k, own in enumerate(kept) if own.any()]
        cells = [self.cells[k][kept[k]] for k in blocks]
        points = np.unique(np.concatenate([block.ravel() for block in cells]))

        def at_points(values: Array | None) -> Array | None:
            return None if values is None else values[points]

        return BodyFields(
            points=self.points[points],
            displacement=self.displacement[points],
            stress=self.stress[points],
            node=self.node[points],
            families=tuple(self.families[k] for k in blocks),
            cells=tuple(np.searchsorted(points, block) for block in cells),
            body=tuple(self.body[k][kept[k]] for k in blocks),
            plastic=None if self.plastic is None else self.plastic.part(points),
            in_cells=tuple(self.in_cells[k].part(kept[k]) for k in blocks) if self.in_cells else (),
            depth=at_points(self.depth),
            strain=at_points(self.strain),
            tensors_in_cells=tuple(self.tensors_in_cells[k][kept[k]] for k in blocks) if self.tensors_in_cells else (),
            reaction=at_points(self.reaction),
            contact_force=at_points(self.contact_force),
            further={name: values[points] for name, values in self.further.items()},
        )


class Fields:
    """The fields of a model's bodies in any state: one space for all, and the stresses that several files need once.

    Parameters
    ----------
    model : whose states are asked for
    shared : ends of steps that several files hold: their stresses are kept, of other states those of the last one
    """

    def __init__(self, model: Model, shared: Collection[StepResult] = ()) -> None:
        self.model = model
        self._shared: frozenset[State] = frozenset(shared)
        self._kept: dict[State, list[BodyStress]] = {}
        self._points: tuple[State, dict[str, list[tuple[IntArray, Array]]]] | None = None
        self._flow: tuple[State, list[PlasticFields]] | None = None
        self._moved: tuple[Array, Model, Space] | None = None

    @cached_property
    def space(self) -> Space:
        """The displacement space of the model's mesh."""
        return space_of(self.model)

    def on(self, state: State) -> tuple[Space, Model]:
        """The space and the model on the mesh of a state, which may have moved with what is worn; the last is kept."""
        if state.places is None:
            return self.space, self.model
        if self._moved is None or self._moved[0] is not state.places:
            model = replace(self.model, mesh=replace(self.model.mesh, points=state.places))
            self._moved = state.places, model, space_of(model)
        return self._moved[2], self._moved[1]

    def stresses(self, state: State) -> list[BodyStress]:
        """Stresses of every body at its nodes."""
        if state not in self._kept:
            assert state.displacement is not None
            plastic = self.plastic_strains(state)
            self._keep(state, body_stresses(*self.on(state), state.displacement, state.factors, plastic))
        return self._kept[state]

    def _keep(self, state: State, found: list[BodyStress]) -> None:
        """Keep the stresses of a state, and of others those that several files share."""
        self._kept = {end: stresses for end, stresses in self._kept.items() if end in self._shared} | {state: found}

    def at_nodes(self, state: State, what: str, nodes: IntArray) -> Array:
        """Values at some nodes, see :class:`signorini.output.by_rows.FieldsByRows`; zeros at nodes of no cell.

        Parameters
        ----------
        state, what, nodes : as there
        """
        parts = [(part.nodes, part.stress) for part in self.stresses(state)]
        if what == "PEEQ":
            flowed = [own.equivalent[:, None] for own in self.plastic(state)]
            parts = [(own, values) for (own, _), values in zip(parts, flowed, strict=True)]
        total, count = np.zeros((len(nodes), parts[0][1].shape[1])), np.zeros((len(nodes), 1))
        for own, values in parts:
            here, place = places_among(nodes, own)
            total[here] += values[place]
            count[here] += 1.0
        return np.asarray(total / np.maximum(count, 1.0))

    def in_cells(self, state: State, what: str, cells: IntArray) -> Array:
        """Values in some cells, see :class:`signorini.output.by_rows.FieldsByRows`; those of one state are kept.

        Parameters
        ----------
        state, what, cells : as there
        """
        if self._points is None or self._points[0] is not state:
            self._points = state, {}
        if what not in self._points[1]:
            self._points[1][what] = list(self._in_all_cells(state, what))
        lowest, highest = cells.min(), cells.max()
        groups = [each for each in self._points[1][what] if each[0][0] <= highest and each[0][-1] >= lowest]
        found = [(values, *places_among(cells, numbers)) for numbers, values in groups]
        found = [(values, here, place) for values, here, place in found if len(place)]
        result = np.zeros((len(cells), *found[0][0].shape[1:]))
        for values, here, place in found:
            result[here] = values[place]
        return result

    def _in_all_cells(self, state: State, what: str) -> Iterator[tuple[IntArray, Array]]:
        """Numbers (m,) of all cells, group by group, and values (m, p, c) there."""
        if what in ("S", "E"):
            yield from (point_stresses if what == "S" else point_strains)(self._deformed(state))
        elif state.plastic is not None:
            for cells, flow in point_fields(self.space, self.model, state.plastic.state):
                values = flow.equivalent[:, None] if what == "PEEQ" else flow.strain
                yield cells, values.reshape(len(cells), -1, values.shape[1])

    def _deformed(self, state: State) -> DeformedBodies:
        """The bodies in a state whose displacement is known."""
        assert state.displacement is not None
        return DeformedBodies.of(*self.on(state), state.displacement, state.factors, self.plastic_strains(state))

    def plastic_strains(self, state: State) -> dict[str, Array]:
        """Plastic strains at the quadrature points of every family, where bodies yield."""
        return {} if state.plastic is None else by_family(self.space, self.model, state.plastic.state.strain)

    def plastic(self, state: State) -> list[PlasticFields]:
        """Plastic fields of every body at its nodes, none where none yields; those of one state are kept."""
        if state.plastic is None:
            return []
        if self._flow is None or self._flow[0] is not state:
            self._flow = state, nodal_fields(self.space, self.model, state.plastic.state)
        return self._flow[1]

    def at(self, state: State, *, strained: bool = False) -> BodyFields:
        """All bodies in a state whose displacement is known, one after the other in the order of the model.

        Parameters
        ----------
        state : of the bodies
        strained : whether strains, and stresses in cells, are asked for
        """
        assert state.displacement is not None
        tensors = body_tensors(self._deformed(state)) if strained else None
        if tensors is not None:
            self._keep(state, tensors.stresses)
        stresses, plastic, mesh = self.stresses(state), self.plastic(state), self.on(state)[1].mesh
        nodes = np.concatenate([part.nodes for part in stresses])
        owners = mesh.by_family(self.model.body_of_cells())
        families, cells, body, in_cells, numbers = [], [], [], [], []
        first = np.cumsum([0, *(len(block) for block in mesh.cells.values())])
        means = {} if state.plastic is None else mean_fields(self.space, self.model, state.plastic.state)
        start = 0
        for i, part in enumerate(stresses):
            for k, ((family, block), owner) in enumerate(zip(mesh.cells.items(), owners, strict=True)):
                own = block[owner == i]
                if len(own):
                    families.append(family)
                    cells.append(start + np.searchsorted(part.nodes, own))
                    body.append(np.full(len(own), i))
                    numbers.append(first[k] + np.flatnonzero(owner == i))
                    in_cells += [means[family].part(owner == i)] if means else []
            start += len(part.nodes)
        acting = None if state.nodal_forces is None else state.nodal_forces.at_all(len(mesh.points))
        return BodyFields(
            points=mesh.points[nodes],
            displacement=state.displacement[nodes],
            stress=np.concatenate([part.stress for part in stresses]),
            node=mesh.labels[nodes],
            families=tuple(families),
            cells=tuple(cells),
            body=tuple(body),
            plastic=joined(plastic) if plastic else None,
            in_cells=tuple(in_cells),
            depth=_worn_depth(state, nodes, len(mesh.points)),
            strain=None if tensors is None else np.concatenate(tensors.strains),
            tensors_in_cells=() if tensors is None else tuple(tensors.in_cells[own] for own in numbers),
            reaction=None if acting is None else acting[0][nodes],
            contact_force=None if acting is None else acting[1][nodes],
        )


def _worn_depth(state: State, nodes: IntArray, count: int) -> Array | None:
    """Worn depth at some of the nodes of a mesh, where contacts that share one the larger; None where none wears."""
    worn = [contact.wear for contact in state.contacts if contact.wear is not None]
    if not worn:
        return None
    depth = np.zeros(count)
    for wear in worn:
        np.maximum.at(depth, wear.node, wear.depths)
    return depth[nodes]
