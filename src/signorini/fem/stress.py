# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at the nodes, averaged inside a body and never across bodies."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.cores import number_of_threads
from signorini.crew import Crew, Job
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.elasticity import elasticities, elasticity
from signorini.fem.kinematics import Group, Kinematics, groups, kinematics, large, mean_in_cells, of_each
from signorini.fem.links import linked_nodes
from signorini.fem.space import Space, make_space
from signorini.fem.thermal import temperatures, thermal_strain
from signorini.fem.turning_bodies import in_frames
from signorini.model.model import Model
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class BodyStress(Short):
    """Nodal stresses of one body.

    Attributes
    ----------
    body : its name
    nodes : (k,) sorted nodes of the mesh
    stress : (k, 6) force per area: xx, yy, zz, xy, yz, xz, tension positive; of axisymmetric bodies radial, axial, hoop
        and their shear
    """

    body: str
    nodes: IntArray
    stress: Array

    @property
    def von_mises(self) -> Array:
        """``sqrt(3/2 s:s)``, s the deviator, (k,)."""
        return von_mises(self.stress)


def von_mises(stress: Array) -> Array:
    """Von Mises equivalent of stresses (..., 6).

    >>> von_mises(np.array([2.0, 0, 0, 0, 0, 0])).item()
    2.0
    """
    x, y, z, xy, yz, xz = np.moveaxis(stress, -1, 0)
    square = 0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3.0 * (xy**2 + yz**2 + xz**2)
    result: Array = np.sqrt(square)
    return result


@dataclass(frozen=True, kw_only=True, eq=False)
class DeformedBodies:
    """Bodies with their displacements, temperatures and plastic strains.

    Attributes
    ----------
    space, model : of the bodies
    displacement : (n, d) along axes that turn with the bodies, length
    turns : (n, d, d) of these axes at every node; None where none turns
    temperature : at every node; None without
    plastic : plastic strains at the quadrature points, of every family (m, q, 4 or 6)
    """

    space: Space
    model: Model
    displacement: Array
    turns: Array | None
    temperature: Array | None
    plastic: Mapping[str, Array]

    @staticmethod
    def of(
        space: Space,
        model: Model,
        displacement: Array,
        factors: Mapping[str, float] | None = None,
        plastic: Mapping[str, Array] | None = None,
    ) -> DeformedBodies:
        """The bodies at load factors.

        Parameters
        ----------
        space, model, displacement, factors, plastic : as of :func:`body_stresses`
        """
        own, turns = in_frames(space, model, displacement) if model.slides else (displacement, None)
        return DeformedBodies(
            space=space,
            model=model,
            displacement=own,
            turns=turns,
            temperature=temperatures(space, model, factors or {}) if model.heats else None,
            plastic=plastic or {},
        )

    def stress(self, group: Group) -> Array:
        """Stresses xx, yy, zz, xy (yz, xz) at the best points of the cells of a group, (m, p, 4 or 6)."""
        space, model, D = self.space, self.model, elasticities(self.model)[group.body]
        points = kinematics(space, model, group, best=True)
        strain = self._elastic_strain(group, points)
        if group.formulation == "mean dilatation":
            every = kinematics(space, model, group)
            dilatation = self._elastic_strain(group, every)[..., :3].sum(axis=-1)
            mean = mean_in_cells(every.weights, group.block.pressures, dilatation, group.block.stress_pressures)
            strain[..., :3] += ((mean - strain[..., :3].sum(axis=-1)) / 3.0)[..., None]
        flowed = at_best_points(group, self.plastic)
        stress = (strain if flowed is None else strain - flowed) @ D.swapaxes(1, 2)
        return points.relaxed(D, stress)

    def strain(self, group: Group, stress: Array) -> Array:
        """Strains of a group that belong to its stresses at the best points of its cells, both (m, p, 4 or 6)."""
        strain = stress @ self._compliances[group.body].swapaxes(1, 2)
        if self.temperature is not None:
            points = kinematics(self.space, self.model, group, best=True)
            strain += thermal_strain(self.model, group, points, self.temperature)
        flowed = at_best_points(group, self.plastic)
        if flowed is not None:
            strain += flowed
        strain[..., 3:] *= 0.5
        return strain

    @cached_property
    def _compliances(self) -> Array:
        """Strains of unit stresses of every body, in plane stress with the strain across."""
        kind = "3d" if self.model.components == 3 else "plane strain"
        return np.linalg.inv(np.array([elasticity(body.material, kind) for body in self.model.bodies]))

    def _elastic_strain(self, group: Group, points: Kinematics) -> Array:
        """Strains of the displacements less the thermal ones, at points of a group, (m, q, 4 or 6)."""
        strain = points.strain(self.displacement[group.cells])
        if self.temperature is not None:
            strain = strain - thermal_strain(self.model, group, points, self.temperature)
        return strain

    def in_space(self, found: Array, nodes: IntArray) -> Array:
        """Tensors (..., 6) along the axes of space.

        Parameters
        ----------
        found : (..., 4 or 6) along those of the bodies
        nodes : (...) with whose axes they turn
        """
        tensors = np.zeros((*found.shape[:-1], 6))
        tensors[..., : found.shape[-1]] = found
        return tensors if self.turns is None else turned(tensors, self.turns[nodes])


