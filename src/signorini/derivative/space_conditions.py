# SPDX-License-Identifier: BSD-3-Clause
"""States of pairs in a piece in space, and what must hold in it: on polygons in place of cones, or on cones themselves.

A pair that slips is on an edge of its polygon, whose direction is left to its friction, or in a corner, which leaves
none. On a smooth section friction turns with the slip, to first order with that of the whole piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.conditions import (
    ConditionRow,
    PieceConditions,
    PieceEnd,
    gathered,
    kink_rows,
)
from signorini.derivative.interface_system import InterfaceSystem, PairStates
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK, UNDECIDED

_BACK = 1e-3  # of a piece: how far before its end, where a pair may be in a corner, its edge is looked for
_PRESSES = 1e-12  # of the data: a normal force as good as none, with which a cone still has a direction
_WIDTH = 1e-10  # of the data: of zero for a condition
_STAYS = 1e-9  # of what moves most in a piece: a condition that changes by less has not come to where it is


def states_of_piece(
    law: ContactProblem, codes: IntArray, start: tuple[Array, Array], end: tuple[Array, Array]
) -> PairStates:
    """The states of pairs in a piece.

    Parameters
    ----------
    law : of the pairs
    codes : (n,) in the piece
    start, end : (3, n) motions since the beginning, and forces, at its ends
    """
    (h_0, r_0), (h, r) = start, end
    moved, stick = h[1:] - h_0[1:], codes == STICK
    smooth = (law.section.sides == 0) & ~_line(law)
    back = np.where(smooth, 0.0 if law.pieces.branches == 1 else _BACK * _BACK, _BACK)
    y = r + back * (r_0 - r)
    y[0] = np.where(codes == OPEN, -1.0, np.maximum(y[0], _PRESSES * (law.scale or 1.0)))
    size = np.linalg.norm(moved, axis=0)
    far = np.divide(np.abs(r).max(initial=0.0), size, out=np.ones_like(size), where=~smooth & (size > 0.0))
    y[1:] -= np.where(codes > STICK, far * moved, 0.0)
    found, size = law.law.tangent(y), law.bound.at(np.maximum(r[0], 0.0))
    free = np.where(stick, 0.0, 1.0)
    tangent = replace(
        found,
        closed=codes != OPEN,
        left=np.where(stick, 2, found.left),
        share=free * found.share,
        fixed=free * found.fixed,
        tau=free * found.tau,
        kappa=free * found.kappa,
    )
    slips = (codes > STICK) & (size > 0.0)
    return PairStates(
        held=np.broadcast_to(stick, moved.shape),
        unit=np.divide(r[1:], size, out=np.zeros_like(moved), where=slips),
        branch=law.pieces.branch(y[0]),
        tangent=tangent,
    )


def states_between(
    system: InterfaceSystem, codes: IntArray, start: tuple[Array, Array], end: tuple[Array, Array]
) -> PairStates:
    """The states of pairs in a piece, in the plane by their codes alone.

    Parameters
    ----------
    system : of the pairs
    codes, start, end : as of `states_of_piece`
    """
    return system.states_of_codes(codes) if system.directions == 2 else states_of_piece(system.law, codes, start, end)


def space_conditions(end: PieceEnd) -> PieceConditions:
    """Gaps of open pairs, pressures of closed ones, friction to spare, corners ahead of those on edges, and kinks."""
    tangent = end.states.tangent
    assert tangent is not None
    n = len(tangent.left)
    zero, one, none = np.zeros(n), np.ones(n), np.zeros((2, n))
    rows: list[ConditionRow] = [
        (~tangent.closed, one, zero, none, 0, zero, zero, zero, end.h[0]),
        (tangent.closed, zero, one, none, 0, zero, zero, zero, end.r[0]),
        *_sides_of_sections(end),
        *kink_rows(end, tangent.closed & (tangent.left < 2)),
    ]
    return gathered(rows, end)


def acting_pairs(known: PieceConditions, start: tuple[Array, Array], end: PieceEnd) -> IntArray:
    """Pairs with a condition that comes to zero at the end of a piece.

    Parameters
    ----------
    known : at the end
    start : (3, n) motions and forces at the beginning
    end : the end
    """
    moved = start[0] - end.h, start[1] - end.r
    before = known.change(*moved)  # by how much it was larger; a pair that stays at its limit comes to nothing
    least = np.maximum(2.0 * np.abs(known.value), _STAYS * max(np.abs(part).max(initial=0.0) for part in moved))
    comes = (np.abs(known.value) <= _WIDTH * (end.law.scale or 1.0)) & (before > least)
    return np.unique(known.pair[comes])


def _line(law: ContactProblem) -> BoolArray:
    """(n,) Pairs with friction along one tangent alone."""
    return np.asarray((law.section.axes <= 0.0).any(axis=0), dtype=np.bool_)


def _sides_of_sections(end: PieceEnd) -> Iterator[ConditionRow]:
    """Friction to spare to every side of a section, and to both corners of an edge that a pair slips on."""
    law, tangent, p, q = end.law, end.states.tangent, end.r[0], end.r[1:]
    assert tangent is not None
    section, bound, line = law.section, law.pieces, _line(law)
    zero = np.zeros(len(p))
    rubs = tangent.closed & (law.law.closed == UNDECIDED) & ~law.unbounded
    sticks = rubs & ((tangent.left == 2) | (line & (tangent.left == 1)))
    on_edge = rubs & (tangent.left == 1) & (section.sides > 0) & ~line
    normals, reach = section.facets(q)
    over = np.divide(1.0, section.axes, out=np.zeros_like(q), where=section.axes > 0.0)
    along = tangent.tau * over
    length = np.linalg.norm(along, axis=0)
    corner = over * np.divide(along, length, out=np.zeros_like(q), where=length > 0.0)
    half = np.sin(np.pi / np.maximum(section.sides, 1))
    kinds = [(sticks, normal, far) for normal, far in zip(normals, reach, strict=True)]
    kinds += [(on_edge, sign * corner, half) for sign in (1.0, -1.0)]
    for j in range(bound.branches):
        spare = bound.starts[j] + bound.slopes[j] * p
        for which, normal, far in kinds:
            has = which & np.isfinite(far) & np.isfinite(bound.kinks[j])
            there = np.where(has, far, 0.0)
            value = there * spare - (normal * q).sum(axis=0)
            yield has, zero, there * bound.slopes[j], -normal, j, there, there * p, zero, value


def space_slips(states: PairStates, law: ContactProblem) -> tuple[IntArray, Array]:
    """Pairs that slip in space, (m,), and w (2, m): numbers ``w . slip`` that friction keeps positive.

    Across its edge of a polygon, in a corner along both edges that meet there, against its friction on a cone.
    """
    tangent, section, line = states.tangent, law.section, _line(law)
    assert tangent is not None
    rubs = tangent.closed & (law.law.closed == UNDECIDED) & states.unit.any(axis=0) & ~line
    edge = np.flatnonzero(rubs & (section.sides > 0) & (tangent.left == 1))
    cone = np.flatnonzero(rubs & (section.sides == 0) & (tangent.left == 1))
    corner = np.flatnonzero(rubs & (section.sides > 0) & (tangent.left == 0))
    tau, unit = tangent.tau[:, edge], states.unit[:, cone]
    rows = [(edge, np.stack([-tau[1], tau[0]])), (cone, -unit / np.linalg.norm(unit, axis=0))]
    axes, between = section.axes[:, corner], 2.0 * np.pi / np.maximum(section.sides[corner], 1)
    scaled = states.unit[:, corner] / axes
    angle = between * np.round(np.arctan2(scaled[1], scaled[0]) / between)
    before, after = (
        np.stack([np.cos(angle + part * between), np.sin(angle + part * between)]) / axes for part in (-0.5, 0.5)
    )
    rows += [(corner, np.stack([-after[1], after[0]])), (corner, np.stack([before[1], -before[0]]))]
    return np.concatenate([pairs for pairs, _ in rows]), np.concatenate([weights for _, weights in rows], axis=1)
