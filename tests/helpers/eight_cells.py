# SPDX-License-Identifier: BSD-3-Clause
"""A block of eight bricks, none of them rectangular, as decks have it: what keywords of loads are tried on."""

import numpy as np


def eight_cells(*, kind: str = "C3D8", lower: str = "", skew: float = 0.06) -> str:
    """Nodes 1 to 27 (ALL), FIX at x = 0, R at x = 2, cells E with the surfaces TOP and BOT, FIX held.

    Parameters
    ----------
    kind : element type of the cells
    lower : another one of the lower four
    skew : how far nodes are from those of bricks, length
    """
    ways = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)[:, ::-1]
    points = ways * [1.0, 0.75, 0.5] + skew * np.random.default_rng(5).uniform(-1.0, 1.0, (27, 3))
    nodes = [f"{k},{x:.4f},{y:.4f},{z:.4f}" for k, (x, y, z) in enumerate(points, start=1)]
    corners = np.array([0, 1, 4, 3, 9, 10, 13, 12])
    cells = [1 + corners + i + 3 * j + 9 * k for k, j, i in np.ndindex(2, 2, 2)]
    lines = [",".join(map(str, [number, *cell])) for number, cell in enumerate(cells, start=1)]
    return "\n".join(
        [
            *("*NODE,NSET=ALL", *nodes, f"*ELEMENT,TYPE={lower or kind},ELSET=E", *lines[:4]),
            *(f"*ELEMENT,TYPE={kind},ELSET=E", *lines[4:]),
            *("*NSET,NSET=FIX,GENERATE", "1,25,3", "*NSET,NSET=R,GENERATE", "3,27,3", "*ELSET,ELSET=LOW", "1,2,3,4"),
            *("*SURFACE,NAME=TOP", "5,S2", "6,S2", "7,S2", "8,S2", "*SURFACE,NAME=BOT", "LOW,S1"),
            *("*MATERIAL,NAME=M", "*ELASTIC", "1000.,.27", "*DENSITY", "2.5", "*EXPANSION", "1.E-3"),
            *("*SOLID SECTION,ELSET=E,MATERIAL=M", "*BOUNDARY", "FIX,1,3", ""),
        ]
    )
