# SPDX-License-Identifier: BSD-3-Clause
"""What a solve takes in memory beside what is estimated, condensed and iterated, on two cubes of CELLS along an edge.

    python -m benchmarks.memory [CELLS ...]

Every line is a process of its own: bytes an entry of K that assembly and the solve add to its peak.
"""

from __future__ import annotations

import subprocess
import sys

from signorini.engine.examine import examine
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.fem.stiffness import stiffness
from signorini.gallery.cubes import cubes
from signorini.memory import peak_memory


def measured(cells: int, backend: str) -> str:
    """One line of the table: this process has done nothing else."""
    model = cubes(cells)
    begin = peak_memory()
    K = stiffness(examine(model).space, model)
    entries, assembled = K.nnz, peak_memory()
    del K
    history = solve_prepared(prepare(model, backend=backend))
    parts = (assembled - begin) / entries, (peak_memory() - begin) / entries
    words = f"{model.mesh.points.size:9d} unknowns  {history.backend:12s}"
    return f"{words} assembly {parts[0]:6.1f}  in all {parts[1]:6.1f} bytes an entry of K"


def main() -> None:
    """Print the table."""
    if len(sys.argv) == 3 and sys.argv[2] in ("auto", "iterative"):
        print(measured(int(sys.argv[1]), sys.argv[2]))
        return
    for cells in sys.argv[1:] or ["12", "20", "30"]:
        for backend in ("auto", "iterative"):
            subprocess.run([sys.executable, "-m", "benchmarks.memory", cells, backend], check=True)


if __name__ == "__main__":
    main()
