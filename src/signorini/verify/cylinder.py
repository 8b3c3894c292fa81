# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder: its mesh, refined, its two formulations, and the Hertz limit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.engine.paper import formulate, solve_literally
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.gallery.cylinder import HERTZ, RADIUS, E, zhu_cylinder
from signorini.model.step import Step
from signorini.reference.hertz import HertzLine
from signorini.verify.check import Check

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
            yield Check(
                case=case,
                quantity=quantity,
                computed=float(contact.pressure[worst]),
                reference=float(exact[worst]),
                tolerance=tolerance,
                source="Hertz",
            )
        yield Check(
            case=case,
            quantity="normal force",
            computed=float(contact.normal_force[1]),
            reference=78.0,
            tolerance=1e-10,
            source="equilibrium",
        )


def refined() -> Iterator[Check]:
    """The finite body's pressure at the centre: uniform traction and rigid cut, without and with friction."""
    for words, friction, spread, reference in (
        ("traction, mu 0", 0.0, "traction", 36.01),
        ("traction, mu 0.4, one increment", 0.4, "traction", 38.06),
        ("rigid cut, mu 0", 0.0, "displacement", 37.69),
    ):
        model = zhu_cylinder(friction=friction, refine=8, spread="traction" if spread == "traction" else "displacement")
        yield Check(
            case="paper's cylinder, refined 8 times",
            quantity=f"p(0), {words}",
            computed=float(solve(model).contact("foundation").pressure[0]),
            reference=reference,
            tolerance=1e-3,
            source=_REFINED,
        )


def exact_path() -> Iterator[Check]:
    """With friction the load history counts: followed from event to event."""
    step = solve(zhu_cylinder(friction=0.4, refine=8, steps=[Step(name="press", path="exact")])).last
    case = "paper's cylinder, refined 8 times, exact path"
    yield Check(
        case=case,
        quantity="p(0), mu 0.4",
        computed=float(step.contacts[0].pressure[0]),
        reference=38.125,
        tolerance=1e-3,
        source=_REFINED + ", 38.11-38.14",
    )
    yield Check(
        case=case,
        quantity="work / (strain energy + dissipation)",
        computed=step.work / (step.strain_energy + step.dissipation),
        reference=1.0,
        tolerance=1e-8,
        source="first law",
    )


def increments_at_events() -> Iterator[Check]:
    """Increments that end where the events are reproduce the path; ever more equal ones approach it."""
    exact = solve(zhu_cylinder(friction=0.4, refine=2, steps=[Step(name="press", path="exact")])).last
    loads = sorted({event.load_factor for event in exact.events} | {1.0})
    aligned = solve(zhu_cylinder(friction=0.4, refine=2, steps=[Step(scale={"cut": s}, increments=1) for s in loads]))
    contact, case = exact.contacts[0], "paper's cylinder, refined twice, mu 0.4"
    size = float(contact.pressure.max())
    for quantity, found, tolerance in (
        ("increments that end at the events", aligned.contact("foundation"), 1e-11),
        ("500 equal increments", solve(zhu_cylinder(friction=0.4, refine=2, increments=500)).last.contacts[0], 1e-3),
    ):
        error = max(np.abs(found.pressure - contact.pressure).max(), np.abs(found.traction - contact.traction).max())
        yield Check(
            case=case,
            quantity=f"largest difference to the exact path / p(0), {quantity}",
            computed=float(error) / size,
            reference=0.0,
            tolerance=tolerance,
            source="each other",
        )


def literal_equals_compliance() -> Iterator[Check]:
    """The paper's LCP and the compliance formulation give one answer."""
    for friction in (0.0, 0.4):
        prepared = prepare(zhu_cylinder(friction=friction))
        for power in (0, 1, 2, 3):
            E_n = E * 10.0**power
            literal = solve_literally(formulate(prepared, E_n=E_n, E_tau=E_n))
            compliant = solve(zhu_cylinder(friction=friction, compliance=1.0 / E_n)).contact("foundation")
            difference = max(
                np.abs(literal.pressure - compliant.pressure).max(), np.abs(literal.traction - compliant.traction).max()
            )
            yield Check(
                case=f"literal and compliance formulation, mu {friction:g}",
                quantity=f"largest difference of tractions / p_0, E_n = 1e{power} E",
                computed=float(difference / HERTZ.peak_pressure),
                reference=0.0,
                tolerance=1e-10,
                source="each other",
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
    case = "cylinder, a/R = 0.01"
    yield Check(
        case=case,
        quantity="p(0)",
        computed=float(contact.pressure[0]),
        reference=hertz.peak_pressure,
        tolerance=5e-3,
        source="Hertz",
    )
    closed = contact.points[contact.closed, 0].max()
    yield Check(
        case=case,
        quantity="half-width, to a node distance",
        computed=float(closed),
        reference=half_width,
        tolerance=0.025,
        source="Hertz",
    )
