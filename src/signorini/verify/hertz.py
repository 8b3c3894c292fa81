# SPDX-License-Identifier: BSD-3-Clause
"""Hertz at small a/R: pressure, its oscillation where meshes do not match, width, and stresses below the contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.api import solve
from signorini.arrays import Array
from signorini.gallery.hertz import LINE_FORCE, LOWER, MODULUS, POINT_FORCE, RADIUS, SEAT, hertz_contact
from signorini.meshing.plane import Cells, quarter_disk
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.reference.hertz import HertzLine, contact_modulus
from signorini.reference.hertz_point import HertzPoint
from signorini.solved import Solution
from signorini.verify.check import Check, checks_of

_LINE = HertzLine(force=LINE_FORCE, radius=RADIUS, modulus=MODULUS)
_POINT = HertzPoint(force=POINT_FORCE, radius=RADIUS, modulus=MODULUS)
_BALL, _BALL_RADIUS = Elastic(E=20000.0, nu=0.3), 50.0
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
    yield from checks_of(
        case,
        ("p_0", pressure[0], hertz.peak_pressure, 0.01),
        ("a, to a cell", contact.points[contact.closed, 0].max(), 1.0, SEAT / across[0]),
        ("largest error of p / p_0, x < 0.85 a", np.abs(defect).max(), 0.0, 0.015),
        ("oscillation of p / p_0 from node to node, x < 0.85 a", _oscillation(defect), 0.0, 0.005),
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
    yield from checks_of(
        case,
        ("largest error of the stresses / p_0, 0.2 a < z < 2 a", worst / hertz.peak_pressure, 0.0, 0.01),
        ("largest shear stress / p_0", shear[0], shear[1], 0.01),
        source=source,
    )


def revolved_spheres() -> Iterator[Check]:
    """B03: spheres of radius 50 whose equators approach by 4, as one on its plane of symmetry and as two."""
    half = _half_sphere(0.5)
    coarser = _half_sphere(0.75)
    two = Model(
        join({"upper": half, "lower": replace(coarser, points=np.array(coarser.points) * [1.0, -1.0])}),
        kind="axisymmetric",
        bodies=[Body("upper", _BALL), Body("lower", _BALL)],
        supports=[Support("upper.cut", u=(None, -2.0)), Support("lower.cut", u=(None, 2.0))],
        contacts=[Contact("upper.arc", "lower.arc", side="coarser", name="contact")],
    )
    for words, model, name in (
        ("one on its plane of symmetry", _sphere_on_its_plane(half, 4.0), "disk"),
        ("two that do not match", two, "upper"),
    ):
        found, by_approach, by_force = _centre(model, name, 4.0)
        known = "Hertz; Code_Aster SSNV104; a finite body is stiffer"
        yield from checks_of(
            f"B03 equal spheres, a/R 0.2, {words}",
            ("sigma_zz at the centre, for the approach of 4", found, by_approach, 0.05, known),
            ("sigma_zz at the centre, for the force it takes", found, by_force, 0.03, "Hertz"),
        )


def small_revolved_spheres() -> Iterator[Check]:
    """B03 with smaller approaches, and with finer cells: what is left at a/R = 0.2 is the finite body, not the mesh."""
    excess = {}
    for approach, cells in ((4.0, 15), (4.0, 30), (1.0, 30), (0.25, 30)):
        width = 1.5 * float(np.sqrt(0.5 * approach * _BALL_RADIUS))
        mesh = quarter_disk(radius=_BALL_RADIUS, contact_length=width, contact_spacing=width / cells, order=2)
        found, by_approach, _ = _centre(_sphere_on_its_plane(mesh, approach), "disk", approach)
        excess[approach, cells] = found / by_approach - 1.0
    case = "B03 equal spheres, quad8: excess of sigma_zz at the centre over Hertz at the same approach"
    yield from checks_of(
        case,
        ("a/R 0.2: change with cells of half the size", excess[4.0, 30] - excess[4.0, 15], 0.0, 0.003, "each other"),
        ("a/R 0.1", excess[1.0, 30], 0.0, 0.03, "Hertz"),
        ("a/R 0.05", excess[0.25, 30], 0.0, 0.015, "Hertz"),
        ("half as large where a/R is, 0.2 to 0.1", excess[1.0, 30] / excess[4.0, 30], 0.5, 0.2, "expansion in a/R"),
        ("half as large where a/R is, 0.1 to 0.05", excess[0.25, 30] / excess[1.0, 30], 0.5, 0.2, "expansion in a/R"),
    )


def _half_sphere(spacing: float) -> Mesh:
    return quarter_disk(radius=_BALL_RADIUS, contact_length=15.0, contact_spacing=spacing)


def _sphere_on_its_plane(mesh: Mesh, approach: float) -> Model:
    return Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("disk", _BALL)],
        supports=[Support("cut", u=(None, -0.5 * approach))],
        contacts=[Contact("arc", Plane(point=(0, 0), normal=(0, 1)), name="contact")],
    )


def _centre(model: Model, body: str, approach: float) -> tuple[float, float, float]:
    """Stress across the contact at its centre: as found, by Hertz for the approach, by Hertz for the force it took."""
    solution, modulus = solve(model), contact_modulus((_BALL.E, _BALL.nu))
    force = float(np.abs(solution.contact("contact").normal_force[1]))
    by_force = HertzPoint(force=force, radius=_BALL_RADIUS, modulus=modulus).peak_pressure
    by_approach = 2.0 * modulus / np.pi * float(np.sqrt(0.5 * approach / _BALL_RADIUS))
    return float(solution.along([(0.0, 0.0)], body=body).stress[0, 1]), -by_approach, -by_force
