# SPDX-License-Identifier: BSD-3-Clause
"""B15: meshed bodies that roll without slip, and that a bed tilts; B13: a wheel on a bed that yields."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.rolled_beds import rolled_bed
from signorini.gallery.rolling import block_on_slope, pushed_disc, rolling_discs
from signorini.gallery.yielding import SHEAR_STRENGTH
from signorini.reference.plasticity import rolling_shakedown_limit
from signorini.solution.obstacle_result import ObstacleResult
from signorini.verify.check import Check, checks_of
from signorini.verify.yielding_points import yielding_points

_RADIUS = 1.5  # of the driven disc over that of the driver
_TILT = 0.2  # radians
_LOW_PRESSURE = 0.9  # of the shakedown limit: there strokes add little


def rolling_without_slip() -> Iterator[Check]:
    """A disc that is pushed at its hub over a flat, and one that turns another: paths on both surfaces are as long."""
    roll = solve(pushed_disc(cells=30, force=0.005, facets=4.0)).steps[-1]
    hub = roll.rigid_bodies["hub"]
    yield from checks_of(
        "B15 disc pushed at its hub",
        ("path over radius and angle", hub.displacement[0] / -_angle(hub), 1.0, 1e-6),
        ("energy that is not accounted for, of what is stored", roll.energy_defect / roll.strain_energy, 0.0, 1e-9),
        source="no slip",
    )
    turn = solve(rolling_discs(radius=_RADIUS, cells=30, force=0.005, facets=2.0)).steps[-1]
    driver, driven = (_angle(turn.rigid_bodies[name]) for name in ("driver", "driven"))
    yield from checks_of(
        "B15 two discs, radii 1 : 1.5",
        ("ratio of their angles", -driver / driven, _RADIUS, 1e-6),
        ("energy that is not accounted for, of what is stored", turn.energy_defect / turn.strain_energy, 0.0, 1e-9),
        source="no slip",
    )


def tilted_block() -> Iterator[Check]:
    """A block whose weight and friction alone hold it on a bed that is tilted."""
    tilt = solve(block_on_slope(angles=(_TILT,))).steps[-1]
    contact, weight = tilt.contacts[0], 0.4 * 9.81
    share = float(contact.traction @ contact.area) / float(contact.pressure @ contact.area)
    yield from checks_of(
        "B15 block on a bed that is tilted by 0.2",
        ("vertical force of the contact over its weight", contact.forces.sum(axis=0)[1] / weight, 1.0, 1e-9),
        ("horizontal force over its weight", contact.forces.sum(axis=0)[0] / weight, 0.0, 1e-9),
        ("friction over normal force", share, math.tan(_TILT), 2e-3),
        ("slip", np.abs(contact.slip).max(), 0.0, 1e-9),
        source="equilibrium",
    )


def rolling_shakedown() -> Iterator[Check]:
    """A rigid wheel rolls to and fro over a bed: what strokes add above its shakedown limit tells the limit."""
    limit, near, far = rolling_shakedown_limit(SHEAR_STRENGTH), 1.05, 1.1
    adds = {part: _added(part * limit) for part in (_LOW_PRESSURE, near, far)}
    none = near - (far - near) * adds[near] / (adds[far] - adds[near])
    yield from checks_of(
        "B13 a wheel that rolls to and fro by contact, without friction, 3 cells in a half-width",
        ("p_0 / k at which strokes add nothing, from what they add above it", none * limit, limit, 0.03),
        (
            f"what strokes add at {_LOW_PRESSURE * limit:g} k, over what they add at 4.2 k",
            adds[_LOW_PRESSURE] / adds[near],
            0.0,
            0.15,
        ),
        source="Johnson (1985), section 9.2; Melan (1938)",
    )


def _added(p_0: float) -> float:
    """Plastic work that the last stroke there and back add in the middle of the way, to where no end reaches."""
    run, strokes = 3.0, 4
    history = solve(rolled_bed(p_0, n=3, run=run, strokes=strokes))
    before, after = (yielding_points(history, step) for step in (-3, -1))
    middle = np.abs(after.places[:, 0]) < run - 1.5
    return float((after.weights * (after.equivalent - before.equivalent))[middle].sum())


def _angle(hub: ObstacleResult) -> float:
    """By which a hub in the plane has turned, radians."""
    return float(np.asarray(hub.rotation, np.float64))
