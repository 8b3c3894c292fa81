# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact: a contact solve against one plain linear solve of the same matrix."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.clock import Clock
from signorini.engine.increments import free_load
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.registry import factorise
from signorini.memory import peak_memory
from signorini.model.model import Model
from signorini.solution.state import initial_state

Timer = Callable[[], float]

REPEATS = 5
"""Solves of each kind of which the medians are compared."""

_REPEATS_SECONDS, _MIN_REPEATS = 40.0, 3  # where repeats take longer, the fewest have to do


def warm_up(model: Model, timer: Timer) -> None:
    """Compiled code and pages of memory: both solves find them."""
    prepared = prepare(model)
    _linear(*_fixed(prepared), solve_prepared(prepared).backend, timer)


def price(name: str, model: Model, timer: Timer, *, repeats: int = REPEATS, other: str | None = None) -> dict[str, Any]:
    """Time a model of one contact: a row of the contract; contact and linear solves interleaved, medians of repeats.

    name : of the row
    timer : tells seconds, on the wall or of the CPU
    repeats : as long as they take less than 40 s, but three at least
    other : a back end whose plain solve of the same matrix is timed, too: other_seconds
    contact_seconds : all after assembly, up to tractions, displacements and the certificate
    linear_seconds : analyse, factorise and solve the same matrix with the contact nodes fixed, same back end
    ratio : of the two
    """
    contact: list[float] = []
    linear: list[float] = []
    others: list[float] = []
    memory = 0
    assembly: list[float] = []
    cpu: list[float] = []
    phases: list[dict[str, float]] = []
    while len(contact) < min(_MIN_REPEATS, repeats) or (
        len(contact) < repeats and sum(contact) + sum(linear) < _REPEATS_SECONDS
    ):
        clock, began, cpu_began = Clock(timer=timer), timer(), time.process_time()
        prepared = prepare(model, clock=clock)
        history = solve_prepared(prepared)
        cpu.append(time.process_time() - cpu_began)
        assembly.append(clock.seconds["assembly"])
        contact.append(timer() - began - assembly[-1])
        phases.append({phase: seconds for phase, seconds in clock.seconds.items() if phase != "assembly"})
        found = {
            "dofs": len(prepared.constraints.nodes),
            "contact_pairs": history.pairs,
            "path": history.last.path,
            "iterations": sum(history.last.iterations),
        }
        fixed, backend = _fixed(prepared), history.backend
        del prepared, history  # both solves find as much free memory: touching new pages costs as much as computing
        linear.append(_linear(*fixed, backend, timer))
        memory = memory if others else peak_memory()
        if other is not None:
            others.append(_linear(*fixed, other, timer))
    return {
        "name": name,
        "friction": model.contacts[0].coefficient,
        "backend": backend,
        "default": True,
        "assembly_seconds": statistics.median(assembly),
        "contact_seconds": statistics.median(contact),
        "linear_seconds": statistics.median(linear),
        "phases": {phase: statistics.median(each[phase] for each in phases) for phase in phases[0]},
        "ratio": statistics.median(contact) / statistics.median(linear),
        "cpu_seconds": statistics.median(cpu),
        "peak_memory_bytes": memory,
        **({"other_seconds": statistics.median(others)} if others else {}),
        **found,
    }


def iterated(row: dict[str, Any], model: Model, timer: Timer) -> dict[str, Any]:
    """Time the model of a row of `price` once, iterated on its bodies: a row with that one's assembly and linear solve.

    Parameters
    ----------
    row : of the condensed solve
    model, timer : as :func:`price` had them; memory cannot be told of a part of a process
    """
    began, cpu_began = timer(), time.process_time()
    history = solve_prepared(prepare(model, backend=ITERATIVE))
    seconds = timer() - began - row["assembly_seconds"]
    return row | {
        "backend": history.backend,
        "default": False,
        "contact_seconds": seconds,
        "ratio": seconds / row["linear_seconds"],
        "phases": {},
        "iterations": sum(history.last.iterations),
        "cpu_seconds": time.process_time() - cpu_began,
        "peak_memory_bytes": None,
    }


def _fixed(prepared: Prepared) -> tuple[sp.csr_array, IntArray, Array, Array]:
    """Matrix, node of each unknown, places of the nodes and load of the same bodies with the contact nodes fixed."""
    T = prepared.constraints.transform
    keep = np.setdiff1d(np.arange(T.shape[1]), prepared.paths.condensed.dofs)
    K = sp.csr_array((T.T @ prepared.K @ T)[keep][:, keep])
    factors = dict.fromkeys(prepared.model.scaled_names, 1.0)
    full = initial_state(factors, prepared.constraints.zeros, prepared.interface).point
    return K, prepared.constraints.nodes[keep], prepared.space.places, free_load(prepared, full)[keep]


def _linear(K: sp.csr_array, nodes: IntArray, points: Array, f: Array, backend: str, timer: Timer) -> float:
    """Seconds of one plain solve: analyse, factorise, solve."""
    began = timer()
    factorise(K, np.empty(0, int), nodes=nodes, points=points, backend=backend).reduce(f).expand(np.empty(0))
    return timer() - began
