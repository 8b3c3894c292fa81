# SPDX-License-Identifier: BSD-3-Clause
"""B09: press fits, shrink fits, and hollow bodies in two parts, against Lame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.engine.solve import solve
from signorini.gallery.press_fit import press_fit
from signorini.meshing.plane import Cells, annulus
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.reference.lame import hollow_sphere, press_fit_pressure, thick_cylinder
from signorini.verify.check import Check, checks_of, farthest

_SOURCE = "Lame; Timoshenko, Goodier section 28"
_EXPANSION, _COOLING = 1e-3, -5.0  # per degree, degrees
_HALVES: tuple[tuple[Cells, int | tuple[int, int]], ...] = (
    ("quad", 64),
    ("quad8", (24, 16)),
    ("triangle6", (16, 24)),
)
"""Cells, and how many of either part are along the interface."""


def press_fits() -> Iterator[Check]:
    """Two rings in plane stress, and in plane strain."""
    kinds: tuple[Kind, ...] = ("plane stress", "plane strain")
    for kind in kinds:
        model = press_fit(kind=kind, n_radial=16, n_angular=48, friction=0.2)
        yield from _worst_node(f"B09 press fit of two rings, {kind}", model, fit_pressure(kind, 0.01), 1e-3)


def drawn_press_fits() -> Iterator[Check]:
    """The shaft is meshed larger than the bore, by less than facets lie beside the circle; meshes do not match."""
    cases: tuple[tuple[Cells, tuple[int, int]], ...] = (("quad", (24, 36)), ("quad8", (8, 12)))
    for cells, along in cases:
        model = press_fit(kind="plane strain", n_radial=12, n_angular=along, cells=cells, interference=0.0, drawn=5e-4)
        case = f"B09 press fit drawn with its overlap, {_say(cells, along)}"
        yield from _worst_node(case, model, fit_pressure("plane strain", 5e-4), 2e-3)


def shrink_fits() -> Iterator[Check]:
    """The hub is cooled instead of overlapping: on meshes that match or not."""
    cases: tuple[tuple[Kind, Cells, int | tuple[int, int]], ...] = (
        ("plane stress", "quad", 48),
        ("plane strain", "quad", 48),
        ("plane stress", "quad8", (16, 12)),
    )
    for kind, cells, along in cases:
        model = press_fit(kind=kind, n_radial=16, n_angular=along, cells=cells, interference=0.0)
        shaft, _ = model.bodies
        cooled = replace(
            model,
            bodies=[shaft, Body("hub", Elastic(E=1000.0, nu=0.3, expansion=_EXPANSION))],
            loads=[Load("hub", temperature=_COOLING)],
        )
        # in plane strain the length is held: the free strain across is (1 + nu) alpha T
        overlap = -2.0 * _EXPANSION * _COOLING * (1.3 if kind == "plane strain" else 1.0)
        case = f"B09 shrink fit of two rings, {kind}, {_say(cells, along)}"
        yield from _worst_node(case, cooled, fit_pressure(kind, overlap), 1e-3)


def hollow_bodies() -> Iterator[Check]:
    """Radii 20, 30, 40, pressure 25 inside: two hollow spheres, and two cylinders in plane strain, as one would."""
    wall = {"inner": 20.0, "outer": 40.0, "pressure": 25.0, "E": 2000.0, "nu": 0.3}
    for words, kind, closed_form in (
        ("hollow spheres", "axisymmetric", hollow_sphere),
        ("cylinders in plane strain", "plane strain", thick_cylinder),
    ):
        _, radial, _ = closed_form(np.array([30.0]), **wall)
        for cells, along in _HALVES:
            model = _hollow("axisymmetric" if kind == "axisymmetric" else "plane strain", cells, along)
            contact = solve(model).contact("interface")
            exact = -float(radial[0])
            yield from checks_of(
                f"B09 {words} 20/30/40, {_say(cells, along)}",
                ("interface pressure, mean", contact.pressure @ contact.area / contact.area.sum(), exact, 1e-3),
                # worst at the pole of a meridian
                ("interface pressure, worst node", farthest(contact.pressure, exact), exact, 1e-2),
                source="Lame; Timoshenko, Goodier sections 28, 136",
            )


def _hollow(kind: Kind, cells: Cells, along: int | tuple[int, int]) -> Model:
    """A quarter of two bodies 20..30 and 30..40, or their meridian above the equator."""
    numbers = (along, along) if isinstance(along, int) else along
    mesh = join(
        {
            name: annulus(inner=a, outer=a + 10.0, n_radial=n // 2, n_angular=n, angle=90.0, cells=cells)
            for name, a, n in (("inner", 20.0, numbers[0]), ("outer", 30.0, numbers[1]))
        }
    )
    supports = [Support(f"{name}.start", u=(None, 0.0)) for name in ("inner", "outer")]
    if kind != "axisymmetric":
        supports += [Support(f"{name}.end", u=(0.0, None)) for name in ("inner", "outer")]
    return Model(
        mesh,
        kind=kind,
        bodies=[Body(name, Elastic(E=2000.0, nu=0.3)) for name in ("inner", "outer")],
        supports=supports,
        loads=[Load("inner.inner", pressure=25.0)],
        contacts=[Contact("inner.outer", "outer.inner", side="coarser", name="interface")],
    )


def fit_pressure(kind: Kind, interference: float) -> float:
    """Lame's pressure between the rings 1..2 and 2..3 of the gallery."""
    return press_fit_pressure(
        inner=1.0,
        interface=2.0,
        outer=3.0,
        interference=interference,
        inner_body=(2000.0, 0.3),
        outer_body=(1000.0, 0.3),
        plane_strain=kind == "plane strain",
    )


def _say(cells: Cells, along: int | tuple[int, int]) -> str:
    return cells if isinstance(along, int) else f"{cells}, {along[0]} : {along[1]} cells"


def _worst_node(case: str, model: Model, exact: float, tolerance: float) -> Iterator[Check]:
    pressure = farthest(solve(model).contact("fit").pressure, exact)
    yield from checks_of(case, ("interface pressure, worst node", pressure, exact, tolerance, _SOURCE))
