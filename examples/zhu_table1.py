# SPDX-License-Identifier: BSD-3-Clause
"""Table 1 of the paper: contact pressure of the cylinder for growing penalties, mu = 0.

Beside the paper's numbers stand the literal formulation (its M and q, Lemke's method, penalties in K_c) and the
compliance formulation (1 / E_n in series with the exact law). Where the literal one breaks, it says so.

    python examples/zhu_table1.py
"""

from __future__ import annotations

import numpy as np

from signorini import solve
from signorini.gallery.cylinder import HERTZ, E, zhu_cylinder
from signorini.paper import formulate, solve_literally
from signorini.prepare import prepare

X = np.arange(6) * 0.5
PAPER = {
    0: (33.0211, 32.5452, 30.9258, 28.0681, 23.7479, 17.4832),
    1: (36.3058, 35.8319, 33.9157, 30.3995, 24.6304, 14.2633),
    2: (36.6686, 36.2107, 34.2640, 30.6823, 24.6529, 13.0239),
    6: (36.7106, 36.2551, 34.3054, 30.7180, 24.6608, 12.8706),
    10: (36.7241, 36.3233, 34.2670, 30.7243, 24.6804, 12.9674),
    11: (36.8485, 36.3740, 34.4863, 30.7843, 24.8424, 13.4048),
    12: (37.5545, 36.9316, 35.5993, 30.4867, 25.8682, 21.1386),
    13: (43.2423, 41.6611, 44.2979, 22.2045, 47.9616, 7.1054),
    14: None,
}
"""Pressures of the paper by the power of ten of E_n / E; 1e14 gave no result."""


def row(label: str, pressure: np.ndarray | tuple[float, ...] | None, force: float | None = None) -> str:
    """Six pressures, the largest error against Hertz and the error of the force."""
    if pressure is None:
        return f"  {label:<12}" + "     no result"
    values = np.asarray(pressure)[:6]
    exact = HERTZ.pressure(X)
    error = 100.0 * (values / exact - 1.0)
    worst = error[np.argmax(np.abs(error))]
    balance = "" if force is None else f"{force / 78.0 - 1.0:12.1e}"
    return f"  {label:<12}" + "".join(f"{value:9.4f}" for value in values) + f"{worst:9.1f}{balance}"


def main() -> None:
    """Print the table."""
    prepared = prepare(zhu_cylinder(friction=0.0))
    print("Contact pressure at x, largest error against Hertz in %, error of the normal force (78)\n")
    print("  " + " " * 12 + "".join(f"{x:9.1f}" for x in X) + "  error %       force")
    print(row("Hertz", HERTZ.pressure(X)))
    for power, paper in PAPER.items():
        E_n = E * 10.0**power
        literal = solve_literally(formulate(prepared, E_n=E_n, E_tau=E_n))
        compliant = solve(zhu_cylinder(friction=0.0, compliance=1.0 / E_n)).contact("foundation")
        print(
            f"\nE_n = 1e{power} E" + (f"   literal: {literal.message}" if literal.message else "   literal: certified")
        )
        print(row("paper", paper))
        print(row("literal", literal.pressure, literal.normal_force[1]))
        print(row("compliance", compliant.pressure, compliant.normal_force[1]))
    exact = solve(zhu_cylinder(friction=0.0)).contact("foundation")
    print("\nE_n infinite: the exact law")
    print(row("compliance", exact.pressure, exact.normal_force[1]))


if __name__ == "__main__":
    main()
