# SPDX-License-Identifier: BSD-3-Clause
"""Where on a straight way from one state to another a point begins to yield.

Relative stresses are linear in the way, and so are yield stresses between two temperatures of their tables. On every
such piece the yield function is convex, its ends tell whether a point yields on it, and where is the root of a
quadratic.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.laws import Heat, heat_of
from signorini.plasticity.measure import inner, size, yield_stress
from signorini.plasticity.radial_return import ROOT23

_YIELD_TOL = 1e-9  # of the yield stress: rounding of a point that is about to flow


class Crossing(NamedTuple):
    """Where the first point yields.

    Attributes
    ----------
    part : of the way, 0 .. 1
    beyond : part of the way behind it, at the end of the piece
    excess : what that point has there beyond its yield stress, of that
    """

    part: float
    beyond: float
    excess: float


def crossing(
    bodies: YieldingBodies, relative: tuple[Array, Array], equivalent: Array, heat: tuple[Heat, Heat]
) -> Crossing | None:
    """The first point that yields on a straight way; None where none does.

    Parameters
    ----------
    bodies : with their points
    relative : (p, n) relative stresses at both ends
    equivalent : (p,) equivalent plastic strains
    heat : what the temperature does at both ends
    """
    first, way = relative[0], relative[1] - relative[0]
    found: Crossing | None = None
    kinks = _kinks(bodies, heat)
    limits = [ROOT23 * yield_stress(bodies, equivalent, _between(bodies, heat, t)) for t in kinks]
    for k in range(len(kinks) - 1):
        length, limit, rise = kinks[k + 1] - kinks[k], limits[k], limits[k + 1] - limits[k]
        begin, step = first + kinks[k][:, None] * way, length[:, None] * way
        fullness = size(begin + step) / limits[k + 1]
        yields = fullness > 1.0 + _YIELD_TOL
        if not yields.any():
            continue
        a = (size(step) ** 2 - rise**2)[yields]
        b = (inner(begin, step) - limit * rise)[yields]
        c = np.minimum(size(begin) ** 2 - limit**2, 0.0)[yields]
        root = _root(a, b, c)
        parts = kinks[k][yields] + np.clip(root, 0.0, 1.0) * length[yields]
        i = int(np.argmin(parts))
        if found is None or parts[i] < found.part:
            ends = kinks[k + 1][yields], fullness[yields]
            found = Crossing(part=float(parts[i]), beyond=float(ends[0][i]), excess=float(ends[1][i]) - 1.0)
    return found


def _root(a: Array, b: Array, c: Array) -> Array:
    """The positive root of ``a t^2 + 2 b t + c`` that is reached first; c <= 0, and with b <= 0 a > 0.

    Of its two forms the one that adds numbers of one sign.
    """
    inside, tiny = np.sqrt(np.maximum(b * b - a * c, 0.0)), np.finfo(np.float64).tiny
    rising = b > 0.0
    root: Array = np.where(rising, -c, inside - b) / np.maximum(np.where(rising, b + inside, a), tiny)
    return root


def _kinks(bodies: YieldingBodies, heat: tuple[Heat, Heat]) -> list[Array]:
    """(p,) Parts of the way, increasing from 0 to 1, between which the yield stress of every point is linear."""
    ends = np.zeros(len(bodies.body)), np.ones(len(bodies.body))
    if not bodies.laws.varies:
        return list(ends)
    cold, warm = heat[0].temperature, heat[1].temperature
    change = np.where(warm == cold, 1.0, warm - cold)
    table = bodies.laws.temperature[bodies.body]
    inside = np.clip((table - cold[:, None]) / change[:, None], 0.0, 1.0)
    inside[warm == cold] = 0.0
    return [ends[0], *np.sort(inside, axis=1).T, ends[1]]


def _between(bodies: YieldingBodies, heat: tuple[Heat, Heat], part: Array) -> Heat:
    """What the temperature does at parts (p,) of the way."""
    one, two = heat
    swelling = one.swelling + part * (two.swelling - one.swelling)
    return heat_of(bodies.laws, bodies.body, swelling, one.temperature + part * (two.temperature - one.temperature))
