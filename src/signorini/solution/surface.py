# SPDX-License-Identifier: BSD-3-Clause
"""The surface of a contact in space: its faces on the nodes that carry results."""

from __future__ import annotations

import numpy as np

from signorini.arrays import IntArray
from signorini.model.model import Model
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult


def contact_faces(model: Model, result: ContactResult) -> tuple[IntArray, ...]:
    """Corners of the nonmortar faces as indices into the nodes of a contact, (m, 3 or 4), by kinds of faces."""
    order = np.argsort(result.node)
    found = []
    for given in model.mesh.facets(result.nonmortar):
        corners = given[:, : 3 if given.shape[1] in (3, 6) else 4]
        at = np.searchsorted(result.node, corners, sorter=order)
        index: IntArray = order[np.minimum(at, len(order) - 1)]
        found.append(index[(result.node[index] == corners).all(axis=1)])
    return tuple(found)


def status_codes(result: ContactResult) -> IntArray:
    """0 open, 1 stick, 2 slip, (n,)."""
    codes: IntArray = np.select([result.status == name for name in (OPEN, STICK, SLIP)], [0, 1, 2])
    return codes
