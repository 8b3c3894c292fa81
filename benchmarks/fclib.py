# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the FCLIB collection (frictional contact in space) from a folder of .hdf5 files, beside Siconos.

    python -m benchmarks.fclib FOLDER [--page]

Needs h5py. Local problems give W, q, mu with ``u = W r + q``; global ones are condensed to that. Siconos' own test data
hold some: numerics/src/FrictionContact/test/data in github.com/siconos/siconos. Siconos' nonsmooth Gauss-Seidel (5000
sweeps, 1e-9) runs where the system's Python has it.

With --page the table goes into docs/three_dimensions.md.

Residual: the natural map of the De Saxce form relative to the forces, rho = 3 / trace of a pair's block, of forces r
with ``u = W r + q`` computed afresh.

References
----------
Acary, Bremond, Huber (2018), On solving contact problems with Coulomb friction: formulations and numerical
comparisons, in: Advanced Topics in Nonsmooth Dynamics.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg

from benchmarks.page import table, write
from benchmarks.spatial_problems import from_compliance, natural_residual
from signorini.friction.solve import solve_contact

PAGE = Path(__file__).parent.parent / "docs" / "three_dimensions.md"
SYSTEM_PYTHON = Path("/usr/bin/python3")


def read_matrix(group) -> sp.csc_array:
    """A sparse matrix: by columns (nz = -1), by rows (-2) or by entries."""
    m, n, nz = (int(group[key][0]) for key in ("m", "n", "nz"))
    p, i, x = (np.asarray(group[key]) for key in ("p", "i", "x"))
    if nz == -1:
        return sp.csc_array((x, i, p), shape=(m, n))
    if nz == -2:
        return sp.csc_array(sp.csr_array((x, i, p), shape=(m, n)))
    return sp.csc_array((x[:nz], (i[:nz], p[:nz])), shape=(m, n))


def problems(folder: Path) -> Iterator[tuple[str, np.ndarray, np.ndarray, np.ndarray]]:
    """Name, W, q, mu of every spatial problem without rolling, interleaved."""
    import h5py

    for path in sorted(folder.glob("*.hdf5")):
        with h5py.File(path) as file:
            if "fclib_local" in file:
                local = file["fclib_local"]
                W, q, mu = read_matrix(local["W"]).toarray(), local["vectors/q"][:], local["vectors/mu"][:]
            elif "fclib_global" in file:
                whole = file["fclib_global"]
                M, H = read_matrix(whole["M"]), read_matrix(whole["H"])
                answer = scipy.sparse.linalg.splu(M).solve(np.column_stack([H.toarray(), whole["vectors/f"][:]]))
                W, mu = H.T @ answer[:, :-1], whole["vectors/mu"][:]
                q = H.T @ answer[:, -1] + whole["vectors/w"][:]
            else:
                continue
        if len(q) == 3 * len(mu):
            yield path.stem, (W + W.T) / 2, q, mu


def residual(W: np.ndarray, q: np.ndarray, mu: np.ndarray, r: np.ndarray) -> float:
    """Of forces r, all blocked by direction."""
    stiffness = 3.0 / W.diagonal().reshape(3, -1).sum(axis=0)
    return natural_residual(W @ r + q, r, mu, stiffness)


def by_siconos(W: np.ndarray, q: np.ndarray, mu: np.ndarray) -> tuple[np.ndarray, str] | None:
    """Forces and sweeps of the nonsmooth Gauss-Seidel method, interleaved; None where Siconos is missing."""
    if not SYSTEM_PYTHON.exists():
        return None
    with tempfile.TemporaryDirectory() as folder:
        name = f"{folder}/problem.npz"
        np.savez(name, W=W, q=q, mu=mu)
        script = Path(__file__).with_name("fclib_siconos.py")
        run = subprocess.run([SYSTEM_PYTHON, script, name], capture_output=True, text=True, check=False)
        if run.returncode:
            return None
        sweeps, info = run.stdout.split()[-2:]
        return np.load(name + ".r.npy"), sweeps if info == "0" else f"{sweeps}, not converged"


def main(folder: str, *options: str) -> None:
    head = (
        "problem",
        "pairs",
        "rank of W",
        "outcome",
        "residual",
        "Newton systems",
        "sweeps",
        "Siconos: residual",
        "sweeps",
    )
    rows = []
    for name, W, q, mu in problems(Path(folder)):
        n = len(mu)
        blocked = np.arange(3 * n).reshape(n, 3).T.ravel()
        A, c = W[np.ix_(blocked, blocked)], q[blocked]
        problem, root = from_compliance(A, c, mu)
        result = solve_contact(problem)
        systems = sum(a.iterations for a in result.trace if "newton" in a.method)
        sweeps = sum(a.iterations for a in result.trace if a.method == "gauss-seidel")
        own = residual(A, c, mu, result.r.ravel() * root)
        siconos = by_siconos(W, q, mu)
        theirs = ("-", "-") if siconos is None else (f"{residual(A, c, mu, siconos[0][blocked]):.0e}", siconos[1])
        rank = np.linalg.matrix_rank(W, tol=1e-10 * np.abs(W).max(), hermitian=True)
        rows.append((name, n, f"{rank}/{3 * n}", result.outcome, f"{own:.0e}", systems, sweeps, *theirs))
        print(rows[-1])
    text = table(head, rows)
    print(text)
    if "--page" in options:
        write("fclib", text, PAGE)


if __name__ == "__main__":
    main(*sys.argv[1:])
