# SPDX-License-Identifier: BSD-3-Clause
"""Hertz at small a/R: pressure, its oscillation where meshes do not match, width, and stresses below the contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.api import Solution, solve
from signorini.arrays import Array
from signorini.fem.generators import Cells, quarter_disk
from signorini.gallery.hertz import LINE_FORCE, LOWER, MODULUS, POINT_FORCE, RADIUS, SEAT, hertz_contact
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Kind, Model
from signorini.model.obstacle import Plane
from signorini.reference.hertz import HertzLine, HertzPoint, contact_modulus
from signorini.verify.check import Check

_LINE = HertzLine(force=LINE_FORCE, radius=RADIUS, modulus=MODULUS)
_POINT = HertzPoint(force=POINT_FORCE, radius=RADIUS, modulus=MODULUS)
_INSIDE = 0.85
"""Part of the half-width where pressures are compared: at the edge they are steeper than a cell."""

_Meshes = tuple[tuple[Cells, tuple[int, int]], ...]
_LINES: _Meshes = (("quad", (26, 26)), ("quad", (26, 39)), ("quad8", (13, 20)), ("triangle6", (13, 20)))
_POINTS: _Meshes = (("quad", (40, 40)), ("quad", (40, 60)), ("quad8", (20, 30)))
"""Cells, and how many of the upper and the lower body where they may touch."""


def line_contact() -> Iterator[Check]:
    """B01: two cylinders on meshes that match or not, linear and quadratic cells."""
    for cells, across in _LINES:
        yield from _contact("plane strain", cells, across)


def point_contact() -> Iterator[Check]:
    """B02: two spheres."""
    for cells, across in _POINTS:
        yield from _contact("axisymmetric", cells, across)


def _contact(kind: Kind, cells: Cells, across: tuple[int, int]) -> Iterator[Check]:
    """Pressure and width of a contact of half-width 1."""
    hertz, words = (_LINE, "B01 Hertz line") if kind == "plane strain" else (_POINT, "B02 Hertz point")
    case = f"{words} contact, a/R 0.001, {cells}, {across[0]} : {across[1]} cells"
    contact = solve(hertz_contact(kind=kind, across=across, cells=cells)).contact("contact")
    order = np.argsort(contact.points[:, 0])
    x, pressure = contact.points[order, 0], contact.pressure[order]
    defect = (pressure - hertz.pressure(x))[x < _INSIDE] / hertz.peak_pressure
    for quantity, computed, reference, tolerance in (
        ("p_0", pressure[0], hertz.peak_pressure, 0.01),
        ("a, to a cell", contact.points[contact.closed, 0].max(), 1.0, SEAT / across[0]),
        ("largest error of p / p_0, x < 0.85 a", np.abs(defect).max(), 0.0, 0.015),
        ("oscillation of p / p_0 from node to node, x < 0.85 a", _oscillation(defect), 0.0, 0.005),
    ):
        yield Check(
            case=case,
            quantity=quantity,
            computed=float(computed),
            reference=reference,
            tolerance=tolerance,
            source="Johnson (1985), chapter 4",
        )


def _oscillation(defect: Array) -> float:
    """The largest difference of a node to the mean of its neighbours."""
    return float(np.abs(defect[1:-1] - 0.5 * (defect[2:] + defect[:-2])).max())


def below_the_contact() -> Iterator[Check]:
    """B01, B02: stresses of the lower body on the axis, and where it would yield first."""
    depth = np.linspace(0.2, 2.0, 91)
    below = np.column_stack([np.zeros_like(depth), -depth])
    source = "Johnson (1985), sections 3.4 and 4.2"
    plane = solve(hertz_contact(across=(20, 30), cells="quad8"))
    yield from _axis("B01 on the axis, quad8", _found(plane, below), _LINE.axis_stress(depth), _LINE, source)
    revolved = solve(hertz_contact(kind="axisymmetric", across=(20, 30), cells="quad8"))
    exact = _POINT.axis_stress(depth, LOWER.nu)
    yield from _axis("B02 on the axis, quad8", _found(revolved, below), exact, _POINT, source)


def _found(solution: Solution, below: Array) -> tuple[Array, Array]:
    stress = solution.along(below, body="lower").stress
    return stress[:, 0], stress[:, 1]


def _axis(
    case: str, found: tuple[Array, Array], exact: tuple[Array, Array], hertz: HertzLine | HertzPoint, source: str
) -> Iterator[Check]:
    worst = max(float(np.abs(one - other).max()) for one, other in zip(found, exact, strict=True))
    shear = [float(np.abs(across - along).max()) / 2.0 / hertz.peak_pressure for across, along in (found, exact)]
    for quantity, computed, reference in (
        ("largest error of the stresses / p_0, 0.2 a < z < 2 a", worst / hertz.peak_pressure, 0.0),
        ("largest shear stress / p_0", shear[0], shear[1]),
    ):
        yield Check(case=case, quantity=quantity, computed=computed, reference=reference, tolerance=0.01, source=source)


def equal_spheres() -> Iterator[Check]:
    """B03: spheres of radius 50 whose equators approach by 4, as one on its plane of symmetry and as two."""
    radius, approach, body = 50.0, 4.0, Elastic(E=20000.0, nu=0.3)
    modulus = contact_modulus((body.E, body.nu))
    reference = -2.0 * modulus / np.pi * float(np.sqrt(0.5 * approach / radius))
    half = quarter_disk(radius=radius, contact_length=15.0, contact_spacing=0.5)
    one = Model(
        half,
        kind="axisymmetric",
        bodies=[Body("disk", body)],
        supports=[Support("cut", u=(None, -0.5 * approach))],
        contacts=[Contact("arc", Plane(point=(0, 0), normal=(0, 1)), name="contact")],
    )
    coarser = quarter_disk(radius=radius, contact_length=15.0, contact_spacing=0.75)
    two = Model(
        join({"upper": half, "lower": replace(coarser, points=np.array(coarser.points) * [1.0, -1.0])}),
        kind="axisymmetric",
        bodies=[Body("upper", body), Body("lower", body)],
        supports=[Support("upper.cut", u=(None, -0.5 * approach)), Support("lower.cut", u=(None, 0.5 * approach))],
        contacts=[Contact("upper.arc", "lower.arc", side="coarser", name="contact")],
    )
    for words, model, name in (("one on its plane of symmetry", one, "disk"), ("two that do not match", two, "upper")):
        solution = solve(model)
        force = float(np.abs(solution.contact("contact").normal_force[1]))
        hertz = HertzPoint(force=force, radius=radius, modulus=modulus)
        found = float(solution.along([(0.0, 0.0)], body=name).stress[0, 1])
        for quantity, peak, tolerance, source in (
            ("for the approach of 4", reference, 0.05, "Hertz; Code_Aster SSNV104; a finite body is stiffer"),
            ("for the force it takes", -hertz.peak_pressure, 0.03, "Hertz"),
        ):
            yield Check(
                case=f"B03 equal spheres, a/R 0.2, {words}",
                quantity=f"sigma_zz at the centre, {quantity}",
                computed=found,
                reference=peak,
                tolerance=tolerance,
                source=source,
            )
