# SPDX-License-Identifier: BSD-3-Clause
"""Friction on half-planes: Cattaneo-Mindlin and its cycles, Spence's punches, the corner of a complete contact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.engine.solve import solve
from signorini.gallery.half_planes import EQUAL, HALF_WIDTH, NU, equal_half_planes, punch, square_on_half_plane
from signorini.model.step import Step
from signorini.reference.spence import stick_ratio
from signorini.solution.results import ContactResult
from signorini.verify.check import Check, checks_of

_PULL = 0.7  # of the tangential force over that of sliding: most of the contact slips, and much still sticks
_BONDED = 0.543076  # shear over pressure at the corner of a bonded square block (benchmark B07)


def cattaneo_mindlin() -> Iterator[Check]:
    """Two equal cylinders pressed, pulled by 0.7 mu P, then two cycles: 49 pairs."""
    yield from _cattaneo_mindlin(spacing=0.05, size=20.0, loss=0.03)


def cattaneo_mindlin_refined() -> Iterator[Check]:
    """Two equal cylinders with 193 pairs, the blocks four times as large."""
    yield from _cattaneo_mindlin(spacing=0.0125, size=80.0, loss=0.005)


def _cattaneo_mindlin(*, spacing: float, size: float, loss: float) -> Iterator[Check]:
    steps = [
        Step(name="press", scale={"press": 1.0}),
        Step(name="pull", scale={"pull": _PULL}),
        Step(name="cycles", scale={"pull": [-_PULL, _PULL]}, repeat=2),
    ]
    _, pull, cycles = solve(equal_half_planes(steps, spacing=spacing, size=size)).steps
    contact, highest = pull.contacts[0], _PULL * EQUAL.friction * EQUAL.normal.force
    case, source = f"Cattaneo-Mindlin, {len(contact.node)} pairs", "Johnson (1985), section 7.2"
    most = EQUAL.friction * EQUAL.normal.peak_pressure
    x = contact.points[:, 0]
    # at the edges of contact and of stick tractions are steeper than a cell
    held, stuck = EQUAL.stick_half_width(highest), abs(x[contact.status == "stick"]).max()
    inside = np.minimum(abs(abs(x) - HALF_WIDTH), abs(abs(x) - held)) > 0.06 * HALF_WIDTH
    back = next(instant for instant in cycles.instants if instant.what == "segment").contacts[0]
    pulled = np.abs(contact.traction + EQUAL.traction(x, highest))[inside]
    turned = np.abs(back.traction + EQUAL.traction_back(x, highest, -highest))[inside]
    first, second = cycles.cycles
    yield from checks_of(
        case,
        ("c/a, to a node distance", stuck / HALF_WIDTH, held / HALF_WIDTH, spacing / 0.5477),
        ("q pulled, largest error off the edges / mu p_0", pulled.max() / most, 0.0, 0.03),
        ("q back, largest error off the edges / mu p_0", turned.max() / most, 0.0, 0.03),
        ("loss of a cycle", second.dissipation, EQUAL.loss(highest), loss, "Ciavarella (1998), Jaeger (1998)"),
        ("area of the loop / loss", second.work / second.dissipation, 1.0, 1e-8, "first law"),
        ("second cycle: change of forces", second.change, 0.0, 1e-12, "the loop closes"),
        ("second loss / first", second.dissipation / first.dissipation, 1.0, 1e-10, "the loop closes"),
        source=source,
    )


def spence() -> Iterator[Check]:
    """Elastic block, 20 half-widths wide and high, on a rigid punch, nodes at 0.005 of its half-width."""
    spacing = 0.005
    for curved in (False, True):
        for friction in (0.4, 0.8):
            contact = solve(punch(curved=curved, friction=friction, spacing=spacing, closed=0.95)).contact("punch")
            x = contact.points[:, 0]
            ratio = x[contact.status == "stick"].max() / x[contact.closed].max()
            yield from checks_of(
                f"Spence, {'round' if curved else 'flat'} punch, node distance {spacing}",
                (f"c/a, mu {friction:g}", ratio, stick_ratio(friction, NU), 0.02, "Spence (1973, 1975)"),
            )


def complete_contact() -> Iterator[Check]:
    """B07: a square block on a half-plane of its own material, cells from 1e-6 of its half-width at the corner."""
    bonded = solve(square_on_half_plane(friction="stick", finest=1e-6)).contact("contact")
    near = 1.0 - bonded.points[:, 0] > 8e-6  # the last nodes see the mesh, not the singularity
    ratio = (np.abs(bonded.traction) / bonded.pressure)[near].max()
    rough = solve(square_on_half_plane(friction=0.6, finest=1e-6)).contact("contact")
    loose = rough.count("slip") + rough.count("open") - 1
    fine, coarse = (
        _slip_length(solve(square_on_half_plane(friction=0.5, finest=finest)).contact("contact"))
        for finest in (1e-6, 1e-4)
    )
    length = "slips below mu = 0.5431, over a length that no mesh decides"
    yield from checks_of(
        "square block on a half-plane, cells 1e-6 at the corner",
        (
            "largest |shear| / pressure towards the corner, bonded",
            ratio,
            _BONDED,
            0.03,
            "eigenvalues of the bonded corner",
        ),
        ("nodes that slip beside the corner's own, mu 0.6", loose, 0.0, 0.0, "sticks above mu = 0.5431"),
        ("slip length, mu 0.5, against cells of 1e-4", fine, coarse, 0.25, length),
    )


def _slip_length(contact: ContactResult) -> float:
    return float(1.0 - contact.points[contact.status != "stick", 0].min())
