# SPDX-License-Identifier: BSD-3-Clause
"""Two square cells side by side, held below, with reference nodes above them: what couplings are tried on."""


def two_cells(*references: str) -> str:
    """Nodes 1 to 3 below (BOT), 4 to 6 above (TOP), cells E; and reference nodes, each a line of the deck."""
    points = ["1,0,0", "2,1,0", "3,2,0", "4,0,1", "5,1,1", "6,2,1", *references]
    return "\n".join(
        [
            *("*NODE", *points),
            *("*ELEMENT,TYPE=CPE4,ELSET=E", "1,1,2,5,4", "2,2,3,6,5"),
            *("*NSET,NSET=TOP", "4,5,6", "*NSET,NSET=BOT", "1,2,3"),
            *("*MATERIAL,NAME=M", "*ELASTIC", "100.,0.3", "*SOLID SECTION,ELSET=E,MATERIAL=M"),
            *("*BOUNDARY", "BOT,1,2", ""),
        ]
    )
