# SPDX-License-Identifier: BSD-3-Clause
"""When an accuracy is met, how many cells the next mesh has, and what ends it: nodes, memory, time."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

from signorini.accuracy.estimate import IN_SPACE, Estimate
from signorini.accuracy.meshes import Growth, is_linear
from signorini.memory import available_memory, peak_memory
from signorini.model.accuracy import Accuracy
from signorini.model.model import Model
from signorini.solution.accuracy import MeshLevel

SAFE_SHARE, SHARE_IN_SPACE = 0.7, 0.85
"""Of what was asked for: what the next mesh is made for, and for norms in space, where one more takes the longest."""

LEAST_GROWTH, MOST_GROWTH, MOST_IN_PLANE, MOST_TO_THE_LAST = 1.6, 3.0, 6.0, 4.5
"""How many times the cells of a mesh the next one has, at most, for norms in the plane, and in space where the next is
expected to be the last: with fewer solves add up, with more cells are where no errors are."""

_FASTER = 1.5
"""Times the power that is expected of errors in norms: with which they have fallen in the plane, at most, and do with
few pairs, whose errors are those of the ends alone."""

SHARE_OF_ROOM, SMALLEST_GROWTH = 0.9, 1.2
"""Of the nodes that a mesh may have: what it is made for where errors ask for more; the least growth worth a mesh."""

MORE_NODES = {2: 1.4, 3: 3.5}
"""How many times the nodes of a mesh it has, about, where the facets that touch are halved, which outputs ask for."""

LEVELS = 40
"""Meshes that are tried at most; each has some 1.5 times the nodes of the one before, so that nodes end it first."""

PAIRS = {2: 10, 3: 30}
"""Pairs that have to touch, at least, in the plane and in space: with fewer the ends of a contact are known to a tenth.
In space they are those of a circle of ten across, and of a quarter of one twice as large."""

PLANE = 2
"""Dimension in which what the sides of a contact lack tells where to refine, and errors fall as evenly as cells."""

_MESHES, _MESHES_FOR_OUTPUTS = {"energy": 1, "pressure": 2, "traction": 2}, {2: 3, 3: 2}
"""On which each has to be known, at least; outputs, whose errors change sign, on three, in space on two: there each has
four times the nodes of the one before and more."""

_LINEAR_PRESSURES = 1.5
"""Times the power of nodes with which stresses of linear cells lack less: that of pressures, which balance loads."""

_FALL_NEAR_CONTACT = 1.25
"""Times the power of nodes with which errors in space fall otherwise: what those of pressures do, since cells
are refined by how near they are to the contact."""

_FILL, _FILL_ITERATED = {2: 1.1, 3: 1.4}, 1.1
"""Power of its nodes with which the memory of a mesh grows, in the plane and in space: its factor; and where contact is
iterated on the bodies as they are: their stiffness, of which cells share a little more on meshes that are finer."""


class Bounds:
    """What was asked for, and what it may cost.

    Parameters
    ----------
    request : of the user
    dimension : of the bodies
    """

    def __init__(self, request: Accuracy, dimension: int) -> None:
        self._request, self._dimension = request, dimension
        self._start, self._held = time.perf_counter(), peak_memory()

    def met(self, found: Estimate, levels: int) -> bool:
        """Whether errors are small enough, on as many meshes as they need and with enough pairs."""
        request = self._request
        if not found.of(request.of) <= request.error:
            return False
        return request.of == "energy" or (levels >= self._meshes and found.pairs >= PAIRS[self._dimension])

    @property
    def _meshes(self) -> int:
        of = self._request.of
        return _MESHES[of] if isinstance(of, str) else _MESHES_FOR_OUTPUTS[self._dimension]

    def growth(self, found: Estimate, model: Model, levels: Sequence[MeshLevel]) -> Growth:
        """Of the number of cells, as far as errors that fall as usual, or as they have, ask for it.

        In the plane several meshes that it takes grow alike, so that the last is no larger than it need be.

        Parameters
        ----------
        found, model : estimated, on its mesh
        levels : meshes so far, with this one
        """
        request, d, error = self._request, model.dimension, found.of(self._request.of)
        norm = isinstance(request.of, str)
        even, in_space, halved = d == PLANE, norm and d == IN_SPACE, 1.0 if norm else MORE_NODES[d]
        least, most = LEAST_GROWTH if norm else SMALLEST_GROWTH, MOST_GROWTH
        lacks = min(max(error / request.error / (SHARE_IN_SPACE if in_space else SAFE_SHARE), 1.0), 1e6)
        needed = lacks ** (1.0 / self._power(found, model, levels))
        if even and needed > MOST_IN_PLANE:
            needed **= 1.0 / math.ceil(math.log(needed) / math.log(MOST_IN_PLANE))
        if even or (in_space and needed <= MOST_TO_THE_LAST):
            most = max(needed, least)
        room = SHARE_OF_ROOM / halved * request.nodes / len(model.mesh.points)
        times = min(max(needed / halved, least), most, room if room > SMALLEST_GROWTH else most)
        return Growth(least=min(least, times), most=times, share=1.0 / lacks if even and norm else 0.0)

    def _power(self, found: Estimate, model: Model, levels: Sequence[MeshLevel]) -> float:
        """Of the number of nodes, with which errors are expected to fall."""
        of, d, linear = self._request.of, model.dimension, is_linear(model)
        power = (1.0 if linear else 2.0) / d
        if not isinstance(of, str):
            return power * (1.0 if d == IN_SPACE else min(max(_fall(levels[-2:], "output") / power, 1.0), _FASTER))
        if d == IN_SPACE:
            return power * (1.0 if of == "energy" else _FALL_NEAR_CONTACT)
        if linear and of != "energy":
            power *= _LINEAR_PRESSURES
        few = found.pairs < PAIRS[d] and of != "energy"
        return power * (_FASTER if few else min(max(_fall(levels[-2:], of) / power, 1.0), _FASTER))

    def end(self, nodes: int, more: int, levels: int, *, iterated: bool = False) -> str:
        """Why no finer mesh is tried; empty: it is.

        Parameters
        ----------
        nodes, more : of the last mesh and of the next one
        levels : meshes so far
        iterated : whether nothing was factorised on the last one
        """
        request, held = self._request, peak_memory()
        seconds = time.perf_counter() - self._start
        if more > request.nodes:
            return f"the next mesh has {more} nodes, more than {request.nodes}"
        if request.seconds is not None and seconds > request.seconds:
            return f"{seconds:.1f} s have passed, more than {request.seconds:g}"
        fill = _FILL_ITERATED if iterated else _FILL[self._dimension]
        expected = self._held + (held - self._held) * (more / nodes) ** fill
        room = held + available_memory() if request.memory is None else request.memory
        if expected > room:
            words = f"the next mesh has {more} nodes, with which {expected / 1e9:.3g} GB of memory are expected"
            return f"{words}, more than {room / 1e9:.3g} GB"
        return f"{levels} meshes were tried" if levels >= LEVELS else ""


def _fall(levels: Sequence[MeshLevel], of: str) -> float:
    """Of the number of nodes with which an error has fallen between two meshes; 0 where it has not, or of one mesh."""
    errors = [float(getattr(level, of) or 0.0) for level in levels]
    falls = len(levels) > 1 and errors[0] > errors[1] > 0.0
    return math.log(errors[0] / errors[1]) / math.log(levels[1].nodes / levels[0].nodes) if falls else 0.0
