# SPDX-License-Identifier: BSD-3-Clause
"""The picture of the README: the paper's cylinder, von Mises stress and contact tractions, mu = 0.4, exact path.

    python examples/readme_picture.py [FILE]

writes docs/figures/cylinder.png by default.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from signorini import Solution, Step, solve
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.cylinder import HERTZ, zhu_cylinder

FRICTION = 0.4


def draw_body(axes: Axes, solution: Solution) -> None:
    """Von Mises stress on the deformed cylinder and its mirror image, on the foundation."""
    mesh, moved = solution.model.mesh, solution.last.displacement
    (stress,) = body_stresses(make_space(mesh), solution.model, moved)
    x, y = (mesh.points + moved).T
    quads = mesh.cells["quad"]
    triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    levels = np.arange(0.0, stress.von_mises.max() + 1.0)
    for side in (1.0, -1.0):
        filled = axes.tricontourf(
            Triangulation(side * x, y, triangles), stress.von_mises, levels=levels, cmap="viridis"
        )
    axes.axhspan(-1.1, 0.0, color="0.85", hatch="///", ec="0.7", lw=0.0)
    axes.axhline(0.0, color="0.3", lw=1.0)
    axes.set_aspect("equal")
    axes.set_xlim(-9.0, 9.0)
    axes.set_ylim(-1.1, 8.0)
    axes.set_axis_off()
    axes.set_title("von Mises stress, true displacements", fontsize=10)
    axes.figure.colorbar(filled, ax=axes, orientation="horizontal", shrink=0.7, pad=0.02, ticks=levels[::5])


def draw_tractions(axes: Axes, solution: Solution) -> None:
    """Pressure and friction over x, mirrored, with the states of the pairs."""
    contact = solution.contact("foundation")
    x = contact.points[:, 0]
    both = np.concatenate([-x[:0:-1], x])
    pressure = np.concatenate([contact.pressure[:0:-1], contact.pressure])
    traction = np.concatenate([-contact.traction[:0:-1], contact.traction])
    stick, closed = x[contact.status == "stick"].max(), x[contact.closed].max()
    axes.axvspan(-stick, stick, color="#d6e6f4", lw=0, label="sticks")
    for side in (1.0, -1.0):
        axes.axvspan(side * stick, side * closed, color="#fbd7b0", lw=0, label="slips" if side > 0 else None)
    fine = np.linspace(-HERTZ.half_width, HERTZ.half_width, 400)
    axes.plot(fine, HERTZ.pressure(fine), ":", color="0.2", lw=1.2, label="Hertz, no friction")
    axes.plot(both, pressure, color="#08519c", lw=2.0, label="pressure")
    axes.plot(both, FRICTION * pressure, "--", color="#d94801", lw=0.8, label=r"$\pm\mu p$")
    axes.plot(both, -FRICTION * pressure, "--", color="#d94801", lw=0.8)
    axes.plot(both, traction, color="#d94801", lw=2.0, label="friction")
    axes.axhline(0.0, color="0.3", lw=0.8)
    axes.set_xlim(-3.6, 3.6)
    axes.set_xlabel("x")
    axes.set_title("contact tractions", fontsize=10)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=6)


def main(file: Path) -> None:
    """Solve and draw."""
    solution = solve(zhu_cylinder(friction=FRICTION, refine=8, steps=[Step(name="press")]))
    figure = Figure(figsize=(11.0, 4.3), dpi=130, layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    draw_body(left, solution)
    draw_tractions(right, solution)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file)
    print(f"wrote {file}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs" / "figures" / "cylinder.png")
