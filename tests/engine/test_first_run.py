# SPDX-License-Identifier: BSD-3-Clause
"""The process that compiles beside the first run of an installation."""

import gc
import importlib
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from numba import njit, typeof
from numba.extending import overload

import signorini as sg
from signorini.cli.main import main
from signorini.deck import load_deck
from signorini.engine import first_run
from signorini.gallery.coarse import hertz_line
from signorini.linalg._fronts import sizes
from signorini.linalg.plan import Fronts

DECK = Path(__file__).parents[2] / "examples" / "zhu_cylinder_frictionless.toml"


def test_the_list_has_the_types_that_a_run_calls_loops_with():
    sg.solve(load_deck(DECK).model)
    sg.solve(hertz_line(cells="triangle", order=1))  # quadrilaterals have a loop of their own
    for loop, arguments in first_run.calls():
        assert tuple(typeof(argument) for argument in arguments) in loop.overloads, loop


def test_loops_are_compiled_for_those_types_in_their_order(monkeypatch):
    order = []

    class Loop:
        def __init__(self, name):
            self.name = name

        def compile(self, types):
            order.append((self.name, types))

    monkeypatch.setattr(first_run, "calls", lambda: [(Loop("a"), (1,)), (Loop("b"), (1.0, 2))])
    first_run.compile_loops()
    assert order == [("a", (typeof(1),)), ("b", (typeof(1.0), typeof(2)))]


MODEL = load_deck(DECK).model


@pytest.fixture
def begun(monkeypatch):
    """Processes that were begun beside runs where nothing is compiled; all have ended after the test."""
    begun = []

    def begin(command, **options):
        assert command == [sys.executable, "-m", "signorini.engine.first_run"]
        begun.append(really([sys.executable, "-c", "import time; time.sleep(60)"], **options))
        return begun[-1]

    really = subprocess.Popen
    monkeypatch.setattr(subprocess, "Popen", begin)
    monkeypatch.setattr(first_run, "compiled", lambda: False)
    yield begun
    for process in begun:
        process.kill()
        process.wait()


@pytest.mark.parametrize("cores", [1, 2])
def test_another_process_ends_with_a_large_run_and_is_not_begun_on_one_core(cores, begun, monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    monkeypatch.setattr(first_run, "INTERPRETED_NODES", 0)
    with pytest.raises(ZeroDivisionError), first_run.helped(MODEL):
        raise ZeroDivisionError
    assert len(begun) == cores - 1
    assert all(process.returncode not in (None, 0) for process in begun)


def test_another_process_goes_on_after_a_small_run(begun):
    with first_run.helped(MODEL):
        pass
    assert [process.poll() for process in begun] == [None]


def test_no_process_is_begun_where_all_is_compiled(begun, monkeypatch):
    monkeypatch.setattr(first_run, "compiled", lambda: True)
    with first_run.helped(MODEL):
        pass
    assert begun == []


RUN = """
import sys
from numba.core import event
from signorini.engine import first_run
from signorini.gallery.coarse import hertz_line
from signorini.cli.main import main
from signorini.cli.main import main

compiled = []

class Listener(event.Listener):
    def on_start(self, event):
        compiled.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass

first_run._begun = lambda: None
event.register("numba:compile", Listener())
code = main(sys.argv[1:])
print(code, *compiled)
"""


@pytest.mark.slow
def test_a_small_first_run_compiles_nothing_and_has_the_same_numbers_to_the_last_bit(tmp_path):
    deck = str(DECK.with_name("hertz_two_bodies.toml"))
    command = [sys.executable, "-c", RUN, "run", deck, "--quiet", "-o", str(tmp_path / "first")]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "loops")}
    assert subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout == "0\n"
    assert main(["run", deck, "--quiet", "-o", str(tmp_path / "later")]) == 0
    for name in ("contact.csv", "solution.vtu", "history.csv"):
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "later" / name).read_bytes()


def test_loops_of_another_version_of_their_file_count_as_not_compiled(tmp_path, monkeypatch):
    file = tmp_path / "updated_loops.py"
    file.write_text(LOOP.format(call="double(1)"))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    double = importlib.import_module("updated_loops").double
    assert not first_run.on_disk(double)
    double(1)
    assert first_run.on_disk(double)
    double._cache._cache_file._source_stamp = "another"
    assert not first_run.on_disk(double)


def test_python_interprets_parts_of_loops():
    assert sizes(Fronts(*[np.array([0, 1])] * 8), 0) == (0, 1, 0)


LOOP = """
import sys
from numba import int64
from signorini.compilation import compile_aside, kernel

@kernel()
def double(k):
    return 2 * k

if __name__ == "__main__":
    print("begun", flush=True)
    {call}
    print(sum(double.stats.cache_hits.values()), sum(double.stats.cache_misses.values()))
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("call", "waits", "found"), [("double(1)", True, "1 0\n"), ("compile_aside(double, (int64,))", False, "0 0\n")]
)
def test_a_loop_that_another_process_compiles_is_waited_for_or_left_to_it(call, waits, found, tmp_path, monkeypatch):
    pytest.importorskip("fcntl")
    name = f"loops_{waits}"
    file = tmp_path / f"{name}.py"
    file.write_text(LOOP.format(call=call))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    double = importlib.import_module(name).double
    assert double._cache._cache_file.load("nothing of this name") is None  # so it is this process's turn
    with subprocess.Popen([sys.executable, file], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "begun\n"
        if waits:
            time.sleep(0.2)
            assert other.poll() is None
            double(2)
        assert other.communicate()[0] == found
    assert double(2) == 4
    assert not list(tmp_path.rglob("*.turn"))


@pytest.mark.parametrize("enabled", [True, False])
def test_no_garbage_is_looked_for_while_a_loop_is_compiled(enabled):
    seen = []

    def probe():
        raise NotImplementedError

    @overload(probe)
    def _typed():
        seen.append(gc.isenabled())
        return lambda: 1.0

    looped = njit(lambda: probe())
    (gc.enable if enabled else gc.disable)()
    try:
        assert looped() == 1.0
        assert seen
        assert not any(seen)
        assert gc.isenabled() == enabled
    finally:
        gc.enable()
