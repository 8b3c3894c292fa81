# SPDX-License-Identifier: BSD-3-Clause
"""Nonsmooth Gauss-Seidel of Siconos for one problem: run by the system's Python, to which Debian adds python3-siconos.

Reads W, q, mu (interleaved: normal, tangents of a pair) from the .npz file named, writes r and u beside it, and prints
sweeps and whether it says that it converged.
"""

from __future__ import annotations

import os
import sys

import numpy as np


def main(name: str) -> None:
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    import siconos.numerics as numerics

    with np.load(name) as data:
        W, q, mu = np.asfortranarray(data["W"]), data["q"], data["mu"]
    problem = numerics.FrictionContactProblem(3, W, q, mu)
    options = numerics.SolverOptions(numerics.SICONOS_FRICTION_3D_NSGS)
    options.dparam[numerics.SICONOS_DPARAM_TOL] = 1e-9
    options.iparam[numerics.SICONOS_IPARAM_MAX_ITER] = 5000
    r, u = np.zeros(len(q)), np.zeros(len(q))
    info = numerics.fc3d_driver(problem, r, u, options)
    np.save(name + ".r.npy", r)
    print(options.iparam[numerics.SICONOS_IPARAM_ITER_DONE], info, file=answers, flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
