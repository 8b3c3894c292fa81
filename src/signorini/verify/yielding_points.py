# SPDX-License-Identifier: BSD-3-Clause
"""Stresses and equivalent plastic strain at the points of bodies that yield, where a history ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.fem.space import make_space
from signorini.plasticity.bodies import yielding_bodies
from signorini.plasticity.measure import deviator, full_strains
from signorini.solution.history import History


@dataclass(frozen=True, kw_only=True, eq=False)
class YieldingPoints:
    """The integration points of all bodies that yield.

    Attributes
    ----------
    places : (p, d) length
    weights : (p,) volumes
    stress : (p, 4 or 6) tensors xx, yy, zz, xy (yz, xz), force per area
    equivalent : (p,) equivalent plastic strain
    """

    places: Array
    weights: Array
    stress: Array
    equivalent: Array

    @property
    def mises(self) -> Array:
        """(p,) Equivalent stress, force per area."""
        s = self.stress.copy()
        s[:, :3] -= s[:, :3].mean(axis=1)[:, None]
        return np.sqrt(1.5 * ((s[:, :3] ** 2).sum(axis=1) + 2.0 * (s[:, 3:] ** 2).sum(axis=1)))

    @property
    def meridian(self) -> tuple[Array, Array, Array]:
        """Radius, radial and hoop stress of axisymmetric bodies, (p,) each."""
        return self.places[:, 0], self.stress[:, 0], self.stress[:, 2]

    @property
    def polar(self) -> tuple[Array, Array, Array]:
        """Radius, radial and hoop stress about the origin of the plane, (p,) each."""
        r = np.hypot(*self.places.T)
        x, y = self.places.T / r
        xx, yy, _, xy = self.stress.T
        return r, xx * x**2 + yy * y**2 + 2.0 * xy * x * y, xx * y**2 + yy * x**2 - 2.0 * xy * x * y


def yielding_points(history: History, step: int = -1) -> YieldingPoints:
    """At the end of a step, by default the last; without temperatures.

    Raises
    ------
    ValueError
        If no step was finished, or nothing yields.
    """
    end, model = history.steps[step] if history.steps else None, history.model
    if end is None or end.plastic is None:
        raise ValueError("no step was finished, or no body yields")
    bodies = yielding_bodies(make_space(model.mesh, kind=model.kind), model)
    u, plastic, cold = end.displacement.ravel(), end.plastic.state, bodies.cold()
    stress = deviator(bodies, u, plastic.strain, cold)
    volume = bodies.dilatation(full_strains(bodies, u, plastic.strain, cold))
    stress[:, :3] += (bodies.laws.bulk[bodies.body] * volume)[:, None]
    return YieldingPoints(places=bodies.places(), weights=bodies.weights, stress=stress, equivalent=plastic.equivalent)
