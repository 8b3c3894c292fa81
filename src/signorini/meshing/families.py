# SPDX-License-Identifier: BSD-3-Clause
"""Groups of Salome's MED files, which meshio reads as numbers of families and leaves there."""

from __future__ import annotations

import meshio
import numpy as np


def name_families(found: meshio.Mesh) -> None:
    """Give a mesh from a MED file the cell sets and point sets that its families mean; others are left as they are.

    A family is what has the same groups: its number stands at every cell (or point), its groups in a table beside it.
    """
    names = getattr(found, "cell_tags", {})
    if names and "cell_tags" in found.cell_data:
        tags = found.cell_data["cell_tags"]
        for name in sorted({name for groups in names.values() for name in groups}):
            own = [tag for tag, groups in names.items() if name in groups]
            found.cell_sets[name] = [np.flatnonzero(np.isin(block, own)) for block in tags]
    names = getattr(found, "point_tags", {})
    if names and "point_tags" in found.point_data:
        for name in sorted({name for groups in names.values() for name in groups}):
            own = [tag for tag, groups in names.items() if name in groups]
            found.point_sets[name] = np.flatnonzero(np.isin(found.point_data["point_tags"], own))
