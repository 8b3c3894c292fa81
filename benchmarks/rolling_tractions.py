# SPDX-License-Identifier: BSD-3-Clause
"""Tractions of a driven wheel beside Carter's, and of Bentall and Johnson's rollers, drawn for docs/sliding.md.

python -m benchmarks.rolling_tractions
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import signorini as sg
from signorini.gallery.sliding import driven_wheel, free_wheel, half_width
from signorini.plot.style import INK, PRESSURE, TRACTION

_PICTURE = Path(__file__).parent.parent / "docs" / "figures" / "rolling_tractions.png"
_RATIO, _FRICTION = 0.64, 0.3  # Carter's case of `signorini verify`
_ROLLERS = 0.05  # coefficient of friction of the rollers

Values = NDArray[np.float64]


def tractions(model: sg.Model, half: float) -> tuple[Values, Values]:
    """Places over the half-width, and tractions over the largest pressure, of the last state."""
    contact = sg.solve(model).steps[-1].contacts[0]
    force = contact.pressure * contact.area
    x = (contact.points[:, 0] - contact.points[:, 0] @ force / force.sum()) / half
    near = np.abs(x) < 1.3
    order = np.argsort(x[near])
    peak = 2.0 * force.sum() / (math.pi * half)
    return x[near][order], contact.traction[near][order] / peak


def carter(x: Values, leads: float) -> Values:
    """Carter's traction over friction times the largest pressure; ``leads``: the sign of x where the contact leads."""
    sticks = math.sqrt(1.0 - _RATIO)
    moved = (leads * x - (1.0 - sticks)) / sticks
    whole, taken = (np.sqrt(np.maximum(1.0 - y**2, 0.0)) for y in (x, moved))
    return np.asarray(whole - sticks * taken)


def main() -> None:
    """Draw the picture."""
    import matplotlib as mpl

    mpl.use("agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained")
    half = half_width(10.0, 100.0, 200.0 / (1.0 - 0.499**2))
    x, q = tractions(driven_wheel(ratio=_RATIO, ways=(4.0, 4.0), across=8, friction=_FRICTION), half)
    q = q / _FRICTION
    fine = np.linspace(-1.0, 1.0, 801)
    sign = math.copysign(1.0, float(q.sum()))
    leads = -math.copysign(1.0, float(x @ (sign * q)))
    left.plot(fine, np.sqrt(1.0 - fine**2), color=INK, lw=0.8, ls="--", label="sliding")
    left.plot(fine, carter(fine, leads), color=TRACTION, label="Carter")
    left.plot(x, sign * q, "o", color=PRESSURE, ms=4, label="8 elements in a half-width")
    left.set(title="Driven wheel, F = 0.64 µP", xlabel="place over half-width", ylabel="traction over µ p$_0$")
    x, q = tractions(free_wheel(friction=_ROLLERS, ways=(3.0, 1.0), across=6), 1.0)
    for way in (1.0, -1.0):
        right.plot(fine, way * np.sqrt(1.0 - fine**2), color=INK, lw=0.8, ls="--", label="sliding" if way > 0 else None)
    right.plot(x, q / _ROLLERS, "o-", color=PRESSURE, ms=4, lw=1.0, label="6 quadratic cells in a half-width")
    right.set(title="Aluminium on steel, µ = 0.05, rolls freely", xlabel="place over half-width")
    left.legend(frameon=False, fontsize=8)
    right.legend(frameon=False, fontsize=8, loc="upper right")
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(_PICTURE, dpi=110)


if __name__ == "__main__":
    main()
