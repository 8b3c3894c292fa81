# SPDX-License-Identifier: BSD-3-Clause
"""What an output lacks: what it is on a mesh whose touching facets are halved, and what errors of stresses tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

SAFE_FACTOR = 1.5
"""Times what halving the facets that touch changes: what is lost between their nodes falls to a fourth, so that the
change is three fourths of it, or, where friction remembers where a contact has ended, to a half, so that it is half."""

SLOW_FALL = 0.5
"""Power of nodes with which an output falls where nothing but meshes before is known: it errs on the safe side."""


@dataclass(frozen=True, kw_only=True)
class OutputLevel:
    """An output on a mesh.

    Attributes
    ----------
    value : of the output; nan where nothing presses yet
    nodes : of the mesh
    signed : what errors of stresses lack of it, the sum of their products with dual ones
    halved : the output where the facets that touch are halved; nan where that is not known
    """

    value: float
    nodes: int
    signed: float
    halved: float = float("nan")


def output_error(levels: Sequence[OutputLevel]) -> float:
    """Estimated error of an output on the last of some meshes, of its own kind; inf where nothing is known yet.

    What is lost between the nodes of the contacts, from what halving their facets changes, and what errors of stresses
    lack. Where facets were not halved: what the last meshes have changed, as it falls where outputs fall most slowly.

    Parameters
    ----------
    levels : of all meshes so far

    Examples
    --------
    >>> level = OutputLevel(value=1.0, nodes=900, signed=-0.001, halved=1.02)
    >>> round(output_error([level]), 3)
    0.031
    """
    if not levels or not np.isfinite(levels[-1].value):
        return float("inf")
    last = levels[-1]
    if np.isfinite(last.halved):
        return SAFE_FACTOR * abs(last.halved - last.value) + abs(last.signed)
    known = [one for one in levels[-3:-1] if np.isfinite(one.value)]
    changes = [abs(last.value - one.value) * (one.nodes / last.nodes) ** SLOW_FALL for one in known]
    return max([*changes, abs(last.signed)]) if changes else float("inf")
