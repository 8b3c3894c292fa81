# SPDX-License-Identifier: BSD-3-Clause
"""A punch whose profile is found that presses evenly: the pressure of every node by the gap of every node.

    python examples/level_pressure.py [FOLDER]

A rigid punch with square edges is pressed into an elastic block, and at its edges the pressure is singular. Newton's
method takes what every gap makes of every pressure. The profile that comes out is that of a half-plane under uniform
pressure. Writes level_pressure.png (default: docs/figures).
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array

HALF, FORCE, E, NU = 1.0, 20.0, 1000.0, 0.3
BLOCK = 12.0  # width and height, of half of it


def punch(cells: int) -> sg.Model:
    """Half of a block, finer under the punch: from its axis to its edge ``cells`` elements."""
    x = np.concatenate([np.linspace(0.0, HALF, cells + 1), HALF + np.geomspace(HALF / cells, BLOCK - HALF, 14)])
    y = -np.concatenate([[0.0], np.geomspace(HALF / cells, BLOCK, 18)])[::-1]
    grid = sg.rectangle(nx=len(x) - 1, ny=len(y) - 1)
    column, row = (np.rint(grid.points * [len(x) - 1, len(y) - 1]).astype(int)).T
    top = np.flatnonzero((row == len(y) - 1) & (column <= cells))
    top = top[np.argsort(column[top])]
    mesh = sg.Mesh(
        points=np.column_stack([x[column], y[row]]),
        cells=grid.cells,
        bodies=grid.bodies,
        boundaries={**grid.boundaries, "seat": np.column_stack([top[:-1], top[1:]])},
    )
    flat = sg.Plane(point=(0.0, 0.0), normal=(0.0, -1.0))
    return sg.Model(
        mesh,
        kind="plane strain",
        bodies=[sg.Body("block", sg.Elastic(E=E, nu=NU))],
        supports=[sg.Support("left", u=(0.0, None)), sg.Support("bottom", u=(None, 0.0))],
        obstacles=[sg.Rigid("punch", flat, u=(0.0, None), force=(0.0, -FORCE))],
        contacts=[sg.Contact("seat", "punch", name="seat")],
        steps=[sg.Step(scale={"punch": 1.0})],
    )


def level(cells: int = 20, most: int = 8) -> tuple[Array, Array, Array, list[float]]:
    """Places of the nodes, the pressure at first, the gaps that level it, and how uneven it is after every step."""
    prepared = sg.prepare(punch(cells))
    first = prepared.solve().contact("seat")
    order = np.argsort(first.points[:, 0])
    nodes = first.node
    function = prepared.function(["gap.seat"], [sg.pressure("seat")[int(node)] for node in nodes])
    gap, mean, uneven = np.zeros(len(nodes)), FORCE / HALF, []
    for _ in range(most):
        pressure = function.values(gap)
        uneven.append(float(np.abs(pressure / mean - 1.0).max()))
        if uneven[-1] < 1e-9:
            break
        # a gap that all nodes have moves the punch and no pressure: of all steps the smallest
        gap = gap + np.linalg.lstsq(function.jacobian(gap), mean - pressure, rcond=1e-10)[0]
    gap = gap - gap[order[0]]
    return first.points[order, 0], first.pressure[order], gap[order], uneven


def half_plane(x: Array) -> Array:
    """Sinking of a half-plane under uniform pressure on -HALF..HALF, less that in the middle (Johnson 1985, 2.5)."""
    modulus, p = E / (1.0 - NU**2), FORCE / HALF

    def part(y: Array) -> Array:
        return np.where(y == 0.0, 0.0, y * np.log(np.abs(np.where(y == 0.0, 1.0, y)) / HALF))

    return 2.0 * p / (np.pi * modulus) * (part(HALF + x) + part(HALF - x))


def main(folder: Path) -> None:
    """Level, print and draw."""
    x, before, gap, uneven = level()
    print("largest deviation from the mean pressure:", ", ".join(f"{part:.1e}" for part in uneven))
    figure = Figure(figsize=(7.2, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(x, before, "o-", ms=3, color="#c4451c", label="square edges")
    left.plot(x, np.full(len(x), FORCE / HALF), color="#1b4f8a", label="levelled")
    left.set_xlabel("x / half-width")
    left.set_ylabel("pressure")
    left.set_ylim(bottom=0.0)
    left.legend(frameon=False)
    right.plot(x, 1e3 * gap, "o", ms=3, color="#1b4f8a", label="profile found")
    right.plot(x, 1e3 * half_plane(x), "-", color="#333333", lw=1.0, label="half-plane, uniform pressure")
    right.set_xlabel("x / half-width")
    right.set_ylabel("gap, 1e-3")
    right.legend(frameon=False)
    figure.savefig(folder / "level_pressure.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/figures"))
