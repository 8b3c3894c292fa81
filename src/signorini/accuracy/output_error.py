# SPDX-License-Identifier: BSD-3-Clause
"""What an output lacks: what halving the facets that touch has changed, and what errors of stresses tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

SLOW_FALL, FAST_FALL = 1.0, 1.8
"""Powers of the length of facets with which what is lost between their nodes is taken to fall, at least and at most:
with the length itself, where friction remembers where a contact has ended on its way, or with its square, of which less
is believed."""

FASTEST_FALL = 4.5
"""The same of an output from mesh to mesh: what halving facets changes is small by luck at times, and then what has
changed since the mesh before tells what is left at least."""

LEAST_SUM = 0.5
"""Of two errors of opposite signs: the share of the sum of their sizes that they are taken to have at least."""

HALVED = 2.0
"""How many times the facets that touch are shorter on every mesh, at least."""


@dataclass(frozen=True, kw_only=True)
class OutputLevel:
    """An output on a mesh.

    Attributes
    ----------
    value : of the output; nan where nothing presses yet
    whole : before the facets that touch were halved; nan where that is not known
    length : of cells, as it falls with their number
    signed : what errors of stresses lack of it, the sum of their products with dual ones: more of it, where > 0
    """

    value: float
    whole: float
    length: float
    signed: float

    @property
    def change(self) -> float:
        """By the halved facets."""
        return self.value - self.whole


def output_error(levels: Sequence[OutputLevel]) -> float:
    """Estimated error of an output on the last of some meshes, of its own kind; inf where nothing is known yet.

    What is left of what is lost between the nodes of the contacts, by what halving their facets has changed, and what
    errors of stresses lack, with their signs.

    Parameters
    ----------
    levels : of all meshes so far

    Examples
    --------
    >>> level = OutputLevel(value=1.0, whole=0.98, length=0.1, signed=0.001)
    >>> round(output_error([level]), 3)
    0.021
    """
    last = levels[-1]
    if not np.isfinite(last.change):
        return float("inf")
    power, more = SLOW_FALL, 0.0
    if len(levels) > 1 and np.isfinite(levels[-2].change):
        before = levels[-2]
        finer = max(before.length / last.length, HALVED)
        if abs(before.change) > abs(last.change) > 0.0:
            fall = np.log(abs(before.change / last.change)) / np.log(finer)
            power = float(np.clip(fall, SLOW_FALL, FAST_FALL))
        more = abs(left(last.value - before.value, finer, FASTEST_FALL))
    facets = left(last.change, HALVED, power)
    return max(abs(facets + last.signed), LEAST_SUM * (abs(facets) + abs(last.signed))) + more


def left(change: float, finer: float, power: float) -> float:
    """Of an error that falls with a power of a length, what is left where it has changed by so much.

    Parameters
    ----------
    change : of the output
    finer : how many times the length has become smaller
    power : of the length

    Examples
    --------
    >>> left(0.75, 2.0, 2.0)
    0.25
    """
    return change / (finer**power - 1.0)
