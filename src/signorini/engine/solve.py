# SPDX-License-Identifier: BSD-3-Clause
"""Follow the load history of a model: steps, increments, certificates. Model in, history out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, frozen
from signorini.clock import Clock
from signorini.engine.prepare import Prepared, prepare
from signorini.errors import SolveFailed
from signorini.fem.rigid import describe_motion
from signorini.friction.law import OPEN, STICK
from signorini.friction.result import CoulombResult
from signorini.friction.solve import solve_coulomb
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.solution import results
from signorini.solution.certificate import Certificate, certify
from signorini.solution.history import History
from signorini.solution.results import ContactResult, StepResult
from signorini.solution.state import State, initial_state, next_state

ONE_INCREMENT = "one increment: assumes that the final state was reached from zero slip"
"""What a step with friction says when it was solved in one increment (METHOD 5)."""

GROWN = "the contact grew under friction: in one increment tractions can be off by tens of percent, take more"
"""What it says further where pairs closed that were open before."""

_BALANCED = 1e-10  # of the sizes of the data: what equilibrium may lack before it is refined
_REFINEMENTS = 2


def solve(model: Model, *, backend: str = "auto", raise_on_failure: bool = True, clock: Clock | None = None) -> History:
    """Solve every step of a model and certify every increment; see :func:`signorini.api.solve`, which dresses it."""
    return solve_prepared(prepare(model, backend=backend, clock=clock), raise_on_failure=raise_on_failure)


def solve_prepared(prepared: Prepared, *, raise_on_failure: bool = True) -> History:
    """Solve the load history of a prepared model; see :func:`solve`.

    Pairs that were left out as too far apart are looked at after every increment; where one has met the other side, or
    nothing was found without them, everything is solved again with all pairs.
    """
    history = _follow(prepared)
    if prepared.limited and not history.solved:
        history = _follow(prepared.widened())
    if raise_on_failure and not history.solved:
        raise SolveFailed(history.message, status=history.status, solution=history)
    return history


def _follow(prepared: Prepared) -> History:
    """Step after step, increment after increment, up to the end or to what stops it."""
    model = prepared.model
    factors = model.factors()
    state = initial_state(factors[0], prepared.space.number_of_dofs, prepared.interface.gap)
    steps: list[StepResult] = []
    increments_done, total = 0, sum(step.increments for step in model.steps)
    try:
        for number, (step, end) in enumerate(zip(model.steps, factors[1:], strict=True), start=1):
            first, certificates, answers = state, [], []
            for fraction, target in _increments(step, state.factors, end):
                where = f"step '{step.name}' at {fraction:.0%}" if step.name else f"step {number} at {fraction:.0%}"
                prepared.clock.increment(where, increments_done, total)
                increments_done += 1
                state, certificate, result = _advance(prepared, state, target, where)
                certificates.append(certificate)
                answers.append(result)
            steps.append(_step_result(prepared, step, number, first, state, certificates, answers))
    except SolveFailed as failure:
        return _history(prepared, failure.status, str(failure), steps)
    return _history(prepared, "solved", "", steps)


def _increments(
    step: Step, start: Mapping[str, float], end: Mapping[str, float]
) -> Iterator[tuple[float, Mapping[str, float]]]:
    """Equal parts of the straight segment between two sets of load factors: fraction and factors at the end of each."""
    for k in range(1, step.increments + 1):
        t = k / step.increments
        yield t, {name: (1.0 - t) * start[name] + t * end[name] for name in end} if t < 1.0 else end


def _advance(
    prepared: Prepared, state: State, factors: Mapping[str, float], where: str
) -> tuple[State, Certificate, CoulombResult]:
    """One increment: from a state to the next at given load factors."""
    condensed, constraints, interface = prepared.condensed, prepared.constraints, prepared.interface
    n, rows, active = len(interface), condensed.active_rows, condensed.active
    loads = sum((factors[name] * f for name, f in prepared.loads.items()), np.zeros(prepared.space.number_of_dofs))
    imposed = sum((factors[name] * u for name, u in constraints.prescribed.items()), np.zeros_like(loads))
    offset = np.concatenate([interface.gap, -state.tangential]) + interface.B @ imposed
    _refuse_overlap(prepared, offset[:n], where)
    f = constraints.transform.T @ (loads - prepared.K @ imposed)
    result, forces, moved, free = _balanced(prepared, f, offset, state)
    if not result.solved:
        raise SolveFailed(f"{where}: {_explain(prepared, result)}", status=result.outcome)
    with prepared.clock.phase("recovery"):
        displacement = constraints.transform @ free + imposed
        outside = np.setdiff1d(np.arange(2 * n), rows)
        moved[outside] = (offset + interface.B @ (displacement - imposed))[outside]
        status = np.full(n, OPEN)
        status[active] = result.state
        new = next_state(
            state,
            prepared.K,
            constraints,
            interface,
            factors=factors,
            loads=loads,
            displacement=displacement,
            forces=forces,
            moved=moved,
            status=status,
        )
    return new, _certified(prepared, loads, new, state.tangential, where), result


def _certified(prepared: Prepared, loads: Array, state: State, before: Array, where: str) -> Certificate:
    """Measure a state; what does not pass is no solution."""
    certificate = certify(
        prepared.K,
        loads,
        prepared.motions,
        prepared.constraints,
        prepared.interface,
        state,
        before,
        prepared.scale,
    )
    if certificate.passed:
        return certificate
    raise SolveFailed(
        f"{where}: the solver's answer did not pass the certificate ({certificate}); badly scaled data (extreme ratios "
        "of moduli, sizes or compliances) are the usual cause",
        status="not_found",
    )


def _balanced(prepared: Prepared, f: Array, offset: Array, state: State) -> tuple[CoulombResult, Array, Array, Array]:
    """The contact problem under the load f on the free displacements: result, forces, motions, free displacements.

    What equilibrium and the motions of the pairs lack in the end, on the problem as posed, is given to the condensed
    problem as a further load and offset: it was condensed with rounding, which gaps far larger than what the loads
    move (an arc that leaves its foundation) magnify.
    """
    condensed, interface, scale, law = prepared.condensed, prepared.interface, prepared.scale, prepared.law
    n, rows, T = len(interface), condensed.active_rows, prepared.constraints.transform
    forces, moved, free = np.zeros(2 * n), np.zeros(2 * n), np.zeros_like(f)
    load, start = f, state.status[condensed.active] if state.forces.any() else None
    lacking = np.zeros(len(rows))
    guided = np.tile(law.locked, 2)
    for _ in range(_REFINEMENTS + 1):
        with prepared.clock.phase("complementarity"):
            f_c = condensed.condensed_load(load)
            b = condensed.right_hand_side(f_c, offset[rows], law.motions) + condensed.root * lacking
            result = solve_coulomb(replace(law, b=b), start)
        if not result.solved:
            break
        with prepared.clock.phase("recovery"):
            forces[rows] = condensed.root * np.concatenate([result.normal_force, result.tangential_force])
            moved[rows] = np.concatenate([result.gap, result.slip]) / condensed.root
            free = condensed.displacement(load, f_c, moved[rows], forces[rows], offset[rows])
            u = T @ free
            residual = f + T.T @ (interface.B.T @ forces - prepared.K @ u)
            misfit = (offset + interface.B @ u - moved)[rows] + condensed.compliance * forces[rows]
            misfit[guided] = 0.0
        size = max(np.abs(residual).max(initial=0.0) / scale.force, np.abs(misfit).max(initial=0.0) / scale.length)
        if size <= _BALANCED:
            break
        load, lacking, start = load + residual, lacking + misfit, result.state
    return result, forces, moved, free


def _refuse_overlap(prepared: Prepared, gap: Array, where: str) -> None:
    """Supports that hold both sides of a pair decide its gap; no force can mend an overlap there."""
    held = np.nonzero(prepared.condensed.held & (gap < -1e-12 * prepared.scale.length))[0]
    if len(held):
        pair = held[np.argmin(gap[held])]
        contact = prepared.model.contacts[prepared.interface.contact[pair]]
        raise SolveFailed(
            f"{where}: contact '{contact.label}': supports press node {prepared.interface.node[pair] + 1} "
            f"{-gap[pair]:.4g} into the other side and leave it no way out",
            status="no_equilibrium",
        )


def _explain(prepared: Prepared, result: CoulombResult) -> str:
    """The reason, and the bodies that leave by name."""
    if result.escape is None or not prepared.law.floating:
        return result.message
    coefficients, *_ = np.linalg.lstsq(prepared.law.motions, result.escape, rcond=None)
    return f"{describe_motion(prepared.parts, prepared.floating @ coefficients)}: {result.message}"


def _step_result(
    prepared: Prepared,
    step: Step,
    number: int,
    before: State,
    state: State,
    certificates: list[Certificate],
    answers: list[CoulombResult],
) -> StepResult:
    model, interface = prepared.model, prepared.interface
    compliance = np.concatenate([interface.normal_compliance, interface.tangential_compliance])
    return StepResult(
        name=step.name or f"step {number}",
        path="single" if step.increments == 1 else "increments",
        load_factor=float(number),
        increments=step.increments,
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
        trace=tuple(answer.trace for answer in answers),
        notes=_notes(prepared, step, before, state),
    )


def _notes(prepared: Prepared, step: Step, before: State, state: State) -> tuple[str, ...]:
    """What a reader should know of how the step was followed."""
    friction = prepared.interface.friction
    rubbing = (friction > 0) & np.isfinite(friction)
    if step.increments > 1 or not rubbing.any():
        return ()
    closed = rubbing & (state.status != OPEN) & (before.gap > 1e-9 * prepared.scale.length)
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


def _history(prepared: Prepared, status: str, message: str, steps: list[StepResult]) -> History:
    return History(
        model=prepared.model,
        status=status,
        message=message,
        steps=tuple(steps),
        backend=prepared.condensed.factorisation.name,
        timings=dict(prepared.clock.seconds),
        pairs=len(prepared.interface),
    )
