# SPDX-License-Identifier: BSD-3-Clause
"""What a solve takes at least, and writing its results at most, beside what a process of its own takes."""

import json
import subprocess
import sys

import pytest

import signorini as sg
from signorini.clock import Clock
from signorini.engine.memory_check import least_bytes
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.prints import Prints
from signorini.output import folder
from signorini.output.room import results_bytes

PROCESS = """
import gc, json, sys, tempfile
from pathlib import Path
import signorini as sg
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.memory import give_memory_back
from signorini.output.folder import write_folder

def held(which):
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith(which))

def taken(job):
    gc.collect()
    give_memory_back()
    begin = held("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # the peak is counted from here
    found = job()
    return held("VmHWM") - begin, found

def written(history):
    with tempfile.TemporaryDirectory() as name:
        write_folder(history, Path(name))

made = {"plane": lambda size: zhu_cylinder(refine=size), "space": cubes}[sys.argv[1]]
written(sg.solve(made(2)))  # loads what is loaded once
model = made(int(sys.argv[2]))
solve, history = taken(lambda: sg.solve(model))
print(json.dumps([solve, taken(lambda: written(history))[0]]))
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads the peak of a process from /proc")
@pytest.mark.parametrize(("what", "size"), [("plane", 24), ("plane", 40), ("space", 20)])
def test_a_solve_takes_no_less_than_was_said_and_its_results_no_more(what, size):
    done = subprocess.run([sys.executable, "-c", PROCESS, what, str(size)], capture_output=True, text=True, check=True)
    solve, results = json.loads(done.stdout)
    model = zhu_cylinder(refine=size) if what == "plane" else cubes(size)
    least, most = least_bytes(model), results_bytes(model)
    assert 0.4 * solve < least < solve, (least, solve)
    assert 0.4 * most < results < most, (results, most)
    assert results < solve  # so that what fits while it is solved can be written behind it


def test_a_step_is_written_before_the_next_one_is_solved_only_where_memory_holds_both(tmp_path, monkeypatch):
    solution, publisher = (
        sg.solve(zhu_cylinder(refine=1)),
        folder.Publisher(folder=tmp_path, clock=Clock(), started=0.0),
    )
    monkeypatch.setattr(folder, "available_memory", lambda: int(results_bytes(solution.model)) - 1)
    publisher.keep(solution)
    assert not list(tmp_path.iterdir())
    monkeypatch.setattr(folder, "available_memory", lambda: int(results_bytes(solution.model)) + 1)
    publisher.keep(solution)
    assert (tmp_path / "summary.json").exists()


def test_stresses_that_several_files_need_are_computed_again_where_memory_does_not_hold_them(tmp_path, monkeypatch):
    solution, found = sg.solve(zhu_cylinder(refine=1)), []
    for name, states in (("kept", 1), ("again", 0)):
        monkeypatch.setattr(folder, "shared_states", lambda _, states=states: states)
        own = folder.open_folder(tmp_path / name)
        folder.Publisher(folder=own, clock=Clock(), started=0.0, prints=Prints(tables=(), times=())).publish(solution)
        found.append((own / "solution.frd").read_bytes())
    assert found[0] == found[1]
