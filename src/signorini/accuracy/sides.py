# SPDX-License-Identifier: BSD-3-Clause
"""What pressures lack along a side in the plane: at their nodes, and between nodes at the ends of a contact."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.boundary import Boundary
from signorini.solution.results import ContactResult


@dataclass(frozen=True, kw_only=True, eq=False)
class SideErrors:
    """Squares of every facet of a side, force squared per area.

    Attributes
    ----------
    corners : (m, 2) of the facets
    areas : (m,) of them
    pressure, friction : (m,) of differences
    scale : (m,) of the pressures themselves
    """

    corners: IntArray
    areas: Array
    pressure: Array
    friction: Array
    scale: Array

    def larger(self, other: SideErrors) -> SideErrors:
        """On every facet the larger differences of these and others."""
        first = self.pressure + self.friction > other.pressure + other.friction
        pressure, friction = (
            np.where(first, one, more)
            for one, more in ((self.pressure, other.pressure), (self.friction, other.friction))
        )
        return replace(self, pressure=pressure, friction=friction)

    def at_least(self, pressure: Array, friction: Array) -> SideErrors:
        """Errors no less than squares on the mean of every facet.

        Parameters
        ----------
        pressure, friction : (m,) squares, force squared per area^2
        """
        least = [
            np.maximum(self.areas * more, own)
            for more, own in zip((pressure, friction), (self.pressure, self.friction), strict=True)
        ]
        return replace(self, pressure=least[0], friction=least[1])

    def at_nodes(self, count: int) -> Array:
        """(count,) Squares of both differences, half of a facet at each of its corners."""
        halves = np.repeat(0.5 * (self.pressure + self.friction), 2)
        return np.asarray(np.bincount(self.corners.ravel(), halves, count), float)


def side_errors(side: Boundary, result: ContactResult, recovered: tuple[Array, Array], *, linear: bool) -> SideErrors:
    """Differences of tractions that vary linearly between nodes, and what the square root at an end adds.

    With differences d and e at the ends of a facet of the area A: ``A (d^2 + d e + e^2) / 3``, where one end touches at
    least: on the others pressures are 0 in truth, too, whatever a corner nearby does to recovered stresses. Of linear
    cells these are off by much the same in all of a contact, while its pressures are in balance with the loads: there
    d and e are those of pairs that touch, without their mean.

    Parameters
    ----------
    side : of the nonmortar body
    result : of the contact
    recovered : pressures (n,) and frictions (n, d) of smoother stresses at its nodes, force per area
    linear : whether the cells are

    Examples
    --------
    What is between nodes alone, of two that touch:

    >>> import signorini as sg
    >>> from signorini.fem.boundary import boundary
    >>> from signorini.fem.space import make_space
    >>> from signorini.gallery import coarse
    >>> model = coarse.cylinder()
    >>> found = sg.solve(model).contact("seat")
    >>> side = boundary(make_space(model.mesh), "arc", ("contact",))
    >>> errors = side_errors(side, found, (found.pressure, found.shear), linear=False)
    >>> round(float(np.sqrt(errors.pressure.sum() / errors.scale.sum())), 2)
    0.11
    """
    chain = _Chain.of(side, result)
    difference = np.column_stack([recovered[0] - result.pressure, recovered[1] - result.shear])
    if linear:
        difference = chain.balanced(difference, result.area)
    first, second = chain.at_ends(difference)
    weights = chain.areas * chain.closed[chain.rows].any(axis=1)
    nodal = weights[:, None] * (first**2 + second**2 + first * second) / 3.0
    ends, at_end = chain.at_contact_ends(result.pressure, result.pressure + difference[:, 0])
    slipping, _ = chain.at_contact_ends(*(2 * [np.linalg.norm(result.shear, axis=1)]))
    one, other = chain.at_ends(result.pressure[:, None])
    scale = chain.areas * (one**2 + other**2 + one * other)[:, 0] / 3.0
    return SideErrors(
        corners=side.blocks[0].corner_nodes,
        areas=chain.areas,
        pressure=np.where(at_end, ends, nodal[:, 0]),
        friction=nodal[:, 1:].sum(axis=1) + slipping,
        scale=scale,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Chain:
    """Facets of a side by the places of their nodes in the rows of a contact.

    Attributes
    ----------
    rows : (m, 2) of the nodes of every facet; the number of rows where a node has no pair
    areas : (m,) of the facets
    closed : (n + 1,) pairs that touch, and no pair
    """

    rows: IntArray
    areas: Array
    closed: BoolArray

    @staticmethod
    def of(side: Boundary, result: ContactResult) -> _Chain:
        """Of a boundary in the plane and the pairs on it."""
        (block,) = side.blocks
        order = np.argsort(result.node)
        place = np.minimum(np.searchsorted(result.node[order], block.corner_nodes), len(order) - 1)
        rows = np.where(result.node[order][place] == block.corner_nodes, order[place], len(order))
        lengths = np.bincount(rows.ravel(), np.repeat(0.5 * block.lengths, 2), len(order) + 1)
        widths = np.append(result.area, 0.0) / np.where(lengths > 0.0, lengths, 1.0)
        return _Chain(
            rows=rows, areas=block.lengths * widths[rows].mean(axis=1), closed=np.append(result.closed, False)
        )

    def at_ends(self, values: Array) -> tuple[Array, Array]:
        """Of nodes (n, c) at both ends of every facet, (m, c) each; 0 where there is no pair."""
        padded = np.vstack([values, np.zeros((1, values.shape[1]))])
        return padded[self.rows[:, 0]], padded[self.rows[:, 1]]

    def balanced(self, values: Array, areas: Array) -> Array:
        """Values (n, c) of pairs that touch less their mean with the areas (n,) of these; 0 of others."""
        own = np.where(self.closed[: len(areas)], areas, 0.0)[:, None]
        total = own.sum()
        return np.where(own > 0.0, values - (own * values).sum(axis=0) / (total if total > 0.0 else 1.0), 0.0)

    def at_contact_ends(self, values: Array, smoother: Array) -> tuple[Array, BoolArray]:
        """(m,) Square of what a root of the distance from the end of the contact is away from chords, and where.

        Squares of smoother values fall linearly over the last two nodes of a contact and go on so, to 0 before the next
        node, where it is open: between two nodes with the values 0 and b, smoother alike, the square of the difference
        is b^2 / 30 on the mean. It holds what values lack at the nodes, too.

        Parameters
        ----------
        values, smoother : (n,)
        """
        values, smoother = (np.append(np.maximum(part, 0.0), 0.0) for part in (values, smoother))
        found, ends = np.zeros(len(self.rows)), np.zeros(len(self.rows), dtype=np.bool_)
        for near, far in ((0, 1), (1, 0)):
            own, beyond = self.rows[:, near], self.rows[:, far]
            outer = np.flatnonzero(self.closed[own] & ~self.closed[beyond])
            inner = self._behind(outer, own[outer])
            behind = np.where(self.rows[inner, 0] == own[outer], *self.rows[inner].T[::-1])
            low, last = smoother[own[outer]], values[own[outer]]
            high = np.where(inner >= 0, smoother[behind], 0.0)
            falls = high > low
            run = np.where(falls, self.areas[inner] / self.areas[outer], 1.0)
            drop = np.where(falls, high**2 - low**2, low**2)
            reach = np.minimum(np.where(drop > 0.0, run * low**2 / np.where(drop > 0.0, drop, 1.0), 1.0), 1.0)
            cross = last * low * (4.0 * reach / 3.0 - 8.0 * reach**2 / 15.0)
            found[outer] += self.areas[outer] * (last**2 / 3.0 - cross + 0.5 * low**2 * reach)
            before = values[behind[falls]]
            np.add.at(
                found,
                inner[falls],
                self.areas[inner[falls]] * _beside_chord(low[falls], high[falls], last[falls], before),
            )
            ends[outer], ends[inner[falls]] = True, True
        return found, ends

    def _behind(self, facets: IntArray, rows: IntArray) -> IntArray:
        """The other facet at a node of each, closed at both ends; -1: none."""
        inside = np.flatnonzero(self.closed[self.rows].all(axis=1))
        found = np.full(len(facets), -1)
        for end in (0, 1):
            order = inside[np.argsort(self.rows[inside, end], kind="stable")]
            if len(order):
                at = np.minimum(np.searchsorted(self.rows[order, end], rows), len(order) - 1)
                found = np.where(self.rows[order[at], end] == rows, order[at], found)
        return found


def _beside_chord(low: Array, high: Array, last: Array, before: Array) -> Array:
    """Mean square of what ``sqrt(a^2 + (b^2 - a^2) s)`` is away from ``c + (d - c) s`` over s from 0 to 1.

    Parameters
    ----------
    low, high : a and b, not both 0
    last, before : c and d
    """
    squares = low**2 + low * high + high**2
    cubes = 2.0 * low**3 + 4.0 * low**2 * high + 6.0 * low * high**2 + 3.0 * high**3
    mean, moment = 2.0 * squares / (3.0 * (low + high)), 2.0 * cubes / (15.0 * (low + high) ** 2)
    chord = (last**2 + last * before + before**2) / 3.0
    return np.asarray(
        np.maximum(chord + 0.5 * (low**2 + high**2) - 2.0 * (last * mean + (before - last) * moment), 0.0)
    )
