# SPDX-License-Identifier: BSD-3-Clause
"""The process that compiles beside the first run of an installation."""

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest
from numba import njit, typeof
from numba.extending import overload

import signorini as sg
from signorini.cli import first_run
from signorini.deck import load_deck

DECK = Path(__file__).parents[2] / "examples" / "zhu_cylinder_frictionless.toml"


def test_the_list_has_the_types_that_a_run_calls_loops_with():
    sg.solve(load_deck(DECK).model)
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


@pytest.mark.parametrize("cores", [1, 2])
def test_another_process_ends_with_the_run_and_is_not_begun_on_one_core(cores, monkeypatch):
    begun = []

    def begin(command, **options):
        assert command == [sys.executable, "-m", "signorini.cli.first_run"]
        begun.append(really([sys.executable, "-c", "import time; time.sleep(60)"], **options))
        return begun[-1]

    really = subprocess.Popen
    monkeypatch.setattr(subprocess, "Popen", begin)
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    with pytest.raises(ZeroDivisionError), first_run.helped():
        raise ZeroDivisionError
    assert len(begun) == cores - 1
    assert all(process.returncode not in (None, 0) for process in begun)


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
