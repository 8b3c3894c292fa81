# SPDX-License-Identifier: BSD-3-Clause
"""Which dimension of a press fit matters: the pressure by every radius, the overlap and the moduli, from one solve.

    python examples/press_fit_tolerances.py [FOLDER]

A hollow shaft in a hub. Every dimension is a motion of the nodes; its derivative times its tolerance is its share of
the scatter of the pressure, beside Lame's closed form. Writes press_fit_tolerances.png (default: docs/figures).
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array
from signorini.gallery.press_fit import press_fit
from signorini.reference.lame import press_fit_pressure

INNER, FIT, OUTER, OVERLAP = 1.0, 2.0, 3.0, 0.01
SHAFT, HUB = 2000.0, 1000.0  # moduli; Poisson's ratio of both is 0.3
TOLERANCES = {  # standard deviations
    "inner radius": 0.01,
    "radius of the fit": 0.01,
    "outer radius": 0.01,
    "overlap": 0.0005,
    "modulus of the shaft": 40.0,
    "modulus of the hub": 20.0,
}


def lame(inner: float, fit: float, outer: float, overlap: float, shaft: float, hub: float) -> float:
    """Pressure of a fit in plane stress, closed form."""
    return press_fit_pressure(
        inner=inner, interface=fit, outer=outer, interference=overlap, inner_body=(shaft, 0.3), outer_body=(hub, 0.3)
    )


def dimensions(points: Array) -> dict[str, Array]:
    """Motions of the nodes, (nodes, 2) each: one radius grows by 1, the others stay, nodes in between follow."""
    radius = np.linalg.norm(points, axis=1)
    outward = points / radius[:, None]
    at = {"inner radius": INNER, "radius of the fit": FIT, "outer radius": OUTER}
    return {
        name: np.interp(radius, [INNER, FIT, OUTER], [float(place == own) for place in at.values()])[:, None] * outward
        for name, own in at.items()
    }


def derivatives(cells: int = 8) -> tuple[float, dict[str, float]]:
    """The mean pressure of the fit, and what it changes by per unit of everything, from one solve."""
    model = press_fit(n_radial=cells, n_angular=3 * cells, interference=OVERLAP, cells="quad8")
    derivative = sg.solve(model, tape=True).derivative(sg.pressure("fit").mean())
    found = {name: derivative.shape(motion) for name, motion in dimensions(model.mesh.points).items()}
    found["overlap"] = derivative.interference["fit"]
    found["modulus of the shaft"], found["modulus of the hub"] = derivative.E["shaft"], derivative.E["hub"]
    return derivative.value, found


def closed() -> dict[str, float]:
    """The same of Lame's closed form, by differences."""
    given = np.array([INNER, FIT, OUTER, OVERLAP, SHAFT, HUB])
    steps = 1e-6 * np.diag(given)
    return {
        name: (lame(*(given + step)) - lame(*(given - step))) / (2.0 * step.max())
        for name, step in zip(TOLERANCES, steps, strict=True)
    }


def main(folder: Path) -> None:
    """Print and draw what every tolerance makes of the pressure."""
    pressure, found = derivatives()
    exact = closed()
    scatter = {name: abs(found[name]) * TOLERANCES[name] for name in found}
    whole = float(np.sqrt(sum(part**2 for part in scatter.values())))
    print(f"pressure {pressure:.5f} +- {whole:.5f}; Lame {lame(INNER, FIT, OUTER, OVERLAP, SHAFT, HUB):.5f}")
    for name, part in sorted(scatter.items(), key=lambda item: -item[1]):
        share = part**2 / whole**2
        print(f"{name:22} {found[name]:+.6g} a unit (Lame {exact[name]:+.6g}): {share:6.1%} of the variance")
    figure = Figure(figsize=(6.4, 3.0), layout="constrained")
    axes = figure.subplots()
    names = sorted(scatter, key=lambda name: scatter[name])
    axes.barh(names, [100.0 * scatter[name] / pressure for name in names], color="#1b4f8a")
    axes.set_xlabel("standard deviation of the pressure, per cent of it")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(folder / "press_fit_tolerances.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/figures"))
