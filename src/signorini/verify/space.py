# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in space: Hertz, a round punch, Mindlin, a press fit; meshes that match and do not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.engine.solve import solve
from signorini.gallery.half_spaces import CONTACT_RADIUS, EQUAL, ball, body_on_round_punch, equal_half_spaces, hertz
from signorini.gallery.press_fit import press_fit_in_space
from signorini.meshing.plane import Cells
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.reference.hertz_point import round_punch
from signorini.verify.check import Check, checks_of, farthest
from signorini.verify.rings import fit_pressure

_PULL = 0.7  # of the tangential force over that of sliding: most of the contact slips, and much still sticks


def ball_on_plane() -> Iterator[Check]:
    """Hertz: hexahedra of 8 nodes on a rigid plane, 8 cells to the contact radius."""
    yield from _hertz("ball on a plane, hexahedra", ball(n=4), bodies=1, edge=0.1)


def ball_on_block() -> Iterator[Check]:
    """Hertz: two elastic bodies whose meshes do not match."""
    yield from _hertz("ball on a block, not matching", ball(n=4, block=6), bodies=2, edge=0.1)


def balls_refined() -> Iterator[Check]:
    """Hertz: finer, quadratic, matching, and whole."""
    yield from _hertz("ball on a plane, hexahedra, finer", ball(n=8), bodies=1, edge=0.04)
    families: tuple[tuple[str, Cells], ...] = (("20", "quad8"), ("27", "quad9"))
    for nodes, cells in families:
        yield from _hertz(f"ball on a plane, hexahedra of {nodes} nodes", ball(n=4, cells=cells), bodies=1, edge=0.1)
    # on a plane of symmetry the triangles at a node are as many or half as many as at the next one
    tetrahedra = ball(n=4, cells="tetra10")
    yield from _hertz("ball on a plane, tetrahedra of 10 nodes", tetrahedra, bodies=1, edge=0.1, inside=0.08)
    yield from _hertz("ball on a block, matching", ball(n=6, block=6), bodies=2, edge=0.05)
    yield from _hertz("ball on a block, not matching, finer", ball(n=6, block=8), bodies=2, edge=0.05)
    yield from _hertz("half a ball on a block, not matching", ball(n=4, block=5, angle=180.0), bodies=2, edge=0.1)
    yield from _hertz("whole ball on a plane", ball(n=4, angle=360.0), bodies=1, edge=0.1)


def _hertz(case: str, model: Model, *, bodies: int, edge: float, inside: float = 0.03) -> Iterator[Check]:
    """Centre, everything off the edge, and the edge between the last closed and the first open ring.

    Parameters
    ----------
    edge, inside : tolerances of the contact radius and of the pressures off the edge
    """
    contact, exact = solve(model).contact("contact"), hertz(bodies)
    r = np.hypot(*contact.points.T[:2])
    source = "Hertz; Johnson (1985), section 4.2"
    error = np.abs(contact.pressure - exact.pressure(r)) / exact.peak_pressure
    closed = float(r[contact.closed].max())
    yield from checks_of(
        case,
        ("p_0", contact.pressure[np.argmin(r)], exact.peak_pressure, 0.01),
        ("largest error of p / p_0, r < 0.9 a", error[r < 0.9 * CONTACT_RADIUS].max(), 0.0, inside),
        ("contact radius, to a cell", closed, CONTACT_RADIUS, edge),
        source=source,
    )


def round_punch_on_body() -> Iterator[Check]:
    """B06: a flat round rigid punch on a body 20 times as large; the pressure is infinite at its edge."""
    contact = solve(body_on_round_punch(n=8)).contact("punch")
    r = np.hypot(*contact.points.T[:2])
    inside = r < 0.9
    ratio = contact.pressure[inside] / round_punch(r[inside], force=1.0, radius=1.0)
    yield from checks_of(
        "flat round punch",
        ("p at the centre / exact", ratio[np.argmin(r[inside])], 1.0, 0.01),
        ("p / exact, worst r < 0.9 a", farthest(ratio, 1.0), 1.0, 0.04),
        source="Boussinesq; Johnson (1985), section 3.4",
    )


def mindlin() -> Iterator[Check]:
    """B04: two equal balls pressed, then pulled by 0.7 mu P: 5 cells to the contact radius."""
    yield from _mindlin(spacing=0.2, shift=0.2)


def mindlin_refined() -> Iterator[Check]:
    """Two equal balls, pulled, with 10 cells to the contact radius."""
    yield from _mindlin(spacing=0.1, shift=0.06)


