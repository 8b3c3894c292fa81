# SPDX-License-Identifier: BSD-3-Clause
"""Run CalculiX on the cylinder, with CPU seconds by phase and the pressures it writes.

CalculiX assembles in every iteration. What it prints tells the phases apart: its CPU time is read from the system
whenever it prints one of the lines that begin a phase.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.page import KEEP_MEMORY, peak_memory, thread_environment
from benchmarks.peers.case import Case, write_calculix
from benchmarks.peers.result import Result
from signorini.arrays import Array, IntArray

PHASES = {
    "Determining the structure of the matrix": "solve",
    "for the stress calculation": "solve",
    "for the symmetric stiffness": "assembly",
    "for the asymmetric stiffness": "assembly",
    "Factoring the system": "solve",
}


def missing() -> str | None:
    """Why CalculiX cannot be run here."""
    if shutil.which("ccx") is None:
        return "CalculiX skipped: no program ccx on the path (Debian: calculix-ccx)"
    if shutil.which("stdbuf") is None or not Path("/proc/self/stat").exists():
        return "CalculiX skipped: its phases are timed by stdbuf and /proc, which this system lacks"
    return None


def run(case: Case, friction: float, threads: int = 1) -> Result:
    """One increment; input, assembly and the rest in CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        return _run(case, friction, Path(folder), threads)


def _run(case: Case, friction: float, folder: Path, threads: int) -> Result:
    write_calculix(case, folder / "cylinder.inp", friction=friction)
    unbuffered = {"GFORTRAN_UNBUFFERED_PRECONNECTED": "y"}
    process = subprocess.Popen(
        ["stdbuf", "-oL", "ccx", "-i", "cylinder"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, **thread_environment(threads), **KEEP_MEMORY, **unbuffered},
    )
    assert process.stdout is not None
    seconds = {"input": 0.0, "assembly": 0.0, "solve": 0.0}
    phase, before, iterations, memory, finished = "input", 0.0, 0, 0, False
    begun = time.perf_counter()
    for line in process.stdout:
        iterations += line.startswith(" iteration")
        finished |= "Job finished" in line
        for words, following in PHASES.items():
            if words in line:
                now, memory = _cpu(process.pid), peak_memory(process.pid)
                begun = time.perf_counter() if phase == "input" else begun
                seconds[phase] += now - before
                phase, before = following, now
    _, code, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begun
    process.returncode = os.waitstatus_to_exitcode(code)
    seconds[phase] += usage.ru_utime + usage.ru_stime - before
    if process.returncode or not finished:
        raise SystemExit(f"CalculiX ended with {process.returncode} and without a solution")
    return Result(
        code="CalculiX",
        input_seconds=seconds["input"],
        assembly_seconds=seconds["assembly"],
        solve_seconds=seconds["solve"],
        wall_seconds=wall,
        iterations=iterations,
        memory=memory,
        pressure=_pressures(folder / "cylinder.frd", case.arc_nodes),
    )


def _cpu(process: int) -> float:
    """CPU seconds of a running process."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _pressures(file: Path, nodes: IntArray) -> Array:
    """The contact pressures of the last increment at some nodes, 0 where none is written."""
    found: dict[int, float] = {}
    for name, node, values in records(file):
        if name == "CONTACT":
            found[node] = values[3]
    return np.array([found.get(node + 1, 0.0) for node in nodes.tolist()])


def records(file: Path) -> Iterator[tuple[str, int, list[float]]]:
    """Name of the block, node and values of every nodal result: format of the .frd file, 12 columns a value."""
    name = ""
    with file.open() as lines:
        for line in lines:
            if line.startswith(" -4"):
                name = line.split()[1]
            elif line.startswith(" -1") and name:
                text = line.rstrip("\n")
                yield name, int(text[3:13]), [float(text[i : i + 12]) for i in range(13, len(text) - 11, 12)]
            elif line.startswith(" -3"):
                name = ""