def space_of(model: Model) -> Space:
    """The displacement space of the bodies of a model, without its obstacles; nodes of no cell may be named."""
    return make_space(model.mesh, kind=model.kind, linked=linked_nodes(model) if model.couples else None)


def principal_stresses(stress: Array) -> Array:
    """The three principal stresses (n, 3) of stresses (n, 6), the largest first.

    >>> principal_stresses(np.array([[1.0, 1.0, -3.0, 2.0, 0.0, 0.0]])).tolist()
    [[3.0, -1.0, -3.0]]
    """
    if not stress[:, 4:].any():  # one of them is that across the plane
        half, mean = 0.5 * (stress[:, 0] - stress[:, 1]), 0.5 * (stress[:, 0] + stress[:, 1])
        radius = np.hypot(half, stress[:, 3])
        found = np.column_stack([mean + radius, mean - radius, stress[:, 2]])
        return np.asarray(-np.sort(-found, axis=1))
    return np.asarray(np.linalg.eigvalsh(stress[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]])[:, ::-1])


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyTensors:
    """Stresses and strains of all bodies, at their nodes and in their cells.

    Attributes
    ----------
    stresses : of every body at its nodes
    strains : of every body (k, 6) at the same nodes: tensors, shear strains are half of those that engineers count
    in_cells : (cells, 12) stresses and strains side by side, means of the points of a cell where stresses are best
    """

    stresses: list[BodyStress]
    strains: list[Array]
    in_cells: Array


def body_tensors(deformed: DeformedBodies) -> BodyTensors:
    """Stresses as of `body_stresses`, with the strains that belong to them, see `point_strains`; both in cells, too."""
    space, model = deformed.space, deformed.model
    every = list(groups(space, model))
    width, in_cells = elasticities(model).shape[1], np.zeros((model.mesh.number_of_cells, 12))

    def at_best(group: Group) -> tuple[Array, Array]:
        stress = deformed.stress(group)
        both = stress, deformed.strain(group, stress)
        for first, values in zip((0, 6), both, strict=True):
            in_cells[group.numbers, first : first + 6] = deformed.in_space(values.mean(axis=1), group.cells[:, 0])
        return both

    found = dict(zip(map(id, every), of_each(every, at_best), strict=True))
    at_nodes = [
        nodal_averages(space, model, lambda group, which=which: found[id(group)][which], width, every)  # type: ignore[misc]
        for which in (0, 1)
    ]
    return BodyTensors(
        stresses=[
            BodyStress(body=body.name, nodes=nodes, stress=deformed.in_space(found, nodes))
            for body, (nodes, found) in zip(model.bodies, at_nodes[0], strict=True)
        ],
        strains=[deformed.in_space(found, nodes) for nodes, found in at_nodes[1]],
        in_cells=in_cells,
    )


def body_stresses(
    space: Space,
    model: Model,
    displacement: Array,
    factors: Mapping[str, float] | None = None,
    plastic: Mapping[str, Array] | None = None,
) -> list[BodyStress]:
    """Stresses of every body: from the best points of a cell to its nodes, then averaged with the cells' areas.

    Parameters
    ----------
    space : of the model
    displacement : (n, d) in space, length; stresses of bodies that have turned are along its axes, too
    factors : load factors by name, for the temperatures; a model without any needs none
    plastic : plastic strains at the quadrature points, of every family (m, q, 4 or 6); none where nothing has flowed
    """
    deformed = DeformedBodies.of(space, model, displacement, factors, plastic)
    averages = nodal_averages(space, model, deformed.stress, elasticities(model).shape[1])
    return [
        BodyStress(body=body.name, nodes=nodes, stress=deformed.in_space(found, nodes))
        for body, (nodes, found) in zip(model.bodies, averages, strict=True)
    ]


def nodal_averages(
    space: Space,
    model: Model,
    at_best: Callable[[Group], Array],
    components: int,
    within: Sequence[Group] | None = None,
    *,
    scalars: int = 0,
) -> list[tuple[IntArray, Array]]:
    """Sorted nodes (k,) of every body and values there (k, components), averaged with the areas of the cells.

    Those of the sectors beside it are among the cells of a sector.

    Parameters
    ----------
    space, model : of the bodies
    at_best : values (m, p, components) of a group at the best points of its cells
    components : of a value
    within : the cells that are looked at; all if not given
    scalars : components that come before tensors
    """
    count = len(space.mesh.points)
    total, weight = np.zeros((len(model.bodies), count, components)), np.zeros((len(model.bodies), count))
    every = list(groups(space, model)) if within is None else within
    found: dict[int, tuple[Array, Array]] = {}

    def find(i: int) -> None:
        group = every[i]
        area = space.volumes_of(group.block)[group.index].sum(axis=1)[:, None]
        found[i] = area, (group.block.to_nodes @ at_best(group)) * area[..., None]

    def add(i: int) -> None:
        group, (area, at_nodes) = every[i], found.pop(i)
        places = group.body[:, None] * count + group.cells
        _add_at(weight.reshape(-1, 1), places, np.broadcast_to(area, places.shape)[..., None])
        _add_at(total.reshape(-1, components), places, at_nodes)

    _ = space.volumes  # once, before several ask for them
    with Crew(number_of_threads() if large(every) else 1) as crew:
        # one group after the other is added, so that sums are the same whoever finds them
        crew.finish(
            [
                job
                for i in range(len(every))
                for job in (Job(partial(find, i)), Job(partial(add, i), (2 * i, 2 * i - 1) if i else (0,)))
            ]
        )
    if model.cyclic_symmetries:
        _add_sectors_beside(space, model, (total, weight), scalars)
    nodes = [np.nonzero(own)[0] for own in weight]
    return [(own, total[i, own] / weight[i, own, None]) for i, own in enumerate(nodes)]


