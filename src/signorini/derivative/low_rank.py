# SPDX-License-Identifier: BSD-3-Clause
"""Displacements of a history, and adjoint ones, in as few columns as all its points are combinations of.

Displacements are linear in what the condensed interface knows of a point: as many states are substituted back into the
bodies as are linearly independent, as far as pairs have closed, and all of them at once. Of a sum over all points of
products of adjoint and actual displacements only combinations matter that have a part in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from signorini.arrays import Array
from signorini.derivative.adjoint_terms import Adjoint, PointTerm
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint, factors_of, offsets_of
from signorini.engine.examine import on_ranks
from signorini.fem.node_work import node_work
from signorini.fem.supports import Constraints
from signorini.linalg.protocol import Reduced

_RANK = 1e-13  # of the largest combination: one that does not matter
_ALIKE = 1e-11  # of the largest state: what is left of a state that is a combination of others

_COLUMNS = 32  # displacements that are found at once: their arrays stay in memory that is there already
_PAIRS = _COLUMNS // 2  # of adjoint and actual displacements


@dataclass(frozen=True, kw_only=True, eq=False)
class Combination:
    """Combinations of the points of one system; every array has them last, (..., k).

    Attributes
    ----------
    system : the interface
    adjoint, displacement : (dofs, k) w and u
    motion, forces : (d, a, k) J, and the forces of the active pairs
    one : (k,) sums of what is 1 at every point
    factors : by load, (k,)
    """

    system: InterfaceSystem
    adjoint: Array
    displacement: Array
    motion: Array
    forces: Array
    one: Array
    factors: dict[str, Array]

    def factor(self, name: str) -> Array:
        """(k,) Of a load."""
        return self.factors.get(name, np.zeros(len(self.one)))

    def by_places(self) -> Any:
        """(nodes d,) How ``sum w . K u`` changes with the place of every node, where displacements are."""
        prepared = self.system.prepared
        if on_ranks(prepared.K):
            return prepared.K.by_places(node_work, (self.adjoint, self.displacement))
        return node_work(prepared.space, prepared.model, self.adjoint, self.displacement).ravel()


@dataclass(frozen=True, kw_only=True, eq=False)
class StateColumns:
    """Some states of points of one system; what others have of them is their share.

    Attributes
    ----------
    displacement, forces : (dofs, k), (d a, k)
    one : (k,) ones
    factors : by load, (k,)
    shares : (k, points) of all points
    """

    displacement: Array
    forces: Array
    one: Array
    factors: dict[str, Array]
    shares: Array

    def factor(self, name: str) -> Array:
        """(k,) Of a load."""
        return self.factors.get(name, np.zeros(len(self.one)))


def state_columns(points: Sequence[TapePoint]) -> Iterator[StateColumns]:
    """States of points of one system, some at once, of which all others are combinations.

    Chosen by pivoted Gram-Schmidt: each time the state that is farthest from combinations of those before.
    """
    system, (names, parts) = points[0].system, state_blocks(points)
    scaled = [part.reshape(len(points), -1).T / (float(np.abs(part).max(initial=0.0)) or 1.0) for part in parts]
    R, order = scipy.linalg.qr(np.concatenate(scaled), mode="r", pivoting=True, check_finite=False)
    left = np.abs(np.diag(R))
    rank = max(1, int((left > _ALIKE * left[0]).sum()))
    shares = np.zeros((rank, len(points)))
    shares[:, order] = scipy.linalg.solve_triangular(R[:rank, :rank], R[:rank])
    none = np.zeros((system.directions, system.pairs, 0)), np.zeros((system.motions, 0)), np.zeros(())
    for begin in range(0, rank, _COLUMNS):
        some = order[begin : begin + _COLUMNS][: rank - begin]
        h, r, known, offset = (np.moveaxis(part[some], 0, -1) for part in parts)
        factors = dict(zip(names, known[1:], strict=True))
        yield StateColumns(
            displacement=_substituted(system, none, (h, r, offset), factors)[1],
            forces=r.reshape(-1, len(some)),
            one=known[0],
            factors=factors,
            shares=shares[begin : begin + _COLUMNS],
        )


def state_blocks(points: Sequence[TapePoint]) -> tuple[list[str], list[Array]]:
    """Names of loads, and motions, forces (d, a), 1 and factors of the loads, and offsets (d, a), of every point."""
    names, factors = factors_of(points)
    return names, [
        np.array([point.h / point.system.root for point in points]),
        np.array([point.r * point.system.root for point in points]),
        np.concatenate([np.ones((1, len(points))), factors]).T,
        offsets_of(points),
    ]


def term_blocks(system: InterfaceSystem, numbers: Sequence[int], adjoint: Adjoint) -> list[Array]:
    """Motions J (p, d, a) and resultants (p, k) of an output at points of one system.

    Parameters
    ----------
    system, numbers : the interface, and the points
    adjoint : of the output
    """
    none = PointTerm(motion=np.zeros((system.directions, system.pairs)), resultant=np.zeros(system.motions))
    terms = [adjoint.terms.get(i, none) for i in numbers]
    return [np.array([term.motion for term in terms]), np.array([term.resultant for term in terms])]


def of_same_bodies(points: Sequence[TapePoint], adjoint: Adjoint) -> Iterator[list[int]]:
    """Numbers of the points that matter to an output, those of the same bodies together.

    Parameters
    ----------
    points, adjoint : of the history, and of the output
    """
    numbers = sorted({*adjoint.terms, *adjoint.pulled})
    for bodies in dict.fromkeys(points[i].system.bodies for i in numbers):
        yield [i for i in numbers if points[i].system.bodies == bodies]


def combinations_of(points: Sequence[TapePoint], own: Sequence[int], adjoint: Adjoint) -> Iterator[Combination]:
    """Combinations of points of the same bodies, some at once, by singular values of the sum of their products.

    Parameters
    ----------
    points, own : of the history, and numbers of those of the same bodies that matter to the output
    adjoint : of the output
    """
    system = points[own[0]].system
    names, right = state_blocks([points[i] for i in own])
    pulled = [i for i in own if i in adjoint.pulled]
    left = [*term_blocks(system, own, adjoint), np.array([[float(i == at) for at in pulled] for i in own])]
    first, second = _largest(left, right)
    count = first[0].shape[-1]
    for begin in range(0, count, _PAIRS):
        motion, resultant, pulls = (part[..., begin : begin + _PAIRS] for part in first)
        h, r, known, offset = (part[..., begin : begin + _PAIRS] for part in second)
        factors = dict(zip(names, known[1:], strict=True))
        own_pulls = [(adjoint.pulled[i], row) for i, row in zip(pulled, pulls, strict=True)]
        pulling = sum((times(system.prepared.constraints, y, row) for y, row in own_pulls), np.zeros(()))
        w, u = _substituted(system, (motion, resultant, pulling), (h, r, offset), factors)
        yield Combination(
            system=system,
            adjoint=w,
            displacement=u,
            motion=motion,
            forces=r,
            one=known[0],
            factors=factors,
        )


def columns_of(points: Sequence[TapePoint], own: Sequence[int], adjoint: Adjoint) -> Combination:
    """A few points of the same bodies as they are, a column each; displacements that the history has found are known.

    Parameters
    ----------
    points, own, adjoint : as of `combinations_of`
    """
    some, system = [points[i] for i in own], points[own[0]].system
    names, blocks = state_blocks(some)
    h, r, known, offset = (np.moveaxis(block, 0, -1) for block in blocks)
    motion, resultant = (np.moveaxis(block, 0, -1) for block in term_blocks(system, own, adjoint))
    factors = dict(zip(names, known[1:], strict=True))
    constraints, pulling = system.prepared.constraints, np.zeros(())
    if adjoint.pulled:
        still = _still(constraints, 1)[:, 0]
        pulling = constraints.beside([adjoint.pulled.get(i, still) for i in own])
    lacking = [k for k, point in enumerate(some) if point.displacement is None]
    states = h[..., lacking], r[..., lacking], offset[..., lacking]
    of_lacking = {name: factor[lacking] for name, factor in factors.items()}
    w, found = _substituted(system, (motion, resultant, pulling), states, of_lacking)
    substituted = iter(found.T)
    u = [next(substituted) if point.displacement is None else constraints.placed(point.displacement) for point in some]
    return Combination(
        system=system,
        adjoint=w,
        displacement=constraints.beside(u),
        motion=motion,
        forces=r,
        one=known[0],
        factors=factors,
    )


def times(constraints: Constraints, values: Any, factors: Array) -> Any:
    """(n, k) Values (n,), of all or of the free displacements, times k factors, where vectors of these are.

    Parameters
    ----------
    constraints, values, factors : know where displacements are, the values, and (k,)
    """
    return constraints.beside([factor * values for factor in factors])


def _still(constraints: Constraints, k: int) -> Any:
    """(z, k) No forces on the free displacements."""
    return constraints.spread_free(np.zeros(0, dtype=np.int64), np.zeros((0, k)))


def _largest(left: list[Array], right: list[Array]) -> tuple[list[Array], list[Array]]:
    """Blocks of which the sum over the first axis of the products is that of fewer, which lie along the last axis.

    Parameters
    ----------
    left, right : (points, ...) blocks of both factors
    """
    factors, sizes = [], []
    for blocks in (left, right):
        size = [float(np.abs(block).max(initial=0.0)) or 1.0 for block in blocks]
        rows = [block.reshape(len(block), -1).T / scale for block, scale in zip(blocks, size, strict=True)]
        factors.append(scipy.linalg.qr(np.concatenate(rows), mode="economic"))
        sizes.append(size)
    (Q, R), (Q_r, R_r) = factors
    U, values, V = np.linalg.svd(R @ R_r.T)
    rank = int((values > _RANK * values.max(initial=0.0)).sum())
    whole = Q @ (U[:, :rank] * values[:rank]), Q_r @ V[:rank].T
    return _blocks(whole[0], left, sizes[0]), _blocks(whole[1], right, sizes[1])


def _blocks(rows: Array, like: list[Array], sizes: list[float]) -> list[Array]:
    """Rows (rows, k) as the blocks that they were, (..., k) each."""
    ends = np.cumsum([block[0].size for block in like])[:-1]
    parts = np.split(rows, ends)
    return [
        (size * part).reshape(*block.shape[1:], rows.shape[1])
        for part, block, size in zip(parts, like, sizes, strict=True)
    ]


def _substituted(
    system: InterfaceSystem,
    adjoint: tuple[Array, Array, Array],
    states: tuple[Array, Array, Array],
    factors: dict[str, Array],
) -> tuple[Array, Array]:
    """(dofs, m) Adjoint displacements ``K^-1 (B^T J + pull) + Z j``, and (dofs, k) displacements, substituted together.

    Parameters
    ----------
    system : the interface
    adjoint : (d, a, m) J, (rigid motions, m) j, and (z, m) ``K^-1`` of what pulls on free displacements, or a zero
    states, factors : (d, a, k) motions, forces and offsets, and (k,) by load
    """
    prepared, condensed, (motion, resultant, pulling), r = system.prepared, system.condensed, adjoint, states[1]
    constraints, m, k = prepared.constraints, motion.shape[-1], r.shape[-1]
    names = [name for name, factor in factors.items() if factor.any()]
    each = np.array([factors[name] for name in names]).reshape(len(names), k)
    still, beyond = condensed.reduce(_still(constraints, m + k)), condensed.beyond_forces(*states)
    load = still.load.copy()
    for name, factor in zip(names, each, strict=True):
        load[:, m:] += np.outer(system.unit(name).load, factor)

    def expand(kept: Array) -> Array:
        """Loads are substituted back once, not for every column."""
        moved = still.expand(kept)
        moved[:, :m] += pulling
        for name, factor in zip(names, each, strict=True):
            moved[:, m:] += times(constraints, system.inside(name), factor)
        return moved

    def travel(moved: Array) -> Array:
        return np.concatenate([resultant, condensed.travel(beyond - moved[:, m:])], axis=1)

    forces = np.concatenate([motion.reshape(len(beyond), m), r.reshape(beyond.shape)], axis=1)
    found = constraints.displaced(condensed.response.displacement(Reduced(load, expand), forces, travel))
    for name, factor in zip(names, each, strict=True):
        if name in constraints.prescribed:
            found[:, m:] += times(constraints, constraints.prescribed[name], factor)
    return found[:, :m], found[:, m:]
