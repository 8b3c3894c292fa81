# SPDX-License-Identifier: BSD-3-Clause
"""Limit loads under a flat punch by every family of cells that may yield; writes a table of docs/plasticity.md.

    python -m benchmarks.footings [--dry]
    python -m benchmarks.footings --locked  # which motions keep every volume: of cells that lock, and do not

Prandtl's limit is (2 + pi) k. "proved": the mean pressure beyond which a mechanism proves flow on this mesh; "carried":
one that is certified; over the exact limit.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks import command, page
from signorini.arrays import Array
from signorini.engine.prepare import prepare
from signorini.gallery.yielding import PERFECT, SHEAR_STRENGTH
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.plasticity.volume import volume_rows
from signorini.reference.plasticity import punch_limit
from signorini.verify.footings import IN_SPACE, IN_THE_PLANE, ROUGH_IN_THE_PLANE

DOCUMENT = Path(__file__).parent.parent / "docs" / "plasticity.md"
HEAD = ("cells", "formulation", "punch", "cell at its edge", "cells in all", "unknowns", "proved", "carried")


def limits() -> list[tuple[object, ...]]:
    """Rows of the table."""
    exact, rows = punch_limit(SHEAR_STRENGTH), []
    for punched in (*IN_THE_PLANE, *ROUGH_IN_THE_PLANE, *IN_SPACE):
        model = punched.model(1.0)
        above, below = punched.limit()
        (body,) = model.bodies
        rows.append(
            (
                f"`{punched.cells}`",
                body.formulation,
                "rough" if punched.rough else "smooth",
                f"{punched.edge:g}",
                model.mesh.number_of_cells,
                model.mesh.points.size,
                f"{above / exact:.4f}",
                f"{below / exact:.4f}",
            )
        )
        print(*rows[-1], flush=True)
    return rows


def locked() -> list[tuple[object, ...]]:
    """Motions of a square or a cube, held below, that keep every volume which its cells ask for."""
    rows: list[tuple[object, ...]] = []
    for cells, sizes in (("triangle", (4, 8, 16)), ("tetra", (2, 4, 6))):
        for n in sizes:
            mesh = grid(cells, n)
            d, nodes = mesh.points.shape[1], mesh.cells[cells]
            corners = np.concatenate([np.ones((len(nodes), d + 1, 1)), mesh.points[nodes]], axis=2)
            gradients = np.linalg.inv(corners)[:, 1:].transpose(0, 2, 1)
            volumes = np.zeros((len(nodes), len(mesh.points), d))
            volumes[np.arange(len(nodes))[:, None], nodes] = gradients
            free = volumes[:, mesh.points[:, -1] > 0.0].reshape(len(nodes), -1)
            rows.append((cells, "", n, *kept(free)))
    for cells, kind, formulation, sizes in (
        ("quad", "axisymmetric", "incompatible", (2, 4, 8)),
        ("quad", "axisymmetric", "mean dilatation", (2, 4, 8)),
        ("hexahedron", "3d", "incompatible", (2, 3, 5)),
        ("hexahedron", "3d", "mean dilatation", (2, 3, 5)),
    ):
        for n in sizes:
            mesh = grid(cells, n)
            (name,) = mesh.bodies
            steel = Elastic(E=1000.0 * SHEAR_STRENGTH, nu=0.3, plastic=PERFECT)
            held = [Support("bottom", u=(0.0,) * mesh.points.shape[1])]
            prepared = prepare(Model(mesh, kind=kind, bodies=[Body(name, steel, formulation)], supports=held))
            assert prepared.yielding is not None
            volumes = volume_rows(prepared.yielding) @ prepared.constraints.transform
            rows.append((f"{cells}, {formulation}", kind, n, *kept(volumes.toarray())))
    return rows


def grid(cells: str, n: int) -> Mesh:
    """A square or a cube of n cells along an edge, beside an axis."""
    line = np.linspace(0.0, 1.0, n + 1)
    if cells in ("tetra", "hexahedron"):
        return box(x=1.0 + line, y=line, z=line, cells=cells)
    return rectangle(x=1.0 + line, y=line, cells=cells)


def kept(volumes: Array) -> tuple[int, int]:
    """Unknowns, and motions that keep volumes (rows, unknowns)."""
    return volumes.shape[1], volumes.shape[1] - int(np.linalg.matrix_rank(volumes, tol=1e-9))


def main() -> None:
    """Print the table, or write it into the page."""
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--locked", action="store_true", help="count motions that keep volumes")
    options = parser.parse_args()
    if options.locked:
        print(page.table(("cells", "kind", "along an edge", "unknowns", "that keep every volume"), locked()))
        return
    text = f"{page.table(HEAD, limits())}\n\nSizes over half the width of the punch, pressures over (2 + pi) k."
    command.publish(options, "plasticity footings", text, DOCUMENT)


if __name__ == "__main__":
    main()
