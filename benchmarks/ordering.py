# SPDX-License-Identifier: BSD-3-Clause
"""The order of elimination by cuts across the mesh beside METIS: work and CPU seconds; writes docs/performance.md.

python -m benchmarks.ordering [--dry]     (with gmsh also for unstructured meshes)
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import skfem

from benchmarks import command, page
from benchmarks.assembly import cells_of, grid
from signorini.fem.assembly import stiffness
from signorini.gallery.cylinder import zhu_cylinder
from signorini.linalg.multifrontal import factorise
from signorini.linalg.ordering import nested_dissection
from signorini.linalg.plan import analyse
from signorini.linalg.system import System, checked_system, node_graph

HEAD = ("mesh", "unknowns", "Gflop: METIS", "cuts", "order s: METIS", "cuts", "factorisation s: METIS", "cuts")
REPEATS = 3


def meshes() -> Iterator[tuple[str, Any, Any]]:
    """Name, mesh and element."""
    quads = zhu_cylinder(refine=36).mesh
    yield "cylinder, quadrilaterals", skfem.MeshQuad(quads.points.T, quads.cells["quad"].T), skfem.ElementQuad1()
    yield "square, triangles", skfem.MeshTri.init_tensor(*grid(300, 300)), skfem.ElementTriP1()
    yield "cube, hexahedra", skfem.MeshHex.init_tensor(*grid(30, 30, 30)), skfem.ElementHex1()
    if importlib.util.find_spec("gmsh"):
        yield "plate with holes, unstructured triangles", skfem.MeshTri(*plate()), skfem.ElementTriP1()
        yield "block with holes, unstructured tetrahedra", skfem.MeshTet(*block()), skfem.ElementTetP1()


def plate() -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a plate with a round, an oval and a square hole."""

    def shape(occ: Any) -> None:
        holes = [
            occ.addDisk(1, 1, 0, 0.5, 0.5),
            occ.addDisk(2.5, 0.7, 0, 0.3, 0.2),
            occ.addRectangle(3, 1.2, 0, 0.7, 0.8),
        ]
        occ.cut([(2, occ.addRectangle(0, 0, 0, 4, 2))], [(2, hole) for hole in holes])

    return gmsh_mesh(shape, 2, size=0.0095)


def block() -> tuple[np.ndarray, np.ndarray]:
    """Points and tetrahedra of a block with a bore and a dent."""

    def shape(occ: Any) -> None:
        holes = [occ.addCylinder(0.5, -0.1, 0.5, 0, 1.2, 0, 0.25), occ.addSphere(1.4, 0.5, 1, 0.4)]
        occ.cut([(3, occ.addBox(0, 0, 0, 2, 1, 1))], [(3, hole) for hole in holes])

    return gmsh_mesh(shape, 3, size=0.055)


def gmsh_mesh(shape: Callable[[Any], None], dimension: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Mesh a shape by gmsh."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    shape(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(dimension)
    tags, points, _ = gmsh.model.mesh.getNodes()
    _, _, cells = gmsh.model.mesh.getElements(dimension)
    gmsh.finalize()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    used, cell = np.unique(row[cells[0].astype(np.int64)], return_inverse=True)
    return points.reshape(-1, 3)[used, :dimension].T, cell.reshape(-1, dimension + 1).T


def system(mesh: Any, element: Any) -> System:
    """Stiffness with the highest nodes held; no interface."""
    points, cells, law = cells_of(mesh, element)
    d = points.shape[1]
    free = np.flatnonzero(np.repeat(points[:, -1] < points[:, -1].max() - 1e-9, d))
    return checked_system(
        stiffness(points, cells, law)[free][:, free], [], np.repeat(np.arange(len(points)), d)[free], points
    )


def least(function: Callable[[], Any]) -> float:
    """CPU seconds, the least of some repeats."""
    return min(command.cpu(function)[0] for _ in range(REPEATS))


def rows() -> Iterator[list[object]]:
    for name, mesh, element in meshes():
        by_cuts = system(mesh, element)
        each = (replace(by_cuts, points=None), by_cuts)
        work = [f"{analyse(one).flops / 1e9:.1f}" for one in each]
        order = [page.seconds(least(lambda one=one: nested_dissection(node_graph(one)))) for one in each]
        whole = [page.seconds(least(lambda one=one: factorise(one))) for one in each]
        yield [name, by_cuts.n, *work, *order, *whole]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--here", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if not options.here:
        environment = {**os.environ, **page.ONE_THREAD, **page.KEEP_MEMORY}
        subprocess.run(
            [sys.executable, "-m", "benchmarks.ordering", "--here", *sys.argv[1:]], check=True, env=environment
        )
        return
    note = f"CPU seconds, one thread, {page.machine()}; a factorisation includes its order."
    text = f"{page.table(HEAD, list(rows()))}\n\n{note}"
    command.publish(options, "ordering", text)


if __name__ == "__main__":
    main()