def _add_at(sums: Array, places: IntArray, values: Array) -> None:
    """Add values (m, k, c) at places (m, k) to sums (n, c): `bincount` takes a tenth of the time of ``np.add.at``."""
    first = int(places.min())
    flat = places.ravel() - first
    for c in range(sums.shape[1]):
        found = np.bincount(flat, weights=values[..., c].ravel())
        sums[first : first + len(found), c] += found


def _add_sectors_beside(space: Space, model: Model, sums: tuple[Array, Array], scalars: int) -> None:
    """Add what the cells of the sectors on both sides have at nodes that they share with this one.

    Parameters
    ----------
    space, model : of the bodies
    sums : (bodies, n, components) of values and (bodies, n) of their weights, which change
    scalars : components that come before tensors
    """
    for j, symmetry in enumerate(model.cyclic_symmetries):
        turn, first, second = cyclic_sides(space, model, j)
        for total, weight in zip(*sums, strict=True):
            both = (weight[first] > 0.0) & (weight[second] > 0.0)
            on_axis = first[both & (first == second)]
            one, other = first[both & (first != second)], second[both & (first != second)]
            whole = total[other] + _turned(total[one], turn, scalars)
            total[one], total[other] = _turned(whole, turn.T, scalars), whole
            weight[one] = weight[other] = weight[one] + weight[other]
            mean = now = total[on_axis]
            for _ in range(symmetry.sectors - 1):
                now = _turned(now, turn, scalars)
                mean = mean + now
            total[on_axis] = mean / symmetry.sectors


def _turned(values: Array, turn: Array, scalars: int) -> Array:
    """Rows of scalars, and of tensors of six components, or of the four of a plane, behind them, in other axes."""
    width = values.shape[1] - scalars
    count = max(1, width // 6)
    tensors = np.zeros((len(values), 6 * count))
    tensors[:, :width] = values[:, scalars:]
    found = turned(tensors.reshape(len(values), count, 6), turn).reshape(tensors.shape)
    return np.concatenate([values[:, :scalars], found[:, :width]], axis=1)


def point_stresses(deformed: DeformedBodies) -> Iterator[tuple[IntArray, Array]]:
    """Stresses at the best points of the cells, group by group: cells (m,) and (m, p, 6) as nodes have them."""
    for group in groups(deformed.space, deformed.model):
        yield group.numbers, deformed.in_space(deformed.stress(group), group.cells[:, :1])


def point_strains(deformed: DeformedBodies) -> Iterator[tuple[IntArray, Array]]:
    """Strains at the points of `point_stresses`: elastic, thermal and plastic ones together, as tensors.

    Notes
    -----
    They belong to the stresses: with the mean dilatation or the internal modes of the cells, and in plane stress with
    the strain across.
    """
    for group in groups(deformed.space, deformed.model):
        strain = deformed.strain(group, deformed.stress(group))
        yield group.numbers, deformed.in_space(strain, group.cells[:, :1])


def turned(tensors: Array, turns: Array) -> Array:
    """Symmetric tensors (..., 6) in other axes: ``R s R^T``.

    Parameters
    ----------
    tensors : xx, yy, zz, xy, yz, xz
    turns : (..., d, d) rotations R

    Examples
    --------
    >>> turned(np.array([1.0, 0, 0, 0, 0, 0]), np.array([[0.0, -1.0], [1.0, 0.0]])).tolist()
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]
    """
    d = turns.shape[-1]
    whole = np.zeros((*turns.shape[:-2], 3, 3))
    whole[...] = np.eye(3)
    whole[..., :d, :d] = turns
    full = tensors[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    found = whole @ full @ whole.swapaxes(-1, -2)
    return np.asarray(found[..., [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]] + 0.0)


def at_best_points(group: Group, values: Mapping[str, Array]) -> Array | None:
    """Values of cells at their quadrature points fitted at the best ones, (m, p, ...); None of families without.

    Parameters
    ----------
    group : the cells
    values : of all cells of a family, (cells, q, ...)
    """
    own = values.get(group.block.family)
    return None if own is None else np.einsum("pq,mq...->mp...", group.block.to_best, own[group.index])
