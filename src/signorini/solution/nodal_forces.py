# SPDX-License-Identifier: BSD-3-Clause
"""Forces of supports and contacts at the nodes that they act on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, distinct, frozen
from signorini.fem.space import Space
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class NodalForces(Short):
    """Forces on the bodies in one state, where there are any.

    Attributes
    ----------
    node : (k,) node indices, from 0; one may be there twice, then its forces add up
    reaction : (k, d) of supports and elastic foundations, force
    contact : (k, d) of contacts on both of their sides, ties and bonds included, force
    """

    node: IntArray
    reaction: Array
    contact: Array

    @classmethod
    def of(cls, space: Space, reaction: Array, contact: Array) -> NodalForces:
        """Forces on all dofs of a space, wherever they are.

        Parameters
        ----------
        space : of the bodies
        reaction, contact : (dofs,) of supports and elastic foundations; of contacts
        """
        acting = np.concatenate([np.flatnonzero(forces) for forces in (reaction, contact)])
        node = distinct(acting[acting < space.dofs_of_nodes] // space.components)
        dofs = space.dofs(node)
        return cls(node=frozen(node, np.int64), reaction=frozen(reaction[dofs]), contact=frozen(contact[dofs]))

    def at_all(self, count: int) -> tuple[Array, Array]:
        """Reactions and forces of contacts at all of ``count`` nodes, each (nodes, d)."""
        found = np.zeros((2, count, self.reaction.shape[1]))
        np.add.at(found[0], self.node, self.reaction)
        np.add.at(found[1], self.node, self.contact)
        return found[0], found[1]

    def towards(self, end: NodalForces, t: float) -> NodalForces:
        """Forces at the part t of the way to others."""
        return NodalForces(
            node=np.concatenate([self.node, end.node]),
            reaction=np.concatenate([(1.0 - t) * self.reaction, t * end.reaction]),
            contact=np.concatenate([(1.0 - t) * self.contact, t * end.contact]),
        )
