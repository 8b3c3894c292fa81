# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in space: mortar coupling of faces that need not match, node pairs, nodes on faces, frames.

`make_surface` makes a side from node arrays; `mortar_coupling`, `node_to_face` and `node_pairs` give a
`interface.coupling.Coupling` of two of them; `frames` gives the axes of its pairs.
"""

from signorini.interface.spatial.frames import frames
from signorini.interface.spatial.mortar import mortar_coupling
from signorini.interface.spatial.node_to_face import node_pairs, node_to_face
from signorini.interface.spatial.surface import Surface, make_surface

__all__ = [
    "Surface",
    "frames",
    "make_surface",
    "mortar_coupling",
    "node_pairs",
    "node_to_face",
]