def _mindlin(*, spacing: float, shift: float) -> Iterator[Check]:
    """Friction, stick zone, and how the shift of distant points grows beyond its linear part.

    Finite bodies add a linear part of their own, which the shift under a hundredth of the load shows.
    """
    tiny = 0.01
    steps = [
        Step(name="press", scale={"press": 1.0}),
        Step(name="start", scale={"pull": tiny}),
        Step(name="pull", scale={"pull": _PULL}),
    ]
    model = equal_half_spaces(steps, spacing=spacing)
    history = solve(model)
    contact, top = history.last.contacts[0], model.mesh.nodes_of("upper.top")[0]
    before, little, much = (step.displacement[top, 0] for step in history.steps)
    Q, most = _PULL * EQUAL.most, EQUAL.friction * EQUAL.normal.peak_pressure
    r, c = np.hypot(*contact.points.T[:2]), EQUAL.stick_radius(Q)
    off = np.minimum(np.abs(r - CONTACT_RADIUS), np.abs(r - c)) > spacing / 2.0
    error = np.linalg.norm(contact.shear[:, :2] + np.column_stack([EQUAL.traction(r, Q), 0.0 * r]), axis=1) / most
    stuck = np.sqrt(2.0 * contact.area[contact.status == "stick"].sum() / np.pi)
    bent = EQUAL.shift(Q) - EQUAL.shift(tiny * EQUAL.most) / tiny * _PULL
    case, source = f"Mindlin, node distance {spacing:g} a", "Johnson (1985), section 7.2"
    yield from checks_of(
        case,
        ("radius of a circle as large as what sticks", stuck, c, spacing / 2.0),
        ("largest error of q / mu p_0, off the edges", error[off].max(), 0.0, 0.08),
        ("shift beyond its linear part", much - before - (little - before) / tiny * _PULL, bent, shift),
        ("force along the pull", (contact.normal_force + contact.tangential_force)[0], -Q / 2.0, 1e-8),
        source=source,
    )


def mindlin_cycle() -> Iterator[Check]:
    """B05: pulled back and forth by 0.7 mu P, in increments that end at events; 7 cells to the contact radius."""
    yield from _cycle(spacing=0.14, facets=0, loop=1e-2)


def mindlin_cycle_exact() -> Iterator[Check]:
    """Two equal balls, pulled back and forth on an exact path, on a cone of 16 facets."""
    yield from _cycle(spacing=0.14, facets=16, loop=1e-9)


def _cycle(*, spacing: float, facets: int, loop: float) -> Iterator[Check]:
    """What a cycle dissipates, the area of its loop, and where slip has turned halfway back.

    Parameters
    ----------
    loop : tolerance of what holds to rounding on an exact path
    """
    path: Literal["exact"] | None = "exact" if facets else None
    steps = [
        Step(name="press", scale={"press": 1.0}, increments=1),
        Step(name="pull", scale={"pull": _PULL}, path=path),
        Step(name="cycle", scale={"pull": [-_PULL, _PULL]}, repeat=2, at=[0.125], path=path),
    ]
    model = equal_half_spaces([Step()], spacing=spacing)
    contact = replace(model.contacts[0], facets=facets, friction_axis=(1.0, 0.0, 0.0))
    step = solve(replace(model, contacts=[contact], steps=steps)).last
    halfway = next(instant for instant in step.instants if instant.what == "asked").contacts[0]
    stuck = np.sqrt(2.0 * halfway.area[halfway.status == "stick"].sum() / np.pi)
    turned = float(np.cbrt(1.0 - 0.5 * _PULL)) * CONTACT_RADIUS
    _, second = step.cycles
    way = f"{facets} facets, exact path" if facets else "increments to events"
    case, source = f"Mindlin, cycles, node distance {spacing:g} a, {way}", "Johnson (1985), section 7.4"
    yield from checks_of(
        case,
        ("loss of a cycle", second.dissipation, EQUAL.loss(_PULL * EQUAL.most) / 2.0, 0.02, source),
        ("area of the loop / loss", second.work / second.dissipation, 1.0, loop, "first law"),
        ("second cycle: change of forces", second.change, 0.0, loop, "the loop closes"),
        ("counter-slip: radius of what sticks at Q = 0", stuck, turned, spacing / 2.0, source),
    )


def press_fit_as_slab() -> Iterator[Check]:
    """B09 in space: a slab of two rings in plane strain, on meshes that match and do not."""
    exact = fit_pressure("plane strain", 0.01)
    for words, model in (
        ("8 nodes, matching", press_fit_in_space(n_radial=12, n_angular=24, friction=0.2)),
        ("8 nodes, 16:22", press_fit_in_space(n_radial=6, n_angular=(16, 22), friction=0.2)),
        ("20 nodes, 16:22", press_fit_in_space(n_radial=3, n_angular=(16, 22), friction=0.2, cells="quad8")),
    ):
        pressure = farthest(solve(model).contact("fit").pressure, exact)
        yield from checks_of(
            f"press fit in space, hexahedra of {words}",
            ("interface pressure", pressure, exact, 3e-3, "Lame; Timoshenko, Goodier section 28"),
        )
