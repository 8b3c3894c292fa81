# SPDX-License-Identifier: BSD-3-Clause
"""A hollow sphere of steel and of rubber in all formulations: the table of docs/elements_and_loads.md.

python -m benchmarks.nearly_incompressible
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.page import table, write
from signorini.api import solve
from signorini.errors import InputError
from signorini.meshing.plane import Cells, annulus
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.reference.lame import hollow_sphere

PAGE = Path(__file__).parent.parent / "docs" / "elements_and_loads.md"
RATIOS = (0.3, 0.45, 0.49, 0.49999)
CASES: tuple[tuple[Cells, str], ...] = (
    ("triangle", "standard"),
    ("quad", "standard"),
    ("quad", "incompatible"),
    ("quad", "mean dilatation"),
    ("triangle6", "standard"),
    ("triangle6", "mean dilatation"),
    ("quad8", "standard"),
    ("quad8", "mean dilatation"),
    ("quad9", "mean dilatation"),
)


def wall(cells: Cells, *, bent: bool) -> Mesh:
    """A meridian above the equator, radii 1 and 2; bent: nodes inside it moved along the radius."""
    n = 16 if cells in ("quad", "triangle") else 8
    mesh = annulus(inner=1.0, outer=2.0, n_radial=n, n_angular=2 * n, angle=90.0, cells=cells)
    r, angle = np.linalg.norm(mesh.points, axis=1), np.arctan2(mesh.points[:, 1], mesh.points[:, 0])
    moved = 0.05 * np.sin(np.pi * (r - 1.0)) * np.sin(5.0 * r + 6.0 * angle)
    return replace(mesh, points=mesh.points * (1.0 + moved / r)[:, None]) if bent else mesh


def errors(mesh: Mesh, nu: float, formulation: str) -> str:
    """Of displacement and radial stress, or that it is refused."""
    model = Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("ring", Elastic(E=200.0, nu=nu), formulation)],  # type: ignore[arg-type]
        supports=[Support("start", u=(None, 0.0))],
        loads=[Load("inner", pressure=3.0)],
    )
    try:
        solution = solve(model)
    except InputError:
        return "refused"
    stress = solution.stress("ring")
    x = mesh.points[stress.nodes]
    r = np.linalg.norm(x, axis=1)
    along = x / r[:, None]
    u, radial, _ = hollow_sphere(r, inner=1.0, outer=2.0, pressure=3.0, E=200.0, nu=nu)
    moved = np.sum(solution.last.displacement[stress.nodes] * along, axis=1)
    s = stress.stress
    found = s[:, 0] * along[:, 0] ** 2 + s[:, 1] * along[:, 1] ** 2 + 2.0 * s[:, 3] * along[:, 0] * along[:, 1]
    middle = (r > 1.25) & (r < 1.75)
    return f"{100 * np.abs(moved / u - 1.0).max():.2f}, {100 * np.abs(found - radial)[middle].max() / 3.0:.1f} %"


def main() -> None:
    """Measure and write."""
    rows = [
        (cells, formulation, words, *(errors(wall(cells, bent=words == "bent"), nu, formulation) for nu in RATIOS))
        for cells, formulation in CASES
        for words in ("sectors", "bent")
    ]
    text = table(("cells", "formulation", "their shape", *(f"nu = {nu:g}" for nu in RATIOS)), rows)
    print(text)
    write("locking", text, PAGE)


if __name__ == "__main__":
    main()
