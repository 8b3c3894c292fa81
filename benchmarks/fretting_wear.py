# SPDX-License-Identifier: BSD-3-Clause
"""McColl, Ding and Leen's cylinder on a flat, 18,000 cycles of fretting wear: one by one, or in explicit jumps.

python -m benchmarks.fretting_wear every out.json [cycles [spacing]]     (or jumps)
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import signorini as sg
from signorini.gallery.wearing import FRICTION, WEAR, fretting, rubbed_cylinder

CYCLES, STROKE, SPACING = 18_000, 0.025, 0.01
SHOWN = (1000, 5000, 10_000, 18_000)


def model(way: str, cycles: int, spacing: float) -> tuple[sg.Model, int]:
    """The model of a way, and how many cycles one of its cycles stands for.

    Parameters
    ----------
    way : "every", or "jumps" of 100: explicit, as wear a hundred times as fast
    cycles : in all
    spacing : of nodes in the contact, mm
    """
    jump = 100 if way == "jumps" else 1
    wear = sg.Wear(jump * WEAR.nonmortar, mortar=jump * WEAR.mortar)
    at = tuple(cycle / cycles for cycle in SHOWN if cycle <= cycles)
    steps = fretting(cycles // jump, at=at)
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
        "kept": [cycle.number * jump for cycle in rub.cycles],
    }


def main() -> None:
    """Measure a way into a file."""
    way, path = sys.argv[1], Path(sys.argv[2])
    cycles = int(sys.argv[3]) if len(sys.argv) > 3 else CYCLES
    spacing = float(sys.argv[4]) if len(sys.argv) > 4 else SPACING
    path.write_text(json.dumps(measure(way, cycles, spacing)))


if __name__ == "__main__":
    main()
