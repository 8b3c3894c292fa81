# SPDX-License-Identifier: BSD-3-Clause
"""Bolts that lock between two steps: what they prescribe from there on follows from the history before.

A bolt that locks prescribes the shortening d that it has then. With that as a number of its own, o, an output is a
function of all that is given and of o, and changes by ``dJ/dp + dJ/do d'``, where d' is the derivative of an output of
the history before: of a displacement at the last point at which the bolt is free.
"""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np

from signorini.arrays import Array
from signorini.engine.prepare import Prepared
from signorini.engine.support_changes import completed
from signorini.fem.supports import Constraints


class LockedBolts:
    """The bolts that lock along a history, and its models with locked bolts as supports that move.

    Attributes
    ----------
    lengths : by name of the support that a locked bolt is, the dof of its shortening; of those that have locked so far
    """

    def __init__(self) -> None:
        self.lengths: dict[str, int] = {}
        self._free: set[str] = set()
        self._constraints: dict[int, Constraints] = {}

    def posed(self, prepared: Prepared) -> Prepared:
        """A model as the history goes through it next, in which bolts that have locked prescribe their shortening.

        Parameters
        ----------
        prepared : the model in a part of the history
        """
        mesh, constraints = prepared.model.mesh, prepared.constraints
        for bolt in prepared.model.bolts:
            dof = prepared.model.components * int(mesh.nodes[bolt.section][0])
            if not constraints.held[dof]:
                self._free.add(bolt.label)
            elif bolt.label in self._free:
                self._free.remove(bolt.label)
                self.lengths[f"{bolt.label} as it is locked"] = dof
        if not self.lengths:
            return prepared
        if id(constraints) not in self._constraints:  # one for all systems of the same bodies
            prescribed = {name: _shortened(prepared, dof) for name, dof in self.lengths.items()}
            self._constraints[id(constraints)] = replace(
                constraints, prescribed=MappingProxyType({**constraints.prescribed, **prescribed})
            )
        return replace(prepared, constraints=self._constraints[id(constraints)])


def _shortened(prepared: Prepared, dof: int) -> Array:
    """(dofs,) What a locked bolt prescribes per length of its shortening, which is a dof."""
    one = np.zeros(prepared.space.number_of_dofs)
    one[dof] = 1.0
    return completed(prepared, one)
