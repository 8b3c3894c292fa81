# SPDX-License-Identifier: BSD-3-Clause
"""Lemke's method of Siconos in a process of its own: Debian's python3-siconos runs under the system's Python alone.

`Siconos()` starts it and raises ImportError, in words, where it is missing. Run as a script this file is that process:
it imports nothing but NumPy and Siconos, reads the name of a .npz file with M and q per line, and answers with CPU
seconds; z comes back in a file beside it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time

import numpy as np

PYTHON = "/usr/bin/python3"


class Siconos:
    """The running process; `solve` returns CPU seconds of the call alone and z, None where it did not succeed."""

    def __init__(self) -> None:
        if not os.path.exists(PYTHON):
            raise ImportError(f"siconos: there is no {PYTHON}")
        self._folder = tempfile.TemporaryDirectory()
        self._file = os.path.join(self._folder.name, "problem.npz")
        self._process = subprocess.Popen(
            [PYTHON, __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        if self._process.stdout.readline() != "ready\n":
            raise ImportError("siconos: python3-siconos is not installed for the system's Python")

    def solve(self, M: np.ndarray, q: np.ndarray) -> tuple[float, np.ndarray | None]:
        np.savez(self._file, M=np.asfortranarray(M), q=q)
        self._process.stdin.write(self._file + "\n")
        self._process.stdin.flush()
        seconds, info = self._process.stdout.readline().split()
        return float(seconds), np.load(self._file + ".z.npy") if info == "0" else None

    def close(self) -> None:
        self._process.stdin.close()
        self._process.wait()
        self._folder.cleanup()


def serve() -> None:
    """Answer until the input ends; what the library itself prints goes nowhere."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    import siconos.numerics as numerics

    print("ready", file=answers, flush=True)
    for line in sys.stdin:
        name = line.strip()
        with np.load(name) as data:
            M, q = np.asfortranarray(data["M"]), data["q"]
        z, w = np.zeros(len(q)), np.zeros(len(q))
        options = numerics.SolverOptions(numerics.SICONOS_LCP_LEMKE)
        options.iparam[0] = 10**6  # pivots
        start = time.process_time()
        info = numerics.linearComplementarity_driver(numerics.LCP(M, q), z, w, options)
        seconds = time.process_time() - start
        np.save(name + ".z.npy", z)
        print(seconds, info, file=answers, flush=True)


if __name__ == "__main__":
    serve()
