# SPDX-License-Identifier: BSD-3-Clause
"""B13: round bodies on a rigid plane: first yield below the surface, full plasticity, rolling again and again."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from signorini.api import solve
from signorini.gallery.large_bodies import graded_lines
from signorini.gallery.yielding import NU, SHEAR_STRENGTH, E, indented_block, rolled_half_plane, round_body
from signorini.meshing.plane import Cells
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.obstacle import Circle, Profile
from signorini.model.plastic import Plastic
from signorini.model.step import Step
from signorini.reference.hertz import contact_modulus
from signorini.reference.plasticity import first_yield_line, first_yield_point, punch_limit, rolling_shakedown_limit
from signorini.verify.check import Check, checks_of

_RADIUS = 1000.0  # of the ball and the cylinder: contact is small beside it
_DEPTH = 0.368  # depth R / a^2 of a ball in a perfectly plastic body: Richmond, Morrison, Devenpeck (1974)
_PASSES = 5  # of the cylinder that rolls: by then what they add above the limit is the same to a thousandth
_MODULUS = contact_modulus((E, NU))
_MESHES: tuple[tuple[Cells, int, float], ...] = (("quad", 16, 0.015), ("quad8", 8, 0.008))
"""Cells, how many in a half-width of the elastic contact; what the pressure of first yield may be off."""

_SOFT_YIELD_STRESS, _SMALL_RADIUS = (
    0.02,
    100.0,
)  # yield stress and radius: E* a / R Y is 110 at a contact of half-width 1
_INDENTED: tuple[tuple[Kind, float, float, float, str], ...] = (
    ("axisymmetric", 0.0036, 2.9, 0.1 / 2.9, "2.8 to 3.0 Y: Johnson (1985), section 6.3; Jackson, Green (2005)"),
    (
        "plane strain",
        0.0055,
        2.0 / np.sqrt(3.0) * 0.5 * punch_limit(1.0),
        0.07,
        "Johnson (1985), section 6.3: to 5.14 k",
    ),
)
"""Kind, approach of the far side, mean pressure over Y, tolerance and source."""


_POINTS: tuple[tuple[Kind, float], ...] = (("plane strain", 1.85), ("axisymmetric", 1.65))
"""Kind, and p_0 / Y of an elastic contact under the whole load, a little beyond first yield."""


def first_yield() -> Iterator[Check]:
    """Line and point: the elastic path ends where the first point yields."""
    for kind, most in _POINTS:
        point = kind == "axisymmetric"
        pressure, depth = first_yield_point(NU) if point else first_yield_line(NU)
        full = 2.0 * _MODULUS / (np.pi * _RADIUS) if point else _MODULUS / (2.0 * _RADIUS)
        for cells, n, tolerance in _MESHES:
            law, step = Plastic(full / most), Step(increments=1)
            body = round_body(n=n, kind=kind, cells=cells, plastic=law, radius=_RADIUS, steps=[step])
            share, z = _first_yield(solve(body).last.notes)
            width = share ** (1.0 / 3.0 if point else 0.5)  # of the contact, over that under the whole load
            yield from checks_of(
                f"B13 first yield, {'point' if point else 'line'} contact, {cells}, {n} cells in its half-width",
                ("p_0 / Y", most * width, pressure, tolerance),
                ("depth over half-width, to a cell", z / width, depth, 1.0 / n / width / depth),
                source="Johnson (1985), sections 4.2, 3.4, 6.2",
            )


def _first_yield(notes: tuple[str, ...]) -> tuple[float, float]:
    """The part of the step and the depth that a note names; NaN, which passes nothing, where none does."""
    found = re.search(r" at ([\d.]+)%: first yield, in '\w+' at \(\S+, (\S+)\)", " ".join(notes))
    return (float(found[1]) / 100.0, float(found[2])) if found else (float("nan"), float("nan"))


def full_plasticity() -> Iterator[Check]:
    """A ball and a cylinder pressed in until the mean pressure no longer grows.

    Pressures are read where a node touches: there the edge of contact is where that node is.
    """
    count = 36
    for kind, approach, expected, tolerance, source in _INDENTED:
        step = Step(scale={"press": np.linspace(1.0 / count, 1.0, count).tolist()}, increments=1)
        body = round_body(
            n=24,
            kind=kind,
            plastic=Plastic(_SOFT_YIELD_STRESS),
            radius=_SMALL_RADIUS,
            seat=1.0,
            size=20.0,
            approach=approach,
            steps=[step],
        )
        found = []
        contacts = [instant.contacts[0] for instant in solve(body).last.instants]
        for before, contact in pairwise(contacts):
            if contact.closed.sum() == before.closed.sum() + 1:
                a = contact.points[contact.closed, 0].max()
                force = 0.5 * (before.pressure @ before.area + contact.pressure @ contact.area)
                found.append((a, force / (np.pi * a**2 if kind == "axisymmetric" else a) / _SOFT_YIELD_STRESS))
        far = [pressure for a, pressure in found if a > 0.8]
        yield from checks_of(
            f"B13 full plasticity, {'ball' if kind == 'axisymmetric' else 'cylinder'}, E* a / R Y 88 and more",
            ("mean pressure / Y", np.mean(far) if far else np.nan, expected, tolerance),
            source=source,
        )


def ball_in_a_block() -> Iterator[Check]:
    """Code_Aster's SSNV506, a rigid ball in a perfectly plastic block, at a fiftieth of the depth.

    At its depths, 20 and more, the edge of contact is 20 degrees up the ball, strains are 1.3 and the surface slides by
    a sixth of the contact: no small displacements.
    """
    yield_stress, radius, depth = 50.0, 500.0, 2.0
    a = np.sqrt(depth * radius / _DEPTH)
    size = a / 20
    ball = indented_block(
        Circle(centre=(0.0, radius), radius=radius),
        depth,
        x=graded_lines(1.4 * a, size, 1620.0),
        y=-graded_lines(1.4 * a, size, 1920.0)[::-1],
        seat=1.4 * a,
        material=Elastic(E=210e3, nu=0.3, plastic=Plastic(yield_stress)),
        steps=[Step(increments=30)],
    )
    contact = solve(ball).last.contacts[0]
    within = contact.points[contact.closed, 0].max() + 0.5 * size
    force = 3.0 * yield_stress * np.pi * radius * depth / _DEPTH
    yield from checks_of(
        "B13 Code_Aster SSNV506: rigid ball in a perfectly plastic block, E* a / R Y 480",
        ("depth R / a^2", depth * radius / within**2, _DEPTH, 0.06),
        ("force / 3 pi R Y depth / 0.368", -contact.normal_force[1] / force, 1.0, 0.1),
        source="V6.04.506; Johnson (1985), sections 6.3 and 7.2: mean pressure 3 Y, 0.368 of Richmond et al.",
    )


def cone_in_a_block() -> Iterator[Check]:
    """Code_Aster's SSNA111: a rigid cone goes down by 0.4 and back by 0.008; its mesh, in small displacements."""
    wide = np.cumsum(1.02 ** np.arange(49))
    slope = 5e3 / (1.0 - 5e3 / 200e3)  # of the yield stress, from that of the stress
    steps = [Step(scale={"tool": 0.625}, increments=10), Step(increments=6), Step(scale={"tool": 0.98}, increments=1)]
    cone = indented_block(
        Profile(((2.7, 1.0), (0.0, 0.0), (-2.7, 1.0))),
        0.4,
        x=np.append(0.0, 10.0 * wide / wide[-1]),
        y=np.linspace(-5.0, 0.0, 36),
        seat=3.0,
        material=Elastic(E=200e3, nu=0.3, plastic=Plastic(300.0, hardening=slope)),
        steps=steps,
    )
    history = solve(cone)
    (tip,) = np.flatnonzero((history.model.mesh.points == 0.0).all(axis=1))
    down, _, back = (step.displacement[tip, 1] for step in history.steps)
    yield from checks_of(
        "B13 Code_Aster SSNA111: rigid cone in a block that hardens, and back by 2 %",
        ("displacement below its tip", down, -0.25, 1e-9),
        ("the same as it goes back: it still touches there", back, -0.392, 1e-9),
        source="V6.01.111",
    )


def rolling() -> Iterator[Check]:
    """Flow to and fro dies out below the shakedown limit; above it every pass adds the same, the more the farther."""
    limit, last = rolling_shakedown_limit(SHEAR_STRENGTH), {}
    for part in (0.95, 1.025, 1.075):
        passed = solve(rolled_half_plane(part * limit, n=6, passes=_PASSES)).last
        last[part] = [cycle.flow for cycle in passed.cycles]
    (_, near), (_, far) = ((part, flows[-1]) for part, flows in last.items() if part > 1.0)
    none = 1.025 - 0.05 * near / (far - near)
    yield from checks_of(
        "B13 rolling again and again, without friction, 6 cells in a half-width",
        ("p_0 / k at which passes add nothing, from what they add above", none * limit, limit, 0.02),
        ("what the last pass adds at 4.1 k, over the one before", near / last[1.025][-2], 1.0, 0.01),
        ("the same at 3.8 k, over what it adds at 4.1 k", last[0.95][-1] / near, 0.0, 0.25),
        source="Johnson (1985), section 9.2; Melan (1938)",
    )
