# SPDX-License-Identifier: BSD-3-Clause
"""Convergence of the paper's cylinder under refinement: energy, displacement, pressure, half-width, stick boundary.

The rate is the slope of log error against log edge, the errors taken against the finest mesh. Half-width and stick
boundary jump with the node that opens or slips; they are known to an edge.

    python examples/zhu_convergence.py
"""

from __future__ import annotations

import numpy as np

from signorini import solve
from signorini.gallery.cylinder import HERTZ, zhu_cylinder

REFINE = (1, 2, 4, 8, 16)


def measure(friction: float, refine: int) -> tuple[float, ...]:
    """Strain energy, approach of the cut's centre, p(0), half-width and stick half-width."""
    solution = solve(zhu_cylinder(friction=friction, refine=refine))
    contact = solution.contact("foundation")
    mesh = solution.model.mesh
    centre = int(np.argmax(mesh.points[:, 1] - 1e3 * np.abs(mesh.points[:, 0])))
    x = contact.points[:, 0]
    # the pressure's square is linear in x^2 near the edge (Hertz): its zero through the last two closed nodes
    last = np.nonzero(contact.pressure > 0)[0][-2:]
    p2, x2 = contact.pressure[last] ** 2, x[last] ** 2
    half_width = np.sqrt(x2[1] - p2[1] * (x2[1] - x2[0]) / (p2[1] - p2[0]))
    stick = x[contact.status == "stick"].max(initial=0.0)
    return (
        solution.last.strain_energy,
        -float(solution.last.displacement[centre, 1]),
        float(contact.pressure[0]),
        float(half_width),
        float(stick),
    )


def main() -> None:
    """Print a table for mu = 0 and mu = 0.4, one increment."""
    names = ("strain energy", "approach", "p(0)", "half-width", "stick to x")
    for friction in (0.0, 0.4):
        values = np.array([measure(friction, refine) for refine in REFINE])
        print(
            f"mu = {friction:g}, one increment, uniform traction on the cut (Hertz: p0 {HERTZ.peak_pressure:.4f}, "
            f"a {HERTZ.half_width:.4f})"
        )
        print(f"  {'edge':>8}" + "".join(f"{name:>16}" for name in names))
        for refine, line in zip(REFINE, values, strict=True):
            print(f"  {0.5 / refine:8.4f}" + "".join(f"{value:16.6f}" for value in line))
        for column in (1, 2):
            error = np.abs(values[:-1, column] - values[-1, column])
            rate = np.polyfit(np.log(1.0 / np.array(REFINE[:-1])), np.log(error), 1)[0]
            print(f"  rate of the {names[column]}: {rate:.2f}")
        print()


if __name__ == "__main__":
    main()
