# SPDX-License-Identifier: BSD-3-Clause
"""Displacements of a history in as few columns as the states at all its points are combinations of.

Displacements are linear in what the condensed interface knows of a point: as many states are substituted back into the
bodies as are linearly independent, as far as pairs have closed, and all of them at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from signorini.arrays import Array
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint
from signorini.engine.path_states import offsets
from signorini.linalg.protocol import Reduced

_ALIKE = 1e-11  # of the largest state: what is left of a state that is a combination of others

_COLUMNS = 32  # displacements that are found at once: their arrays stay in memory that is there already


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
    system, (names, parts) = points[0].system, _states(points)
    scaled = [part.reshape(len(points), -1).T / (float(np.abs(part).max(initial=0.0)) or 1.0) for part in parts]
    R, order = scipy.linalg.qr(np.concatenate(scaled), mode="r", pivoting=True, check_finite=False)
    left = np.abs(np.diag(R))
    rank = max(1, int((left > _ALIKE * left[0]).sum()))
    shares = np.zeros((rank, len(points)))
    shares[:, order] = scipy.linalg.solve_triangular(R[:rank, :rank], R[:rank])
    for begin in range(0, rank, _COLUMNS):
        some = order[begin : begin + _COLUMNS][: rank - begin]
        h, r, known, offset = (np.moveaxis(part[some], 0, -1) for part in parts)
        factors = dict(zip(names, known[1:], strict=True))
        yield StateColumns(
            displacement=_displacement(system, h, r, offset, factors),
            forces=r.reshape(-1, len(some)),
            one=known[0],
            factors=factors,
            shares=shares[begin : begin + _COLUMNS],
        )


def _states(points: Sequence[TapePoint]) -> tuple[list[str], list[Array]]:
    """Names of loads, and motions, forces (d, a), 1 and factors of the loads, and offsets (d, a), of every point."""
    system = points[0].system
    names = sorted({name for point in points for name in point.load.factors})
    return names, [
        np.array([point.h / point.system.root for point in points]),
        np.array([point.r * point.system.root for point in points]),
        np.array([[1.0, *(point.load.factors.get(name, 0.0) for name in names)] for point in points]),
        np.array([offsets(system.prepared, point.load)[:, system.active] for point in points]),
    ]


def _displacement(system: InterfaceSystem, h: Array, r: Array, offset: Array, factors: dict[str, Array]) -> Array:
    """(dofs, k) Displacements under motions h, forces r and offsets, (d, a, k), and load factors."""
    prepared, condensed, k = system.prepared, system.condensed, h.shape[-1]
    names = [name for name, factor in factors.items() if factor.any()]
    each = np.array([factors[name] for name in names]).reshape(-1, k)
    still = condensed.reduce(np.zeros((prepared.constraints.transform.shape[1], k)))
    load = still.load.copy()
    for name, factor in zip(names, each, strict=True):
        load += np.outer(system.unit(name).load, factor)

    def expand(kept: Array) -> Array:
        """Loads are substituted back once, not for every column."""
        moved = still.expand(kept)
        if names:
            moved += np.stack([system.inside(name) for name in names], axis=1) @ each
        return moved

    found = prepared.constraints.transform @ condensed.displacement(Reduced(load, expand), h, r, offset)
    for name, factor in factors.items():
        if name in prepared.constraints.prescribed:
            found += np.outer(prepared.constraints.prescribed[name], factor)
    return np.asarray(found)
