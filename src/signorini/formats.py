# SPDX-License-Identifier: BSD-3-Clause
"""What meshio lacks of the cells that this package has."""

from __future__ import annotations


def complete_meshio() -> None:
    """Tell meshio the dimension of the wedge with 15 nodes: version 5.3 reads and writes it, but does not know that."""
    import meshio

    meshio._mesh.topological_dimension.setdefault("wedge15", 3)
