# SPDX-License-Identifier: BSD-3-Clause
"""Where shape matters: what the place of every node makes of the friction under the paper's cylinder.

    python examples/shape_arrows.py [FOLDER]

One solve, one way back, one pass over the cells and sides: an arrow a node, along which moving it raises the friction
force most. Inside the body places of nodes matter for the error of the mesh alone, and hardly. Writes shape_arrows.png
(default: docs/figures).
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array
from signorini.derivative.derivative import Derivative
from signorini.gallery.cylinder import zhu_cylinder


def gradient(refine: int = 2) -> tuple[sg.Model, Derivative, Array]:
    """The model, the derivative of the friction force, and it by the place of every node, (nodes, 2)."""
    model = zhu_cylinder(refine=refine)
    derivative = sg.solve(model, tape=True).derivative(sg.force("foundation", along=(1, 0)))
    return model, derivative, derivative.nodes


def main(folder: Path) -> None:
    """Differentiate, print and draw."""
    model, derivative, nodes = gradient()
    points = model.mesh.points
    outer = np.unique(np.concatenate([np.ravel(part) for part in model.mesh.boundaries.values()]))
    inner = np.setdiff1d(np.arange(len(points)), outer)
    print(f"friction force {derivative.value:.4g}")
    print(f"per length of a node: on the outline up to {np.linalg.norm(nodes[outer], axis=1).max():.3g}")
    print(f"inside up to {np.linalg.norm(nodes[inner], axis=1).max():.3g}")
    arc = model.mesh.nodes_of("arc")
    arc = arc[np.argsort(points[arc, 0])]
    outward = (points[arc] - [0.0, 8.0]) / np.linalg.norm(points[arc] - [0.0, 8.0], axis=1, keepdims=True)
    share = np.gradient(np.arctan2(points[arc, 0], 8.0 - points[arc, 1])) * 8.0
    figure = Figure(figsize=(7.2, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for cells in model.mesh.cells.values():
        corners = points[cells[:, [0, 1, 2, 3, 0] if cells.shape[1] > 3 else [0, 1, 2, 0]]]
        left.add_collection(LineCollection(list(corners), colors="#d5dae0", linewidths=0.5))
    longest = float(np.linalg.norm(nodes[outer], axis=1).max())
    left.quiver(
        *points.T, *nodes.T, color="#c4451c", angles="xy", scale_units="xy", scale=longest / 1.5, width=0.005, zorder=3
    )
    left.set_aspect("equal")
    left.set_xlim(-1.7, 4.3)
    left.set_ylim(-1.7, 4.3)
    left.set_xlabel("x")
    left.set_ylabel("y")
    right.axhline(0.0, color="#d5dae0", lw=0.8)
    right.plot(points[arc, 0], np.sum(nodes[arc] * outward, axis=1) / share, "o-", ms=3, color="#1b4f8a")
    right.set_xlabel("x along the arc")
    right.set_ylabel("change of the force, per area outwards")
    figure.savefig(folder / "shape_arrows.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/figures"))
