# SPDX-License-Identifier: BSD-3-Clause
"""Adjoint and actual displacements of a history, in as few pairs as a sum over all its points needs.

Both are linear in what the condensed interface knows of a point; of the sum of their products over the points only the
combinations are substituted back into the bodies that matter.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from signorini.arrays import Array
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint
from signorini.derivative.recursion import Adjoint, PointTerm
from signorini.engine.path_states import offsets

_RANK = 1e-13  # of the largest combination: one that does not matter

_COLUMNS = 64  # displacements that are found at once


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


def combinations(points: Sequence[TapePoint], adjoint: Adjoint) -> Iterator[Combination]:
    """Combinations of the points that matter to an output, some at once.

    Parameters
    ----------
    points : of the history
    adjoint : of the output
    """
    numbers = sorted({*adjoint.terms, *adjoint.pulled})
    for system in dict.fromkeys(points[i].system for i in numbers):
        own = [i for i in numbers if points[i].system is system]
        yield from _of_system(system, points, own, adjoint)


def _of_system(
    system: InterfaceSystem, points: Sequence[TapePoint], own: list[int], adjoint: Adjoint
) -> Iterator[Combination]:
    """Combinations of points of one system, by singular values of the sum of their products."""
    names = sorted({name for i in own for name in points[i].load.factors})
    pulled = [i for i in own if i in adjoint.pulled]
    none = PointTerm(motion=np.zeros((system.directions, system.pairs)), resultant=np.zeros(system.motions))
    terms = [adjoint.terms.get(i, none) for i in own]
    left = [
        np.array([term.motion for term in terms]),
        np.array([term.resultant for term in terms]),
        np.array([[float(i == at) for at in pulled] for i in own]),
    ]
    right = [
        np.array([points[i].h / system.root for i in own]),
        np.array([points[i].r * system.root for i in own]),
        np.array([[1.0, *(points[i].load.factors.get(name, 0.0) for name in names)] for i in own]),
        np.array([offsets(system.prepared, points[i].load)[:, system.active] for i in own]),
    ]
    first, second = _largest(left, right)
    count = first[0].shape[-1]
    for begin in range(0, count, _COLUMNS):
        motion, resultant, pulls = (part[..., begin : begin + _COLUMNS] for part in first)
        h, r, known, offset = (part[..., begin : begin + _COLUMNS] for part in second)
        factors = dict(zip(names, known[1:], strict=True))
        pulling = sum((np.outer(adjoint.pulled[i], row) for i, row in zip(pulled, pulls, strict=True)), np.zeros(()))
        yield Combination(
            system=system,
            adjoint=_adjoint(system, motion, resultant, pulling),
            displacement=_displacement(system, h, r, offset, factors),
            motion=motion,
            forces=r,
            one=known[0],
            factors=factors,
        )


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


def _adjoint(system: InterfaceSystem, motion: Array, resultant: Array, pulling: Array) -> Array:
    """(dofs, k) Displacements ``K^-1 (B^T J + pull) + Z j``.

    Parameters
    ----------
    system : the interface
    motion, resultant : (d, a, k) J and (rigid motions, k) j
    pulling : (z, k) ``K^-1`` of what pulls on free displacements, or a zero
    """
    T, condensed, k = system.prepared.constraints.transform, system.condensed, motion.shape[-1]
    still = condensed.reduce(np.zeros((T.shape[1], k)))
    moved = condensed.response.displacement(still, motion.reshape(-1, k), lambda _: resultant)
    return np.asarray(T @ (moved + pulling))


def _displacement(system: InterfaceSystem, h: Array, r: Array, offset: Array, factors: dict[str, Array]) -> Array:
    """(dofs, k) Displacements under motions h, forces r and offsets, (d, a, k), and load factors."""
    prepared, condensed, k = system.prepared, system.condensed, h.shape[-1]
    f = np.zeros((prepared.space.number_of_dofs, k))
    imposed = np.zeros_like(f)
    for name, factor in factors.items():
        f += np.outer(system.unit(name).forces, factor)
        if name in prepared.constraints.prescribed:
            imposed += np.outer(prepared.constraints.prescribed[name], factor)
    free = condensed.displacement(condensed.reduce(prepared.constraints.on_free(f)), h, r, offset)
    return np.asarray(prepared.constraints.transform @ free + imposed)
