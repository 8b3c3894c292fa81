# SPDX-License-Identifier: BSD-3-Clause
"""Fretting as it is usually drawn: tractions, slip amplitude, hysteresis loop, dissipation; and the path as a film.

    python examples/fretting.py [FOLDER]

Solves ``fretting.toml`` beside it: a cylinder pressed on a flat specimen, a tangential force and a bulk stress in
phase, three cycles, from event to event. Writes fretting.png and fretting.gif (default: docs/figures).
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array
from signorini.solution.results import ContactResult, StepResult

INK, PRESSURE = "#333333", "#1b4f8a"
PHASES = (("#8a8a86", "back at zero"), ("#2f8f5b", "pulled"), ("#b9b9b3", "zero again"), ("#c4451c", "pushed"))
FRICTION = 0.6


def dress(axes: Axes, title: str, x: str, y: str) -> None:
    """Labels, thin spines, a light grid."""
    axes.set_title(title, loc="left", fontsize=10.5, color=INK)
    axes.set_xlabel(x, fontsize=9.5, color=INK)
    axes.set_ylabel(y, fontsize=9.5, color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.axhline(0.0, color=INK, lw=0.7)
    axes.grid(color="#e2e2e2", lw=0.6)
    axes.tick_params(labelsize=9)
    axes.set_axisbelow(True)


def tractions(axes: Axes, fretting: StepResult) -> None:
    """Pressure and friction at the kinks of the last cycle."""
    kinks = [instant for instant in fretting.instants if instant.what == "segment"][-4:]
    for instant, (colour, words) in zip(kinks, PHASES, strict=True):
        contact = instant.contacts[0]
        x, order = sorted_x(contact)
        axes.plot(x, contact.traction[order], color=colour, lw=1.7, label=f"q, {words}")
    bound = FRICTION * contact.pressure[order]
    axes.plot(x, contact.pressure[order], color=PRESSURE, lw=2.0, label="pressure p")
    axes.plot(x, bound, "--", color=PRESSURE, lw=0.9, label=rf"$\pm\mu p$, $\mu$ = {FRICTION:g}")
    axes.plot(x, -bound, "--", color=PRESSURE, lw=0.9)
    axes.set_xlim(-1.35, 1.35)
    axes.set_ylim(-300, 560)
    axes.legend(fontsize=8, frameon=False, ncols=3, loc="upper center")
    dress(axes, "a  pressure and friction over the last cycle", "x, mm", "MPa")


def slip(axes: Axes, fretting: StepResult) -> None:
    """Half the range of slip, and what a cycle dissipates where."""
    contact = fretting.contacts[0]
    x, order = sorted_x(contact)
    amplitude = 0.5e3 * contact.slip_range[order]
    axes.fill_between(x, amplitude, color="#dd8a1f", alpha=0.25, lw=0)
    (line,) = axes.plot(x, amplitude, color="#dd8a1f", lw=1.8, label="slip amplitude")
    axes.set_xlim(-1.35, 1.35)
    axes.set_ylim(bottom=0.0)
    dress(axes, "b  slip amplitude and work of friction", "x, mm", "slip amplitude, micrometres")
    beside = axes.twinx()
    worn = 1e3 * contact.worn[order] / len(fretting.cycles)
    (work,) = beside.plot(x, worn, color="#7b3294", lw=1.5, ls="-.", label="dissipation a cycle")
    beside.set_ylabel("dissipation a cycle, microjoules / mm$^2$", fontsize=9.5, color=INK)
    beside.set_ylim(bottom=0.0)
    beside.spines["top"].set_visible(False)
    axes.legend(handles=[line, work], fontsize=8.5, frameon=False, loc="upper center")


def loop(axes: Axes, solution: sg.Solution) -> None:
    """Tangential force against what the pad moves beyond a contact that would stick; all cycles."""
    cut = solution.model.mesh.nodes_of("pad.cut")[0]
    rest = solution.steps[0].displacement[cut, 0]
    ways = []
    for step in solution.steps[1:]:
        force = [-float(instant.contacts[0].tangential_force[0]) for instant in step.instants]
        moved = [1e3 * float(instant.displacement[cut, 0] - rest) for instant in step.instants]
        ways.append((np.array(moved), np.array(force)))
    (moved, force), (later, forces) = ways
    sticking = moved[0] / force[0]  # before its first event the contact slips nowhere that counts
    ways = [(np.append(0.0, moved - sticking * force), np.append(0.0, force)), (later - sticking * forces, forces)]
    for (x, y), colour, words in zip(ways, ("#8a8a86", "#c4451c"), ("first push", "cycles"), strict=True):
        axes.plot(x, y, ".-", color=colour, lw=1.6, ms=4, label=words)
    axes.axvline(0.0, color=INK, lw=0.7)
    words = "displacement of the pad beyond that of a sticking contact, micrometres"
    dress(axes, "c  hysteresis; dots are events", words, "friction force, N / mm")
    axes.legend(fontsize=8.5, frameon=False, loc="upper left")


def energy(axes: Axes, fretting: StepResult) -> None:
    """Dissipation along the cycles, and the work that the loads leave in each."""
    count = len(fretting.cycles)
    cycles = (np.array([instant.load_factor for instant in fretting.instants]) - fretting.load_factor + 1.0) * count
    dissipated = [1e3 * instant.contacts[0].dissipation for instant in fretting.instants]
    axes.plot([0.0, *cycles], [0.0, *dissipated], color="#7b3294", lw=1.8, label="dissipation")
    work = 1e3 * np.cumsum([0.0, *(cycle.work for cycle in fretting.cycles)])
    axes.plot(range(count + 1), work, "o", color=PRESSURE, ms=7, mfc="none", label="work of the loads, whole cycles")
    axes.set_xlim(0.0, 1.02 * count)
    last = 1e3 * fretting.cycles[-1].dissipation
    dress(axes, f"d  energy: {last:.4g} microjoules per mm and cycle", "cycles", "microjoules / mm")
    axes.legend(fontsize=8.5, frameon=False, loc="upper left")


def sorted_x(contact: ContactResult) -> tuple[Array, Array]:
    """Coordinates in order, and the order."""
    order = np.argsort(contact.points[:, 0])
    return contact.points[order, 0], order


def main(folder: Path) -> None:
    """Solve, say what the cycles do, draw."""
    folder.mkdir(parents=True, exist_ok=True)
    model = sg.read(Path(__file__).with_name("fretting.toml"))
    steps = [replace(step, at="events") for step in model.steps]
    solution = sg.solve(replace(model, steps=steps))
    print(solution)
    figure = Figure(figsize=(11.0, 8.2), dpi=130, layout="constrained")
    panels = figure.subplots(2, 2)
    tractions(panels[0, 0], solution.last)
    slip(panels[0, 1], solution.last)
    loop(panels[1, 0], solution)
    energy(panels[1, 1], solution.last)
    figure.suptitle(model.title, fontsize=12.5, color=INK)
    figure.savefig(folder / "fretting.png")
    solution.animate(folder / "fretting.gif")
    for name in ("fretting.png", "fretting.gif"):
        print(f"wrote {folder / name}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs" / "figures")
