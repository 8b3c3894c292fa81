# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact: the paper's cylinder against one plain linear solve of the same matrix."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.clock import Clock
from signorini.gallery.cylinder import zhu_cylinder
from signorini.linalg.registry import factorise
from signorini.memory import peak_memory
from signorini.model.model import Model
from signorini.prepare import Prepared, prepare
from signorini.solve import solve_prepared

REPEATS = 5
_LONG, _LEAST = 20.0, 3  # seconds, and how many repeats have to do where they take longer


def cylinder(dofs: int) -> Iterator[dict[str, Any]]:
    """Time the cylinder with about ``dofs`` unknowns, mu = 0 and 0.4, one increment.

    Yields
    ------
    rows of the contract; contact and linear solves are interleaved, after one warm-up, and medians are given.
    contact_seconds : all after assembly, up to tractions, displacements and the certificate
    linear_seconds : analyse, factorise and solve the same matrix with the contact nodes fixed, same back end
    ratio : of the two
    """
    warm = solve_prepared(prepare(zhu_cylinder(refine=2)))
    _linear(prepare(zhu_cylinder(refine=2)), warm.backend)
    refine = max(1, round(np.sqrt(dofs / (2 * 76))))
    for friction in (0.0, 0.4):
        yield _measure(zhu_cylinder(friction=friction, refine=refine))


def _measure(model: Model) -> dict[str, Any]:
    contact: list[float] = []
    linear: list[float] = []
    assembly: list[float] = []
    cpu: list[float] = []
    while len(contact) < _LEAST or (len(contact) < REPEATS and sum(contact) + sum(linear) < _LONG):
        clock, began, cpu_began = Clock(), time.perf_counter(), time.process_time()
        prepared = prepare(model, clock=clock)
        history = solve_prepared(prepared)
        cpu.append(time.process_time() - cpu_began)
        assembly.append(clock.seconds["assembly"])
        contact.append(time.perf_counter() - began - assembly[-1])
        linear.append(_linear(prepared, history.backend))
    return {
        "name": "cylinder",
        "dofs": len(prepared.constraints.nodes),
        "contact_pairs": history.pairs,
        "friction": model.contacts[0].coefficient,
        "path": history.last.path,
        "backend": history.backend,
        "default": True,
        "assembly_seconds": statistics.median(assembly),
        "contact_seconds": statistics.median(contact),
        "linear_seconds": statistics.median(linear),
        "ratio": statistics.median(contact) / statistics.median(linear),
        "cpu_seconds": statistics.median(cpu),
        "peak_memory_bytes": peak_memory(),
        "iterations": sum(history.last.iterations),
    }


def _linear(prepared: Prepared, backend: str) -> float:
    """Seconds of one plain solve with the contact nodes fixed."""
    T = prepared.constraints.transform
    keep = np.setdiff1d(np.arange(T.shape[1]), prepared.condensed.dofs)
    K = sp.csr_array((T.T @ prepared.K @ T)[keep][:, keep])
    f = (T.T @ sum(prepared.loads.values()))[keep]
    began = time.perf_counter()
    factorise(K, np.empty(0, int), nodes=prepared.constraints.nodes[keep], backend=backend).expand(f, np.empty(0))
    return time.perf_counter() - began
