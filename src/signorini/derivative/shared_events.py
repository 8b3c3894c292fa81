# SPDX-License-Identifier: BSD-3-Clause
"""What an output feels of points at which pairs come to their events together, or end on one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint import adjoint_of
from signorini.derivative.adjoint_terms import Weights
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.view import HistoryView
from signorini.model.outputs import Output

_FELT = 1e-9  # of how an output changes with anything that is remembered: less is rounding


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedEvents:
    """The points with edges of a history, for an output.

    Attributes
    ----------
    view, probe : the history and its edges
    output : what is asked of it
    weights : how it changes with motions and forces directly, by number of the point
    """

    view: HistoryView
    probe: EdgeProbe
    output: Output
    weights: Mapping[int, Weights]

    def felt(self, i: int) -> bool:
        """Whether it matters to the output which of the pairs that share point i acts there first.

        Behind it states are the same ones, whatever the order, and what is given tells motions and forces from what is
        remembered. So a path in the plane keeps of the order what pairs remember that begin to stick there, or act, and
        outputs what they are asked there themselves. Where loads turn, pairs may slip a little before they stick again.
        """
        point = self.view.points[i]
        if i > self.last:
            return False
        if i == self.last or not point.at_event or point.states.codes is None or np.any(point.increment):
            return True
        acting = np.concatenate([point.acting, point.conditions.pair[self.probe.conditions(i)]])
        changing = np.flatnonzero((~point.states.held).any(axis=0) | np.isin(np.arange(point.system.pairs), acting))
        pairs, asked, behind = point.system.active[changing], self.weights.get(i), np.abs(self._behind[i])
        if asked is not None and (asked.h[:, pairs].any() or asked.r[:, pairs].any()):
            return True
        return bool(behind[:, pairs].max(initial=0.0) > _FELT * behind.max(initial=0.0))

    def why_parted(self) -> str:
        """What the output feels that gaps of single nodes take apart; empty where that is nothing."""
        if not (self.probe and self.probe.parted):
            return ""
        felt = [i for i in self.probe.points if self.felt(i)]
        return self.probe.words(self.view, felt[0]) if felt and self.probe.parted_by_gaps(felt) else ""

    @property
    def last(self) -> int:
        """Number of the point that the output is asked at."""
        return self.view.number(self.output.load_factor)

    @cached_property
    def _behind(self) -> dict[int, Array]:
        """(d - 1, n) How the output changes with what is remembered behind points with edges, by number."""
        return adjoint_of(self.view, self.output, self.probe.points)[0].behind
