# SPDX-License-Identifier: BSD-3-Clause
"""What an output lacks, from what it was on every mesh and what errors of stresses count for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

SLOW_FALL = 0.5
"""Power of nodes with which an output falls that depends on where a contact ends between its nodes."""

FASTEST_FALL = 1.5
"""Power of nodes with which errors of outputs are trusted to fall at most from one mesh to the next: with a larger one
estimates would follow what is luck on one mesh."""

SAFE_FACTOR = 1.5
"""Times an estimate that the last changes confirm."""

_AGREES = (0.25, 4.0)
"""Change from one mesh to the next over what stresses on the first lack, with its sign, where these explain it."""

_STEADY = 4.0
"""Times the smaller of two such ratios: the larger, at most, where it is no chance that they agree."""

_EXPLAINS = (0.2, 1.0)
"""The same over the sum of the products, all of one sign."""

_REGULAR = 0.6
"""Most of a change that the next change may be where an output converges from one side; least is the square of the
ratio of their nodes."""


@dataclass(frozen=True, kw_only=True)
class OutputLevel:
    """An output on a mesh.

    Attributes
    ----------
    value : of the output; nan where nothing presses yet
    nodes : of the mesh
    signed : what errors of stresses lack of it, the sum of their products with dual ones
    products : the sum of the products of their norms, cell by cell
    """

    value: float
    nodes: int
    signed: float
    products: float


def output_error(levels: Sequence[OutputLevel]) -> float:
    """Estimated error of an output on the last of some meshes, of its own kind; inf where nothing is known yet.

    What the last three meshes have changed, where errors fall with the root of the number of nodes, as those of outputs
    do that depend on where a contact ends between its nodes. Less where the last change confirms it: what errors of
    stresses lack with their signs, or all of one sign, by as much as was missing of it before; and the geometric series
    of changes of one sign. No less than the last change by the fastest fall.

    Parameters
    ----------
    levels : of all meshes so far

    Examples
    --------
    Changes that errors of stresses explain: 1.5 times their sum, all of one sign.

    >>> told = [(1.0, 100, 0.4, 0.5), (1.5, 300, 0.1, 0.3), (1.7, 900, 0.02, 0.03)]
    >>> levels = [OutputLevel(value=v, nodes=n, signed=s, products=p) for v, n, s, p in told]
    >>> round(output_error(levels), 3)
    0.045
    """
    if len(levels) < 2 or not np.isfinite([level.value for level in levels[-2:]]).all():
        return float("inf")
    before, last = levels[-2:]
    change = last.value - before.value
    found = abs(change) * (before.nodes / last.nodes) ** SLOW_FALL
    older = levels[-3] if len(levels) > 2 and np.isfinite(levels[-3].value) else None
    if older is not None and len(levels) > 3:  # the first mesh, given, says nothing about the third
        found = max(found, abs(last.value - older.value) * (older.nodes / last.nodes) ** SLOW_FALL)
    confirmed = [*_by_stresses(levels), *_series(levels)]
    least = abs(change) * (before.nodes / last.nodes) ** FASTEST_FALL
    return max(min([max(found, abs(last.signed)), *confirmed]), least)


def _by_stresses(levels: Sequence[OutputLevel]) -> list[float]:
    """By what errors of stresses have lacked of the last changes."""
    last, found = levels[-1], list[float]()
    ends = [(one, other) for one, other in zip(levels[-3:], levels[-2:], strict=False) if np.isfinite(one.value)]
    signed = [(other.value - one.value) / one.signed if one.signed else np.inf for one, other in ends]
    sums = [abs(other.value - one.value) / one.products if one.products else np.inf for one, other in ends]
    if len(ends) > 1 and _AGREES[0] <= min(signed) <= max(signed) <= min(_AGREES[1], _STEADY * min(signed)):
        found.append(max(*signed, 1.0) * abs(last.signed) + _EXPLAINS[0] * last.products)
    if len(ends) > 1 and _EXPLAINS[0] <= min(sums) <= max(sums) <= _EXPLAINS[1] and min(signed) > 0.0:
        found.append(SAFE_FACTOR * max(sums) * last.products)
    return found


def _series(levels: Sequence[OutputLevel]) -> list[float]:
    """What is left of changes of one sign, each a part of the one before it.

    A part below the square of the ratio of nodes may be luck on one mesh. It is believed where the part before, of
    meshes that were refined, is no larger than the ratio of their nodes, and then no more than that part.
    """
    changes = np.diff([level.value for level in levels[-4:]])
    if len(changes) < 2 or not np.isfinite(changes[-2:]).all() or not changes[:-1].all():
        return []
    parts, change = changes[1:] / changes[:-1], abs(changes[-1])
    nodes = [one.nodes / other.nodes for one, other in zip(levels[-3:], levels[-2:], strict=False)]
    part = max(parts[-1], nodes[-1])
    if not nodes[-1] ** 2 < parts[-1] < _REGULAR:
        if len(levels) < 5 or not (0.0 < parts[0] < nodes[0] and 0.0 < parts[1] < nodes[1]):
            return []
        part, change = max(*parts, nodes[-1]), max(change, parts[0] * abs(changes[-2]))
    return [float(SAFE_FACTOR * part / (1.0 - part) * change)]
