# SPDX-License-Identifier: BSD-3-Clause
"""Run signorini on the cylinder, in a process of its own.

python -m benchmarks.peers.run_signorini REFINE FRICTION BACKEND [cold]
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

from benchmarks.page import KEEP_MEMORY, ONE_THREAD, peak_memory
from benchmarks.peers.case import Case
from benchmarks.peers.result import Result
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder

REPEATS, LONG = 5, 10.0


def run(case: Case, refine: int, friction: float, backend: str, *, cold: bool = False) -> Result:
    """Warm: medians after one small solve. Cold: all of a first process, which finds no compiled code on disk."""
    with tempfile.TemporaryDirectory() as nothing:
        environment = {**os.environ, **ONE_THREAD, **KEEP_MEMORY, **({"NUMBA_CACHE_DIR": nothing} if cold else {})}
        arguments = [str(refine), str(friction), backend, *(["cold"] if cold else [])]
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.peers.run_signorini", *arguments],
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
            check=True,
        )
    found = json.loads(done.stdout)
    pressure = np.interp(case.points[case.arc_nodes, 0], found["x"], found["pressure"])
    return Result(
        code=f"signorini, {backend}",
        input_seconds=found["input_seconds"],
        assembly_seconds=found["assembly_seconds"],
        solve_seconds=found["solve_seconds"],
        iterations=found["iterations"],
        memory=found["memory"],
        pressure=pressure,
    )


def main() -> None:
    refine, friction, backend = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
    cold = "cold" in sys.argv[4:]
    if not cold:
        solve_prepared(prepare(zhu_cylinder(friction=friction, refine=2), backend=backend))
    history = None
    seconds: list[tuple[float, float, float]] = []
    while not seconds or (not cold and len(seconds) < REPEATS and sum(map(sum, seconds)) < LONG):
        history = None  # the next repeat finds the memory as this one found it
        start = time.process_time()
        model = zhu_cylinder(friction=friction, refine=refine)
        made = time.process_time()
        clock = Clock(timer=time.process_time)
        history = solve_prepared(prepare(model, backend=backend, clock=clock))
        whole = time.process_time() - made
        assembly = clock.seconds["assembly"]
        seconds.append((made - start, assembly, whole - assembly))
    assert history is not None
    contact = history.last.contacts[0]
    order = np.argsort(contact.points[:, 0])
    print(
        json.dumps(
            {
                "input_seconds": statistics.median(s[0] for s in seconds),
                "assembly_seconds": statistics.median(s[1] for s in seconds),
                "solve_seconds": statistics.median(s[2] for s in seconds),
                "iterations": sum(history.last.iterations),
                "memory": peak_memory(),
                "x": contact.points[order, 0].tolist(),
                "pressure": contact.pressure[order].tolist(),
            }
        )
    )


if __name__ == "__main__":
    main()
