# SPDX-License-Identifier: BSD-3-Clause
"""Figures 6 and 7 of the paper redrawn: contact pressure for several penalties, and pressure with friction.

    python examples/zhu_figures.py [FOLDER]

writes zhu_figure_6.png and zhu_figure_7.png (default folder: docs/figures).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from signorini import Step, solve
from signorini.gallery.cylinder import HERTZ, E, zhu_cylinder

FRICTION = 0.4
FINE = np.linspace(0.0, HERTZ.half_width, 400)


def new_axes(title: str) -> tuple[Figure, Axes]:
    """A figure with the labels that both share."""
    figure = Figure(figsize=(8.0, 5.0), dpi=140, layout="constrained")
    axes = figure.add_subplot(xlabel="x from the centre of contact (length)", ylabel="traction (force per area)")
    axes.set_title(title, loc="left", fontsize=11)
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def penalties() -> Figure:
    """Figure 6: frictionless pressure, 8 contact elements, growing penalties, against Hertz."""
    figure, axes = new_axes("Contact pressure, $\\mu = 0$, 76 quadrilaterals (the paper's figure 6)")
    axes.plot(FINE, HERTZ.pressure(FINE), color="black", lw=1.2, label="Hertz")
    shades = ("#9ecae1", "#4292c6", "#08519c")
    for power, marker, shade in zip((0, 1, 2), "v^D", shades, strict=True):
        found = solve(zhu_cylinder(friction=0.0, compliance=1.0 / (E * 10.0**power))).contact("foundation")
        label = f"$E_n = {'' if power == 0 else 10**power} E$"
        axes.plot(found.points[:, 0], found.pressure, marker=marker, ms=6, lw=0.8, color=shade, label=label)
    exact = solve(zhu_cylinder(friction=0.0)).contact("foundation")
    axes.plot(exact.points[:, 0], exact.pressure, "o", ms=9, mfc="none", color="#d94801", label="exact law")
    axes.legend(frameon=False)
    axes.set_xlim(-0.05, 4.05)
    axes.set_ylim(bottom=0.0)
    return figure


def friction() -> Figure:
    """Figure 7: pressure and frictional traction, one increment as in the paper and the exact history."""
    figure, axes = new_axes(f"Pressure and friction, $\\mu = {FRICTION}$ (the paper's figure 7, refined 4 times)")
    axes.plot(FINE, HERTZ.pressure(FINE), color="black", lw=1.0, ls=":", label="Hertz, $\\mu = 0$")
    for words, steps, colour, style in (
        ("one increment", [Step(increments=1)], "#4292c6", "--"),
        ("exact path", [Step(path="exact")], "#d94801", "-"),
    ):
        found = solve(zhu_cylinder(friction=FRICTION, refine=4, steps=steps)).contact("foundation")
        x = found.points[:, 0]
        axes.plot(x, found.pressure, style, color=colour, lw=1.6, label=f"pressure, {words}")
        axes.plot(x, np.abs(found.traction), style, color=colour, lw=1.6, marker="o", ms=3, label=f"friction, {words}")
        axes.plot(x, FRICTION * found.pressure, style, color=colour, lw=0.7, alpha=0.6)
        edge = x[found.status == "stick"].max()
        axes.axvline(edge, color=colour, lw=0.7, ls=style)
        axes.annotate(
            f"sticks | slips\n{words}",
            (edge, 22.0 if words == "one increment" else 27.0),
            color=colour,
            fontsize=8,
            ha="center",
            bbox={"fc": "white", "ec": "none", "pad": 1.5},
        )
    axes.annotate("thin: $\\mu p$", (0.45, FRICTION * 38.0), fontsize=9, xytext=(0, 6), textcoords="offset points")
    axes.legend(frameon=False, fontsize=8, loc="upper right", bbox_to_anchor=(1.0, 0.85))
    axes.set_xlim(-0.05, 4.05)
    axes.set_ylim(bottom=0.0)
    return figure


def main(folder: Path) -> None:
    """Draw both."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, figure in (("zhu_figure_6.png", penalties()), ("zhu_figure_7.png", friction())):
        figure.savefig(folder / name)
        print(f"wrote {folder / name}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs" / "figures")
