# SPDX-License-Identifier: BSD-3-Clause
"""Run GetFEM on the cylinder, by the Python of the system."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.page import KEEP_MEMORY, thread_environment
from benchmarks.peers.case import Case, write_arrays
from benchmarks.peers.result import Result

PYTHON = "/usr/bin/python3"
SCRIPT = Path(__file__).parent / "getfem_cylinder.py"


def missing() -> str | None:
    """Why GetFEM cannot be run here."""
    try:
        found = subprocess.run([PYTHON, "-c", "import getfem"], capture_output=True, env=environment(), check=False)
    except OSError:
        return f"GetFEM skipped: there is no {PYTHON}"
    return None if found.returncode == 0 else f"GetFEM skipped: {PYTHON} cannot import it (Debian: python3-getfem)"


def run(case: Case, friction: float, threads: int = 1) -> Result:
    """One increment; the elastic body is assembled once, before the solve, contact terms in every Newton step."""
    with tempfile.TemporaryDirectory() as folder:
        return _run(case, friction, Path(folder), threads)


def _run(case: Case, friction: float, folder: Path, threads: int) -> Result:
    write_arrays(case, folder / "cylinder.npz")
    done = subprocess.run(
        [PYTHON, str(SCRIPT), str(folder / "cylinder.npz"), str(friction)],
        capture_output=True,
        text=True,
        env=environment(threads),
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"GetFEM ended with {done.returncode}:\n{done.stderr[-2000:]}")
    found = json.loads(done.stdout.splitlines()[-1])
    return Result(
        code="GetFEM",
        input_seconds=found["input_seconds"],
        assembly_seconds=found["assembly_seconds"],
        solve_seconds=found["solve_seconds"],
        wall_seconds=found["wall_seconds"],
        iterations=found["iterations"],
        memory=found["memory"],
        pressure=np.array(found["forces"]) / case.arc_lengths,
    )


def environment(threads: int = 1) -> dict[str, str]:
    """So many threads, and none of this Python's packages."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return kept | thread_environment(threads) | KEEP_MEMORY
