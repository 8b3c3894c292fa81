# SPDX-License-Identifier: BSD-3-Clause
"""Friction with a shear limit: a node by hand, a sliding block, Tresca's law in closed form and as a convex minimum."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import lsq_linear

from signorini.engine.solve import solve
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.gallery.blocks import dragged_block
from signorini.gallery.half_planes import EQUAL, HALF_WIDTH, equal_half_planes
from signorini.law.friction import TabularFriction
from signorini.model.conditions import Support
from signorini.model.step import Step
from signorini.model.varying import Formula
from signorini.reference.tresca import LimitedShear
from signorini.verify.check import Check, checks_of
from signorini.verify.one_node import pressed_and_pulled


def shear_limits() -> Iterator[Check]:
    """A node that comes to its limit and leaves it, a block that slides under it, and Tresca's law."""
    yield from _one_node()
    yield from _sliding_block()
    yield from _convex_minimum()
    yield from _half_planes()


def _one_node() -> Iterator[Check]:
    """K = [[2, -1], [-1, 2]] in (gap, slip), pressed by 1, pulled to 4, mu 1, limit 0.4: p = 1 - s while it slips."""
    _, _, path = pressed_and_pulled(friction=1.0, limit=0.4)
    events: dict[str, float] = {event.what: 4.0 * event.factor for event in path.events}
    yield from checks_of(
        "one node with a shear limit, exact path",
        ("slips, at the limit, f_t", events["slips"], 0.4, 1e-12),
        ("leaves the limit, f_t", events["kinks"], 1.6, 1e-12),
        ("opens, f_t", events["opens"], 2.0, 1e-12),
        ("dissipation", path.end.dissipation[0], 0.4 * 0.6 + 0.5 * 0.4**2, 1e-12),
        source="by hand",
    )


def _sliding_block() -> Iterator[Check]:
    """A block that is dragged over a floor carries the limit times its area, however hard it is pressed."""
    model = dragged_block()
    contact = replace(model.contacts[0], friction="stick", shear_limit=0.01)
    dragged = replace(
        model, loads=model.loads[:1], supports=[Support("top", u=(0.2, None))], contacts=[contact], steps=[Step()]
    )
    for thickness in (1.0, 2.5):
        floor = solve(replace(dragged, thickness=thickness)).contact(contact.label)
        force = np.linalg.norm(floor.tangential_force)
        yield from checks_of(
            "block dragged over a floor, shear limit",
            (f"friction force over the limit, thickness {thickness:g}", force / 0.01, floor.area.sum(), 1e-10),
            source="limit times area",
        )


def friction_over_pressure() -> Iterator[Check]:
    """A block that is dragged over a floor, at pressures on all lines of a table of coefficients."""
    pressures, coefficients = [2.0, 5.0, 10.0], [0.4, 0.3, 0.2]
    model = dragged_block()
    dragged = replace(
        model,
        loads=[replace(model.loads[0], pressure=Formula("1 + 3*x"))],
        supports=[Support("top", u=(0.5, None), name="drag")],
        contacts=[replace(model.contacts[0], friction=TabularFriction(pressures, coefficients))],
        steps=[Step(scale={"press": 1.0, "drag": 0.0}), Step(scale={"drag": 1.0}, path="exact")],
    )
    step = solve(dragged).steps[1]
    floor = step.contacts[0]
    table = np.append(np.multiply(pressures, coefficients), 2.0 + (2.0 - 1.5) / 5.0 * 90.0)
    pressed = floor.pressure > 0.0
    carried = np.interp(floor.pressure, [0.0, *pressures, 100.0], [0.0, *table])[pressed]
    share = np.abs(floor.traction)[pressed] / carried
    yield from checks_of(
        "block dragged over a floor, friction over pressure",
        ("friction over that of the table, smallest", share.min(), 1.0, 1e-12),
        ("the same, largest", share.max(), 1.0, 1e-12),
        ("work less what is stored and dissipated, of the work", step.energy_defect / step.work, 0.0, 1e-13),
        source="the table",
    )


def _half_planes() -> Iterator[Check]:
    """Equal half-planes in Tresca's law, pulled by half of what they can carry."""
    a, limit, spacing = HALF_WIDTH, 0.1 * EQUAL.normal.peak_pressure, 0.025
    exact = LimitedShear(half_width=a, limit=limit)
    Q = limit * a
    pull = Q / (EQUAL.friction * EQUAL.normal.force)
    steps = [Step(scale={"press": 1.0, "pull": 0.0}), Step(scale={"pull": pull})]
    model = equal_half_planes(steps, spacing=spacing)
    contact = replace(model.contacts[0], friction="stick", shear_limit=limit)
    found = solve(replace(model, contacts=[contact])).contact("contact")
    x, case = found.points[:, 0], f"equal half-planes, Tresca's law, nodes at {spacing} a, exact path"
    off = np.abs(found.traction + exact.traction(x, Q))[np.abs(x) < 0.5 * a]
    yield from checks_of(
        case,
        ("c/a, to a node distance", np.abs(x[found.status == "stick"]).max() / a, 0.75**0.5, spacing),
        ("q(0) / limit", np.abs(found.traction)[np.abs(x).argmin()] / limit, 1.0 / 3.0, 0.01),
        ("q, largest error in |x| < a/2 / limit", off.max() / limit, 0.0, 0.02),
        source="strip that yields: Dugdale (1960)",
    )


def _convex_minimum() -> Iterator[Check]:
    """Bodies that stay pressed: forces minimise ``r'A r / 2 + c'r`` over p >= 0, ``|r_t| <= limit``."""
    rng, n = np.random.default_rng(0), 20
    Q, _ = np.linalg.qr(rng.normal(size=(2 * n, 2 * n)))
    W = (Q * rng.uniform(0.05, 0.95, 2 * n)) @ Q.T
    limit = rng.uniform(0.05, 1.0, n)
    pressed = np.append(rng.uniform(20.0, 30.0, n), np.zeros(n))
    problem = ContactProblem.of(
        W=(W + W.T) / 2,
        b=-W @ pressed + rng.normal(size=2 * n),
        friction=np.full(n, np.inf),
        limit=limit,
        motions=np.zeros((2 * n, 0)),
        scale=1.0,
    )
    result = solve_contact(problem)
    L = np.linalg.cholesky(problem.image.A)
    c = problem.free_motion(problem.b)
    box = (np.append(np.zeros(n), -limit), np.append(np.full(n, np.inf), limit))
    least = lsq_linear(L.T, -np.linalg.solve(L, c), bounds=box, tol=1e-14).x
    forces = np.append(result.normal_force, result.tangential_force)
    yield from checks_of(
        "Tresca's law, 20 random pairs",
        ("distance of the forces from the minimum of the energy", np.abs(forces - least).max(), 0.0, 1e-7),
        source="bounded least squares (scipy)",
    )
