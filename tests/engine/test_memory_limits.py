# SPDX-License-Identifier: BSD-3-Clause
"""Under any limit of memory a model is solved or refused in words, before it is begun: memory never runs out."""

import json
import subprocess
import sys

import pytest

PROCESS = """
import json, os, resource, sys, time
from pathlib import Path
import signorini as sg
from signorini.gallery.cubes import cubes

sg.solve(cubes(3, 2), backend="multifrontal"), sg.solve(cubes(3, 2), backend="iterative")  # loads what solves load
model = cubes(13, 12)
compiles = os.fork()
if not compiles:  # what such a model compiles, which takes more memory than it does
    sg.solve(model, backend="multifrontal"), sg.solve(model, backend="iterative")
    os._exit(0)
os.waitpid(compiles, 0)
page = resource.getpagesize()
for way in ("multifrontal", "iterative"):
    for megabytes in (15, 30, 60, 80, 100, 120, 160, 240, 400):
        child = os.fork()
        if not child:
            used, began = int(Path("/proc/self/statm").read_text().split()[0]) * page, time.process_time()
            resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 10**6,) * 2)
            try:
                found = sg.solve(model, backend=way).backend
            except sg.InputError as error:
                found = str(error)
            except MemoryError as error:
                found = f"memory ran out: {error}"
            print(json.dumps([way, megabytes, found, time.process_time() - began]), flush=True)
            os._exit(0)
        os.waitpid(child, 0)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of address space")
def test_what_does_not_fit_is_refused_with_what_it_takes_and_the_ways_out():
    done = subprocess.run([sys.executable, "-c", PROCESS], capture_output=True, text=True, check=True)
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(found) == 18  # no process died
    for way in ("multifrontal", "iterative"):
        own = [each for each in found if each[0] == way]
        solved = [megabytes for _, megabytes, words, _ in own if words == way]
        refused = [megabytes for _, megabytes, words, _ in own if "GB of memory are free; expected " in words]
        assert sorted(refused + solved) == [each[1] for each in own], own
        assert refused[0] == 15
        assert solved[-1] == 400
        assert max(refused) < min(solved)
        assert all("(back end 'petsc')" in words for _, megabytes, words, _ in own if megabytes in refused)
        assert max(seconds for _, megabytes, _, seconds in own if megabytes in refused) < 1.0
