# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder: its mesh, refined, its two formulations, and the Hertz limit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.engine.paper import PaperAnswer, formulate, solve_literally
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.gallery.cylinder import HERTZ, RADIUS, E, zhu_cylinder
from signorini.model.step import Step
from signorini.reference.hertz import HertzLine
from signorini.solution.results import ContactResult
from signorini.verify.check import Check, checks_of

_REFINED = "refined independent computation"


def paper_mesh() -> Iterator[Check]:
    """76 quadrilaterals: nodal pressures against Hertz, the force against the load, for any penalty."""
    for power in (1, 2, 4, 8, 12, 16, None):
        compliance = 0.0 if power is None else 1.0 / (E * 10.0**power)
        contact = solve(zhu_cylinder(friction=0.0, compliance=compliance)).contact("foundation")
        x, exact = contact.points[:6, 0], HERTZ.pressure(contact.points[:6, 0])
        case = "paper's cylinder, 76 cells, " + ("exact law" if power is None else f"E_n = 1e{power} E")
        for quantity, part, tolerance in (("p, worst x <= 2", x < 2.25, 0.04), ("p at x = 2.5", x > 2.25, 0.10)):
            worst = np.argmax(np.where(part, np.abs(contact.pressure[:6] / exact - 1.0), -1.0))
            yield from checks_of(case, (quantity, contact.pressure[worst], exact[worst], tolerance), source="Hertz")
        yield from checks_of(case, ("normal force", contact.normal_force[1], 78.0, 1e-10), source="equilibrium")


def refined() -> Iterator[Check]:
    """The finite body's pressure at the centre: uniform traction and rigid cut, without and with friction."""
    for words, model, reference in (
        ("traction, mu 0", zhu_cylinder(friction=0.0, refine=8), 36.01),
        ("traction, mu 0.4, one increment", zhu_cylinder(refine=8), 38.06),
        ("rigid cut, mu 0", zhu_cylinder(friction=0.0, refine=8, spread="displacement"), 37.69),
    ):
        pressure = solve(model).contact("foundation").pressure
        yield from checks_of(
            "paper's cylinder, refined 8 times", (f"p(0), {words}", pressure[0], reference, 1e-3, _REFINED)
        )


def exact_path() -> Iterator[Check]:
    """With friction the load history counts: followed from event to event."""
    step = solve(zhu_cylinder(friction=0.4, refine=8, steps=[Step(name="press", path="exact")])).last
    balance = step.work / (step.strain_energy + step.dissipation)
    yield from checks_of(
        "paper's cylinder, refined 8 times, exact path",
        ("p(0), mu 0.4", step.contacts[0].pressure[0], 38.125, 1e-3, f"{_REFINED}, 38.11-38.14"),
        ("work / (strain energy + dissipation)", balance, 1.0, 1e-8, "first law"),
    )


def increments_at_events() -> Iterator[Check]:
    """Increments that end where the events are reproduce the path; ever more equal ones approach it."""
    exact = solve(zhu_cylinder(friction=0.4, refine=2, steps=[Step(name="press", path="exact")])).last
    loads = sorted({event.load_factor for event in exact.events} | {1.0})
    aligned = solve(zhu_cylinder(friction=0.4, refine=2, steps=[Step(scale={"cut": s}, increments=1) for s in loads]))
    equal = solve(zhu_cylinder(friction=0.4, refine=2, steps=[Step(increments=500)]))
    contact = exact.contacts[0]
    for quantity, found, tolerance in (
        ("increments that end at the events", aligned.contact("foundation"), 1e-11),
        ("500 equal increments", equal.contact("foundation"), 1e-3),
    ):
        error = _difference(found, contact) / contact.pressure.max()
        yield from checks_of(
            "paper's cylinder, refined twice, mu 0.4",
            (f"largest difference to the exact path / p(0), {quantity}", error, 0.0, tolerance, "each other"),
        )


def _difference(one: ContactResult | PaperAnswer, other: ContactResult) -> float:
    """The largest of pressures and tractions."""
    return max(np.abs(one.pressure - other.pressure).max(), np.abs(one.traction - other.traction).max())


def literal_equals_compliance() -> Iterator[Check]:
    """The paper's LCP and the compliance formulation give one answer."""
    for friction in (0.0, 0.4):
        prepared = prepare(zhu_cylinder(friction=friction))
        for power in (0, 1, 2, 3):
            E_n = E * 10.0**power
            literal = solve_literally(formulate(prepared, E_n=E_n, E_tau=E_n))
            compliant = solve(zhu_cylinder(friction=friction, compliance=1.0 / E_n)).contact("foundation")
            difference = _difference(literal, compliant) / HERTZ.peak_pressure
            yield from checks_of(
                f"literal and compliance formulation, mu {friction:g}",
                (f"largest difference of tractions / p_0, E_n = 1e{power} E", difference, 0.0, 1e-10, "each other"),
            )


def small_load() -> Iterator[Check]:
    """a/R -> 0: Hertz himself."""
    half_width = 0.01 * RADIUS
    force = HERTZ.force * (half_width / HERTZ.half_width) ** 2
    hertz = HertzLine(force=force, radius=RADIUS, modulus=HERTZ.modulus)
    model = zhu_cylinder(
        friction=0.0, force=force, contact_length=2.0 * half_width, contact_spacing=half_width / 10, refine=4
    )
    contact = solve(model).contact("foundation")
    yield from checks_of(
        "cylinder, a/R = 0.01",
        ("p(0)", contact.pressure[0], hertz.peak_pressure, 5e-3),
        ("half-width, to a node distance", contact.points[contact.closed, 0].max(), half_width, 0.025),
        source="Hertz",
    )
