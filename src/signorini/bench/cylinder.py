# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact: the paper's cylinder against one plain linear solve of the same matrix."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.clock import Clock
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.linalg.registry import factorise
from signorini.memory import peak_memory
from signorini.model.model import Model

Timer = Callable[[], float]

REPEATS = 5
_LONG, _LEAST = 20.0, 3  # seconds, and how many repeats have to do where they take longer


class TimerClock(Clock):
    """A clock that reads another timer, such as ``time.process_time``: on a busy machine CPU seconds say more."""

    def __init__(self, timer: Timer) -> None:
        super().__init__()
        self._timer = timer

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Time a block under a name."""
        start = self._timer()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + self._timer() - start


def cylinder(dofs: int, *, timer: Timer = time.perf_counter) -> Iterator[dict[str, Any]]:
    """Time the cylinder with about ``dofs`` unknowns, mu = 0 and 0.4, one increment; by default on the wall.

    Yields
    ------
    rows of the contract; contact and linear solves are interleaved, after one warm-up, and medians are given.
    contact_seconds : all after assembly, up to tractions, displacements and the certificate
    linear_seconds : analyse, factorise and solve the same matrix with the contact nodes fixed, same back end
    ratio : of the two
    """
    refine = max(1, round(np.sqrt(dofs / (2 * 76))))
    warm = prepare(zhu_cylinder(refine=refine))  # compiled code and pages of memory: both solves find them
    _linear(*_fixed(warm), solve_prepared(warm).backend, timer)
    del warm
    for friction in (0.0, 0.4):
        yield _measure(zhu_cylinder(friction=friction, refine=refine), timer)


def _measure(model: Model, timer: Timer) -> dict[str, Any]:
    contact: list[float] = []
    linear: list[float] = []
    assembly: list[float] = []
    cpu: list[float] = []
    while len(contact) < _LEAST or (len(contact) < REPEATS and sum(contact) + sum(linear) < _LONG):
        clock, began, cpu_began = TimerClock(timer), timer(), time.process_time()
        prepared = prepare(model, clock=clock)
        history = solve_prepared(prepared)
        cpu.append(time.process_time() - cpu_began)
        assembly.append(clock.seconds["assembly"])
        contact.append(timer() - began - assembly[-1])
        found = {
            "dofs": len(prepared.constraints.nodes),
            "contact_pairs": history.pairs,
            "path": history.last.path,
            "iterations": sum(history.last.iterations),
        }
        fixed, backend = _fixed(prepared), history.backend
        del prepared, history  # both solves find as much free memory: touching new pages costs as much as computing
        linear.append(_linear(*fixed, backend, timer))
    return {
        "name": "cylinder",
        "friction": model.contacts[0].coefficient,
        "backend": backend,
        "default": True,
        "assembly_seconds": statistics.median(assembly),
        "contact_seconds": statistics.median(contact),
        "linear_seconds": statistics.median(linear),
        "ratio": statistics.median(contact) / statistics.median(linear),
        "cpu_seconds": statistics.median(cpu),
        "peak_memory_bytes": peak_memory(),
        **found,
    }


def _fixed(prepared: Prepared) -> tuple[sp.csr_array, IntArray, Array]:
    """Matrix, node of each unknown and load of the same bodies with the contact nodes fixed."""
    T = prepared.constraints.transform
    keep = np.setdiff1d(np.arange(T.shape[1]), prepared.condensed.dofs)
    K = sp.csr_array((T.T @ prepared.K @ T)[keep][:, keep])
    return K, prepared.constraints.nodes[keep], (T.T @ sum(prepared.loads.values()))[keep]


def _linear(K: sp.csr_array, nodes: IntArray, f: Array, backend: str, timer: Timer) -> float:
    """Seconds of one plain solve: analyse, factorise, solve."""
    began = timer()
    factorise(K, np.empty(0, int), nodes=nodes, backend=backend).reduce(f).expand(np.empty(0))
    return timer() - began
