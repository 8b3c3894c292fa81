# SPDX-License-Identifier: BSD-3-Clause
"""What varies over the nonmortar side of a contact, at the nodes there."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.errors import Where
from signorini.fem.boundary import boundary
from signorini.fem.space import Space
from signorini.fem.varying import at_nodes
from signorini.model.contact import Contact
from signorini.model.varying import Varying


def side_values(space: Space, contact: Contact, given: Varying, where: Where) -> Array:
    """(nodes,) Values at the nodes of its nonmortar side, where the coarser side is taken of both, 0 elsewhere.

    Parameters
    ----------
    space : of the mesh
    contact : whose side it is
    given : what varies
    where : what errors call it

    Raises
    ------
    InputError
        If a node has no value.
    """
    values = np.zeros(len(space.mesh.points))
    names = (contact.mortar, contact.nonmortar) if contact.side == "coarser" else (contact.nonmortar,)
    for name in names:
        if isinstance(name, str) and name in space.mesh.boundaries:
            side = boundary(space, name, where)
            values[side.nodes] = at_nodes(given, space, side.nodes, where, side)
    return values
