# SPDX-License-Identifier: BSD-3-Clause
"""How a stride of sides that slide far is to go: its pairs, and the forces that grow in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.engine.handing_over import Handover, Way
from signorini.engine.step_parts import StepPart
from signorini.engine.stride_pairs import Pairing
from signorini.interface.mean_pairs import MeanPairs
from signorini.interface.sliding import sliding_pairs

_LEAST_WAY = 0.1  # strides: a pair that slides less, as where sides roll, has no direction to tilt its normals along
_SLIDES = 0.1  # strides: in the mean of the pairs, where sides slide and do not only creep


@dataclass(frozen=True, kw_only=True, eq=False)
class StridePlan:
    """How a stride is to go.

    Attributes
    ----------
    now : from where the last one ended, as far as it goes
    begin : the pairs there
    expected : (dofs,) displacement in it; 0 where nothing is known of it, and pairs are those of its beginning
    ahead : length of the next stride, of its own; 0: it ends the part, and has the pairs of its end
    last : (d, n) forces at its end, known from having gone it before
    limit : a stride, length
    """

    now: StepPart
    begin: Pairing
    expected: Array
    ahead: float = 0.0
    last: Array | None = None
    limit: float = 0.0

    @property
    def blind(self) -> bool:
        """Whether nothing is known of it."""
        return not self.expected.any()

    def end(self) -> Pairing:
        """Pairs where it is expected to end."""
        return self.begin if self.blind else Pairing.at(self.now, self.now.before.displacement + self.expected)

    def pairs(self, end: Pairing, known: BoolArray, beyond: Array) -> MeanPairs:
        """The pairs of all of it.

        Parameters
        ----------
        end : those where it ends
        known : (n,) pairs whose gap is known where it begins
        beyond : (n,) gaps there beyond those of the geometry, length
        """
        interface, state = end.interface, self.now.before
        if self.blind or not self.ahead:
            return MeanPairs(interface=interface, rest=sp.csr_array(interface.B.shape))
        was = state.gap - interface.give(state.forces, state.borne)[0]
        opened = np.where(known, interface.gap + beyond - was, np.nan)
        return MeanPairs.between(self.begin.interface, interface, self.expected, opened, least=_LEAST_WAY * self.limit)

    def grown(self, handover: Handover, pairs: MeanPairs, end: Pairing, opened: Array, owed: float) -> Handover:
        """What hands over, with the forces that grow in it.

        Parameters
        ----------
        handover : from the last one
        pairs, end : those of all of it, and those of its end
        opened : (n,) as of `Handover.booked`
        owed : energy that was set free before
        """
        if self.blind or not self.ahead:
            return handover
        forces = handover.before.forces
        if self.last is None:
            handover, mean = handover.towards(pairs.rest, forces), forces
        else:
            handover = handover.towards(sp.csr_array(end.interface.B - pairs.interface.B), self.last)
            mean = 0.5 * (forces + self.last)
        slides = sliding_pairs(self.now.prepared.model, end.interface)
        way = Way(moved=self.expected, forces=mean, slides=slides, ahead=self.ahead, least=_SLIDES * self.limit)
        return handover.balanced(pairs.interface, way, opened, owed)
