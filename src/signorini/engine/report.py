# SPDX-License-Identifier: BSD-3-Clause
"""From the states of a step to its results: resultants, energies, arrays over the contact nodes, notes."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, frozen
from signorini.engine.leg import Leg
from signorini.engine.prepare import Prepared
from signorini.friction.law import OPEN, STICK
from signorini.model.step import Step
from signorini.solution import results
from signorini.solution.certificate import Certificate
from signorini.solution.results import ContactResult, StepResult
from signorini.solution.state import State

ONE_INCREMENT = "one increment: assumes that the final state was reached from zero slip"
"""What a step with friction says when it was solved in one increment (METHOD 5)."""

GROWN = "the contact grew under friction: in one increment tractions can be off by tens of percent, take more"
"""What it says further where pairs closed that were open before."""


def step_result(prepared: Prepared, step: Step, number: int, leg: Leg) -> StepResult:
    """Results at the end of step ``number`` (1, 2, ...)."""
    before, state, certificates = leg.before, leg.after, leg.certificates
    model, interface = prepared.model, prepared.interface
    compliance = np.concatenate([interface.normal_compliance, interface.tangential_compliance])
    return StepResult(
        name=step.name or f"step {number}",
        path=leg.path,
        load_factor=float(number),
        increments=0 if leg.path == "exact" else len(leg.trace),
        events=leg.events,
        displacement=frozen(state.displacement.reshape(-1, model.dimension)),
        reactions=_reactions(prepared, state),
        strain_energy=0.5 * float(state.displacement @ (prepared.K @ state.displacement)),
        interface_energy=0.5 * float(state.forces**2 @ (compliance / np.tile(interface.area, 2))),
        work=state.work - before.work,
        certificate=Certificate(
            **{key: max(getattr(c, key) for c in certificates) for key in Certificate.__dataclass_fields__}
        ),
        contacts=tuple(
            _contact_result(prepared, i, before, state, interface.contact == i) for i in range(len(model.contacts))
        ),
        trace=leg.trace,
        notes=_notes(prepared, leg),
    )


def _notes(prepared: Prepared, leg: Leg) -> tuple[str, ...]:
    """What a reader should know of how the step was followed."""
    friction = prepared.interface.friction
    rubbing = (friction > 0) & np.isfinite(friction)
    if leg.path != "single" or not rubbing.any():
        return leg.notes
    closed = rubbing & (leg.after.status != OPEN) & (leg.before.gap > 1e-9 * prepared.scale.length)
    return (ONE_INCREMENT, GROWN) if closed.any() else (ONE_INCREMENT,)


def _reactions(prepared: Prepared, state: State) -> dict[str, Array]:
    """Forces of the supports on the bodies, by name."""
    owner, d = prepared.constraints.owner, prepared.model.dimension
    total = np.zeros((len(prepared.model.supports) + 1, d))
    # a support's force is what equilibrium takes beyond the loads that act on the held node itself
    loads = sum((state.factors[name] * f for name, f in prepared.loads.items()), np.zeros(len(owner)))
    np.add.at(total, (owner, np.arange(len(owner)) % d), np.where(owner >= 0, state.external - loads, 0.0))
    return {support.label: frozen(total[i]) for i, support in enumerate(prepared.model.supports)}


def _contact_result(prepared: Prepared, i: int, before: State, state: State, own: Array) -> ContactResult:
    interface, n = prepared.interface, len(prepared.interface)
    normal, tangential, friction = state.forces[:n][own], state.forces[n:][own], interface.friction[own]
    code = state.status[own]
    bound = np.zeros(len(normal))
    np.multiply(friction, normal, out=bound, where=normal > 0)
    # a pair that a support guides carries no friction: it touches without slipping
    sticks = (code == STICK) | ((friction > 0) & (np.abs(tangential) < (1.0 - 1e-9) * bound))
    status = np.where(code == OPEN, results.OPEN, np.where(sticks, results.STICK, results.SLIP))
    area = interface.area[own]
    overlap = interface.normal_compliance[own] * normal / area
    return ContactResult(
        name=prepared.model.contacts[i].label,
        nonmortar=interface.sides[i].nonmortar,
        mortar=interface.sides[i].mortar,
        coupling=interface.sides[i].coupling,
        node=frozen(interface.node[own], np.int64),
        points=frozen(prepared.model.mesh.points[interface.node[own]]),
        normals=frozen(interface.normals[own]),
        tangents=frozen(interface.tangents[own]),
        area=frozen(area),
        gap=frozen(state.gap[own] - overlap),
        pressure=frozen(normal / area),
        traction=frozen(tangential / area),
        slip=frozen(state.slip[own]),
        status=status,
        dissipation=float((state.dissipation - before.dissipation)[own].sum()),
    )
