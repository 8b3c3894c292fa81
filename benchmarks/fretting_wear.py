# SPDX-License-Identifier: BSD-3-Clause
"""McColl, Ding and Leen's cylinder on a flat, 18,000 cycles of fretting wear: one by one, in explicit jumps, in blocks.

python -m benchmarks.fretting_wear every every.json [cycles [spacing]]     (or jumps, blocks, auto)
python -m benchmarks.fretting_wear page every.json jumps.json blocks.json auto.json
                                                                           (writes docs/wear.md and its picture)
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import page
from signorini.gallery.wearing import FORCE, FRICTION, WEAR, fretting, rubbed_cylinder

CYCLES, STROKE, SPACING = 18_000, 0.025, 0.01
SHOWN = (1000, 5000, 10_000, 18_000)
_HEAD = (
    "cycles",
    "flat, um",
    "published, um",
    "difference, %",
    "error of jumps of 100, %",
    "of blocks of 100, %",
    "of automatic blocks, %",
    "worn area, 1e-3 mm2",
)
WAYS = ("every", "jumps", "blocks", "auto")
_NAMES = {"every": "every cycle", "jumps": "jumps of 100", "blocks": "blocks of 100", "auto": "automatic blocks"}
_TOLERANCE = 0.02  # of automatic blocks: of what a block wears
_BLOCKS: dict[str, dict[str, Any]] = {"blocks": {"block": 100}, "auto": {"block": "auto", "tolerance": _TOLERANCE}}


def model(way: str, cycles: int, spacing: float) -> tuple[sg.Model, int]:
    """The model of a way, and how many cycles one of its cycles stands for.

    Parameters
    ----------
    way : "every"; "jumps" of 100: explicit, as wear a hundred times as fast; implicit "blocks" of 100; "auto"
    cycles : in all
    spacing : of nodes in the contact, mm
    """
    jump = 100 if way == "jumps" else 1
    wear = sg.Wear(jump * WEAR.nonmortar, mortar=jump * WEAR.mortar)
    at = tuple(cycle / cycles for cycle in SHOWN if cycle <= cycles)
    steps = fretting(cycles // jump, at=at, **_BLOCKS.get(way, {}))
    return rubbed_cylinder(steps, wear=wear, spacing=spacing, stroke=STROKE, sliding="finite"), jump


def measure(way: str, cycles: int = CYCLES, spacing: float = SPACING) -> dict[str, Any]:
    """Follow all cycles; profiles and pressures where they are shown, CPU seconds, and the certificate.

    Parameters
    ----------
    way, cycles, spacing : as of `model`
    """
    posed, jump = model(way, cycles, spacing)
    begin = time.process_time()
    solution = sg.solve(posed)
    seconds = time.process_time() - begin
    rub = solution.last
    shown: dict[str, Any] = {}
    for instant in rub.instants:
        contact = instant.contacts[0]
        cycle = round((instant.load_factor - 2.0) * cycles)
        if instant.what != "wear" or contact.wear is None or cycle not in (1, 100, *SHOWN):
            continue
        wear, order = contact.wear, np.argsort(contact.points[:, 0])
        flat = wear.on_mortar
        along = np.argsort(wear.points[flat, 0])
        shown[str(cycle)] = {
            "x": wear.points[flat, 0][along].tolist(),
            "flat": wear.depths[flat][along].tolist(),
            "pad_x": contact.points[order, 0].tolist(),
            "pad": wear.depth[order].tolist(),
            "pressure": contact.pressure[order].tolist(),
            "volume": list(wear.volume),
        }
    cut = rub.cycles[-1]
    return {
        "way": way,
        "cycles": cycles,
        "spacing": spacing,
        "nodes": len(posed.mesh.points),
        "seconds": seconds,
        "shown": shown,
        "slid": cut.sliding,
        "rubbed": float(sum(step.dissipation for step in solution.steps)) / FRICTION * jump,
        "volume": float(solution.end.state.wear.volume.sum()),
        "loose": float(solution.end.state.wear.loose.sum()),
        "residual": max(step.certificate.worst for step in solution.steps),
        "defect": abs(rub.energy_defect) / rub.work,
        "notes": [note for note in rub.notes if note.startswith("sides wore in")],
        "kept": [cycle.number * jump for cycle in rub.cycles],
    }


PUBLISHED = {1000: 0.3784, 5000: 1.1311, 10_000: 1.8145, 18_000: 2.7130}
"""Depths of the flat, um, of LevelSetWear (level sets, 180 jumps of 100 cycles, 20 573 CPU s for 9882 nodes)."""

_DOCS = Path(__file__).parent.parent / "docs"


def write_page(found: dict[str, dict[str, Any]]) -> None:
    """Table and picture of all ways into docs/wear.md.

    Parameters
    ----------
    found : what `measure` found, by its way
    """
    every, rows = found["every"], []
    for cycle, published in PUBLISHED.items():
        one, *others = (1e3 * max(found[way]["shown"][str(cycle)]["flat"]) for way in WAYS)
        volume = every["shown"][str(cycle)]["volume"]
        rows.append((
            f"{cycle}", f"{one:.4f}", f"{published:.4f}", f"{100.0 * (one / published - 1.0):+.2f}",
            *(f"{100.0 * (other / one - 1.0):+.2f}" for other in others), f"{1e3 * max(volume):.5f}",
        ))  # fmt: skip
    nominal = WEAR.mortar * every["cycles"] * 4.0 * STROKE * FORCE
    lost = max(every["shown"][str(CYCLES)]["volume"]) / nominal
    worst, defect = (max(each[key] for each in found.values()) for key in ("residual", "defect"))
    costs = "; ".join(f"{_NAMES[way]}: {found[way]['seconds']:.0f}" for way in WAYS)
    notes = "; ".join(f"{_NAMES[way]}: {note}" for way in ("blocks", "auto") for note in found[way]["notes"])
    text = (
        f"{page.table(_HEAD, rows)}\n\nCPU seconds: {costs}; {every['nodes']} nodes. Worst certificate of the steps "
        f"{worst:.1e}, energy defect over work {defect:.0e}. {notes.capitalize()}. The flat has lost {lost:.3f} of "
        "k P 4 s N; the rest of the stroke is that of the bodies, which strain. Published: level sets, 180 jumps of "
        "100, 20 573 CPU s."
    )
    page.write("fretting wear", text, _DOCS / "wear.md")
    _draw(found, _DOCS / "figures" / "fretting_wear.png")


def _draw(found: dict[str, dict[str, Any]], path: Path) -> None:
    """Profiles, pressures, depth over the cycles and what jumps and blocks cost."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    every = found["every"]
    figure, ((profile, pressure), (depth, cost)) = plt.subplots(2, 2, figsize=(11.0, 7.5), layout="constrained")
    for shade, cycle in zip(np.linspace(0.85, 0.15, len(SHOWN)), SHOWN, strict=True):
        shown, color = every["shown"][str(cycle)], plt.get_cmap("viridis")(shade)
        profile.plot(shown["x"], -1e3 * np.array(shown["flat"]), color=color, label=f"{cycle} cycles")
        pressure.plot(shown["pad_x"], shown["pressure"], color=color, label=f"{cycle} cycles")
    profile.set(xlabel="x, mm", ylabel="height, µm", title="profile of the flat")
    pressure.set(xlabel="x, mm", ylabel="pressure, MPa", title="pressure where the stroke turns")
    cycles = [cycle for cycle in map(int, every["shown"]) if cycle > 1]
    depths = {way: [1e3 * max(found[way]["shown"][str(cycle)]["flat"]) for cycle in cycles] for way in WAYS}
    depth.plot(cycles, depths["every"], "o-", label="every cycle")
    depth.plot(list(PUBLISHED), list(PUBLISHED.values()), "kx", ms=9, label="level sets (published)")
    depth.set(xlabel="cycles", ylabel="depth of the flat, µm", title="deepest place")
    for way, line in (("jumps", "s-"), ("blocks", "o-"), ("auto", "^--")):
        errors = [abs(other / one - 1.0) for one, other in zip(depths["every"], depths[way], strict=True)]
        cost.loglog(cycles, errors, line, label=_NAMES[way])
    cost.set(xlabel="cycles", ylabel="relative error of the depth", title="what jumps and blocks of cycles cost")
    for axes in (profile, pressure, depth, cost):
        axes.legend(frameon=False)
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Measure a way into a file, or write the page from two of them."""
    if sys.argv[1] == "page":
        write_page({found["way"]: found for found in (json.loads(Path(name).read_text()) for name in sys.argv[2:])})
        return
    way, path = sys.argv[1], Path(sys.argv[2])
    cycles = int(sys.argv[3]) if len(sys.argv) > 3 else CYCLES
    spacing = float(sys.argv[4]) if len(sys.argv) > 4 else SPACING
    path.write_text(json.dumps(measure(way, cycles, spacing)))


if __name__ == "__main__":
    main()
