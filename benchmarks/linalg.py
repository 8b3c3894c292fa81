# SPDX-License-Identifier: BSD-3-Clause
"""Condensation against a plain linear solve of the same back end: CPU seconds, one thread, code warm.

contact: analyse, factorise, Schur complement, condense a load, solve the dense interface, expand.
plain: analyse, factorise and solve the same matrix with the interface fixed.

usage: python -m benchmarks.linalg [CASE...] [--backends a,b] [--repeats N]
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from typing import Any

import numpy as np
import scipy.linalg
import skfem
from scipy import sparse

from benchmarks import command, page
from signorini.fem.assembly import Cells, stiffness
from signorini.fem.elasticity import isotropic, law_tensor
from signorini.linalg import BACKENDS, factorise
from signorini.linalg.pardiso import available

CASES: dict[str, tuple[int, ...]] = {
    "2d_2e4": (141, 70),
    "2d_2e5": (447, 223),
    "2d_1e6": (999, 500),
    "3d_3e4": (21, 21, 21),
    "3d_1e5": (32, 32, 31),
}
ENTRIES = {
    "multifrontal": lambda factor: factor.plan.nnz_factor,
    "pardiso": lambda factor: int(factor.solver.get_iparm(18)),
    "superlu": lambda factor: factor.lu.L.nnz,
}
"""Of the factor, by back end."""


def block(cells: tuple[int, ...]) -> tuple[sparse.csr_array, np.ndarray, np.ndarray]:
    """A block clamped at the bottom; all components of the top are the interface: K, interface, nodes."""
    d = len(cells)
    axes = [np.linspace(0, k / cells[0], k + 1) for k in cells]
    mesh = (skfem.MeshQuad if d == 2 else skfem.MeshHex).init_tensor(*axes)
    element = skfem.ElementQuad1() if d == 2 else skfem.ElementHex1()
    basis = skfem.Basis(mesh, element)
    X, weights = basis.quadrature
    gradients = np.stack([element.lbasis(X, i)[1] for i in range(2**d)])
    K = stiffness(
        basis.doflocs.T,
        Cells(nodes=basis.element_dofs.T, shape_gradients=np.moveaxis(gradients, 2, 0), weights=weights),
        law_tensor(isotropic(0.58, 0.38)[None, : 2 * d, : 2 * d]),
    )
    height = np.repeat(basis.doflocs[-1], d)
    free = np.flatnonzero(height > 0)
    top = height[free] == height.max()
    return K[free][:, free].tocsr(), np.flatnonzero(top), np.repeat(np.arange(K.shape[0] // d), d)[free]


def contact(K: Any, interface: Any, nodes: Any, backend: str) -> Any:
    factor = factorise(K, interface, nodes=nodes, backend=backend)
    f = np.ones(factor.n)
    reduced = factor.reduce(f)
    reduced.expand(scipy.linalg.solve(factor.schur(), reduced.load, assume_a="pos"))
    return factor


def plain(K: Any, nodes: Any, backend: str) -> Any:
    factor = factorise(K, [], nodes=nodes, backend=backend)
    factor.reduce(np.ones(factor.n)).expand(np.empty(0))
    return factor


def measure(case: str, backend: str, repeats: int) -> None:
    """One case, in a process of its own, so that the peak of memory is its own."""
    K, interface, nodes = block((4,) * len(CASES[case]))
    contact(K, interface, nodes, backend)
    K, interface, nodes = block(CASES[case])
    inside = np.setdiff1d(np.arange(K.shape[0]), interface)
    fixed = K[inside][:, inside].tocsr()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    pairs = []
    for _ in range(repeats):
        seconds, factor = command.cpu(contact, K, interface, nodes, backend)
        nnz = ENTRIES[backend](factor)
        del factor
        pairs.append((seconds, command.cpu(plain, fixed, nodes[inside], backend)[0]))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    ours, theirs = np.median(pairs, axis=0)
    print(
        f"{case:8} {K.shape[0]:8d} {len(interface):6d} {backend:13} {ours:10.2f} {theirs:8.2f} {ours / theirs:6.2f} "
        f"{nnz:9.2e} {peak / 2**20:6.2f} {(peak - before) / 2**20:6.2f}",
        flush=True,
    )


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("cases", nargs="*", default=["2d_2e4", "2d_2e5", "3d_3e4"], help=", ".join(CASES))
    parser.add_argument("--backends", default=",".join(b for b in BACKENDS if b != "pardiso" or available()))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        measure(options.cases[0], options.backends, options.repeats)
        return
    print("case     unknowns  iface back end       contact s  plain s  ratio    nnz(L) GB all  GB own", flush=True)
    for case in options.cases:
        for backend in options.backends.split(","):
            arguments = [case, "--backends", backend, "--repeats", str(options.repeats), "--one"]
            again = [sys.executable, "-m", "benchmarks.linalg", *arguments]
            subprocess.run(again, check=False, env={**os.environ, **page.ONE_THREAD})


if __name__ == "__main__":
    main()
