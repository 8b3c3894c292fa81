# SPDX-License-Identifier: BSD-3-Clause
"""Memory that runs out all the same ends a history in one sentence, and finished steps stay."""

import json
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pytest

import signorini as sg
from signorini.deck.load import load_deck
from signorini.engine import solve as engine

DECK = """
kind = "plane strain"
[mesh]
generator = "rectangle"
width = 2.0
height = 1.0
nx = 2
ny = 1
[material.soft]
E = 100.0
nu = 0.3
[[body]]
name = "block"
material = "soft"
[[support]]
on = "left"
u = [0.0, "free"]
[[load]]
on = "top"
name = "push"
pressure = 3.0
[[contact]]
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
[[step]]
name = "half"
scale = { push = 0.5 }
[[step]]
name = "whole"
"""
RUN = """
import resource, sys
from pathlib import Path
import numpy as np
from signorini.cli.main import main
from signorini.engine import solve as engine

follow = engine.follow_part

def greedy(stage, part):
    if stage.step.name == "whole":
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + 64 * 2**20, resource.RLIM_INFINITY))
        np.ones(16 * 2**20)  # 128 MiB
    return follow(stage, part)

engine.follow_part = greedy
sys.exit(main(["run", sys.argv[1], "-o", sys.argv[2], "--quiet"]))
"""


def greedy(in_step: str) -> Callable[..., object]:
    follow = engine.follow_part

    def way(stage, part):
        if stage.step.name == in_step:
            np.empty(1 << 50)  # more than there are addresses
        return follow(stage, part)

    return way


def model(tmp_path) -> sg.Model:
    (tmp_path / "deck.toml").write_text(DECK)
    return load_deck(tmp_path / "deck.toml").model


def test_a_solve_that_runs_out_of_memory_says_so_with_the_steps_before(tmp_path, monkeypatch):
    monkeypatch.setattr(engine, "follow_part", greedy("whole"))
    with pytest.raises(
        sg.SolveFailed, match=r"^step 2 of 2: out of memory \(Unable to allocate 8.00 PiB .*\): "
    ) as found:
        sg.solve(model(tmp_path))
    assert found.value.status == "not_found"
    assert [step.name for step in found.value.solution.steps] == ["half"]
    assert "GB were held" in str(found.value)
    assert str(found.value).count("\n") == 0


def test_a_model_that_cannot_be_prepared_says_so_too(tmp_path, monkeypatch):
    monkeypatch.setattr(engine, "prepare", lambda *_, **__: np.empty(1 << 50))
    with pytest.raises(sg.SolveFailed, match=r"^out of memory \(Unable to allocate .* expected a coarser mesh"):
        sg.solve(model(tmp_path))


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="needs limits of address space")
def test_a_run_at_the_limit_of_its_addresses_leaves_finished_steps_on_disk(tmp_path):
    model(tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", RUN, tmp_path / "deck.toml", tmp_path / "out"], capture_output=True, text=True
    )
    assert done.returncode == 3, done.stderr
    assert done.stderr.count("\n") == 1
    assert "(not_found): step 2 of 2: out of memory (Unable to allocate 128. MiB" in done.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert [step["name"] for step in summary["steps"]] == ["half"]
    assert sg.load(tmp_path / "out").end is not None
    assert (tmp_path / "out" / "solution.vtu").stat().st_size > 0
