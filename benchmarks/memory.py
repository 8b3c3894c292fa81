# SPDX-License-Identifier: BSD-3-Clause
"""What a solve takes in memory beside what is estimated, condensed and iterated, on two cubes of CELLS along an edge.

Elastic ones, and such as yield where they press each other.

    python -m benchmarks.memory [CELLS ...]

Every line is a process of its own: bytes an entry of K that assembly and the solve add to its peak.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from itertools import product

from signorini.engine.examine import examine
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.fem.stiffness import stiffness
from signorini.gallery.cubes import cubes
from signorini.memory import peak_memory
from signorini.model.body import Body
from signorini.model.plastic import Plastic

_STEEL = Plastic(0.008, hardening=0.1)  # of E = 1: corners yield


def measured(cells: int, backend: str, material: str) -> str:
    """One line of the table: this process has done nothing else."""
    model = cubes(cells)
    if material == "yields":
        bodies = [Body(body.name, replace(body.material, plastic=_STEEL)) for body in model.bodies]
        model = replace(model, bodies=bodies)
    begin = peak_memory()
    K = stiffness(examine(model).space, model)
    entries, assembled = K.nnz, peak_memory()
    del K
    history = solve_prepared(prepare(model, backend=backend))
    parts = (assembled - begin) / entries, (peak_memory() - begin) / entries
    words = f"{model.mesh.points.size:9d} unknowns  {history.backend:12s}  {material:8s}"
    return f"{words} assembly {parts[0]:6.1f}  in all {parts[1]:6.1f} bytes an entry of K"


def main() -> None:
    """Print the table."""
    if len(sys.argv) == 4:
        print(measured(int(sys.argv[1]), *sys.argv[2:]))
        return
    for cells in sys.argv[1:] or ["12", "20", "30"]:
        for backend, material in product(("auto", "iterative"), ("elastic", "yields")):
            subprocess.run([sys.executable, "-m", "benchmarks.memory", cells, backend, material], check=True)


if __name__ == "__main__":
    main()
