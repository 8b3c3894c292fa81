# SPDX-License-Identifier: BSD-3-Clause
"""What the points of bodies that yield remember, as values in cells and at nodes: for files and pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.kinematics import Group, groups
from signorini.fem.space import Space
from signorini.fem.stress import at_best_points, nodal_averages
from signorini.model.model import Model
from signorini.plasticity.groups import yielding_groups
from signorini.plasticity.state import PlasticState
from signorini.short import Short

_WIDTH = 1 + 6 + 6  # of an equivalent plastic strain, a plastic strain and a back stress side by side


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PlasticFields(Short):
    """Plastic strains and back stresses at n points; tensors xx, yy, zz, xy, yz, xz as those of stresses.

    Attributes
    ----------
    equivalent : (n,) equivalent plastic strain, >= 0
    strain : (n, 6) plastic strain, the tensor: shear strains are half of those that engineers count
    back : (n, 6) sum of the back stresses, force per area
    """

    equivalent: Array
    strain: Array
    back: Array

    def part(self, own: IntArray | BoolArray) -> PlasticFields:
        """The fields at some of the points."""
        return PlasticFields(equivalent=self.equivalent[own], strain=self.strain[own], back=self.back[own])

    @staticmethod
    def of(rows: Array) -> PlasticFields:
        """From rows (n, 13) of all three side by side; what a fit makes of 0 may be below it and is cut."""
        return PlasticFields(equivalent=np.maximum(rows[:, 0], 0.0), strain=rows[:, 1:7], back=rows[:, 7:])


def joined(parts: Sequence[PlasticFields]) -> PlasticFields:
    """The fields of several parts, one after the other."""
    return PlasticFields(
        equivalent=np.concatenate([part.equivalent for part in parts]),
        strain=np.concatenate([part.strain for part in parts]),
        back=np.concatenate([part.back for part in parts]),
    )


def by_family(space: Space, model: Model, values: Array) -> dict[str, Array]:
    """Values at the quadrature points of every family that yields, (cells, q, ...), 0 in cells that do not.

    Parameters
    ----------
    space, model : of the bodies
    values : (p, ...) of the points in the order of :class:`signorini.plasticity.bodies.YieldingBodies`
    """
    found: dict[str, Array] = {}
    first = 0
    for group in yielding_groups(space, model):
        block = group.block
        shape = len(group.index), len(block.values)
        own = values[first : first + shape[0] * shape[1]]
        first += len(own)
        if block.family not in found:
            found[block.family] = np.zeros((len(block.cells), shape[1], *values.shape[1:]))
        found[block.family][group.index] = own.reshape(*shape, *values.shape[1:])
    return found


def nodal_fields(space: Space, model: Model, state: PlasticState) -> list[PlasticFields]:
    """The fields of every body at its nodes, averaged in the body as its stresses are and in the order of theirs.

    Parameters
    ----------
    space, model : of the bodies
    state : of their points
    """
    values = by_family(space, model, _side_by_side(state))

    def at_best(group: Group) -> Array:
        return _at_best(group, values)

    return [PlasticFields.of(rows) for _, rows in nodal_averages(space, model, at_best, _WIDTH, scalars=1)]


def point_fields(space: Space, model: Model, state: PlasticState) -> Iterator[tuple[IntArray, PlasticFields]]:
    """Numbers (m,) of all cells, group by group, and the fields at the p points where stresses are best, cell by cell.

    Parameters
    ----------
    space, model : of the bodies
    state : of their points
    """
    values = by_family(space, model, _side_by_side(state))
    for group in groups(space, model):
        yield group.numbers, PlasticFields.of(_at_best(group, values).reshape(-1, _WIDTH))


def mean_fields(space: Space, model: Model, state: PlasticState) -> dict[str, PlasticFields]:
    """The fields of all cells of every family as means by the volumes of their points.

    Parameters
    ----------
    space, model : of the bodies
    state : of their points
    """
    values = by_family(space, model, _side_by_side(state))
    found = {}
    for block, volumes in zip(space.blocks, space.volumes, strict=True):
        rows = values.get(block.family, np.zeros((len(block.cells), 1, _WIDTH)))
        weight = volumes[:, : rows.shape[1]]
        mean = np.einsum("mq,mqc->mc", weight, rows) / weight.sum(axis=1)[:, None]
        found[block.family] = PlasticFields.of(mean)
    return found


def _at_best(group: Group, values: Mapping[str, Array]) -> Array:
    """(m, p, 13) Rows of a group where stresses are best; 0 where nothing yields."""
    found = at_best_points(group, values)
    return np.zeros((len(group.index), group.block.to_best.shape[0], _WIDTH)) if found is None else found


def _side_by_side(state: PlasticState) -> Array:
    """(p, 13) Equivalent plastic strain, plastic strain and sum of the back stresses of every point, as tensors."""
    components = state.strain.shape[1]
    rows = np.zeros((len(state.equivalent), _WIDTH))
    rows[:, 0] = state.equivalent
    rows[:, 1 : 1 + components] = state.strain
    rows[:, 4:7] *= 0.5
    rows[:, 7 : 7 + components] = state.back.sum(axis=1)
    return rows
