# SPDX-License-Identifier: BSD-3-Clause
"""What a solve takes in memory beside what is estimated, condensed and iterated, on two cubes of CELLS along an edge.

Elastic ones, and such as yield where they press each other.

    python -m benchmarks.memory [CELLS ...]
    python -m benchmarks.memory columns [CELLS ...]

Every line is a process of its own: bytes an entry of K that assembly and the solve add to its peak. Of columns, whose
contact has so many cells across, what condensing them adds to their stiffness, and what is estimated.
"""

from __future__ import annotations

import resource
import subprocess
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path

import scipy.sparse as sp

from benchmarks.size import columns
from signorini.engine.examine import examine
from signorini.engine.memory_check import condensing
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.fem.stiffness import stiffness
from signorini.gallery.cubes import cubes
from signorini.interface.active import FreeBodies
from signorini.memory import give_memory_back, peak_memory
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


def condensed(side: int) -> str:
    """One line of the table of columns."""
    model = columns(side, 60_000)
    prepared = prepare(model, backend="iterative")
    T, interface = prepared.constraints.transform, prepared.interface
    K, B = sp.csr_array(T.T @ prepared.K @ T), sp.csr_array(interface.B @ T)
    bodies = FreeBodies(K, B, prepared.constraints.nodes, prepared.space.places)
    told = condensing(bodies, interface, candidates=prepared.candidates, plenty=0.0).bytes / 1e9
    stiffness = 12.0 * (prepared.K.nnz + K.nnz)
    del prepared, K, B, bodies
    give_memory_back()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    pairs = solve_prepared(prepare(model, backend="multifrontal")).pairs
    taken = (peak_memory() - pages * resource.getpagesize() - stiffness) / 1e9
    return f"{pairs:5d} pairs  estimated {told:5.2f} GB  taken {taken:5.2f} GB  ratio {told / taken:4.2f}"


def main() -> None:
    """Print the tables."""
    if sys.argv[1:2] == ["columns"]:
        if sys.argv[2:3] == ["one"]:
            print(condensed(int(sys.argv[3])))
            return
        for cells in sys.argv[2:] or ["19", "29", "39", "54"]:
            subprocess.run([sys.executable, "-m", "benchmarks.memory", "columns", "one", cells], check=True)
        return
    if len(sys.argv) == 4:
        print(measured(int(sys.argv[1]), *sys.argv[2:]))
        return
    for cells in sys.argv[1:] or ["12", "20", "30"]:
        for backend, material in product(("auto", "iterative"), ("elastic", "yields")):
            subprocess.run([sys.executable, "-m", "benchmarks.memory", cells, backend, material], check=True)


if __name__ == "__main__":
    main()
