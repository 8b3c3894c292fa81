# SPDX-License-Identifier: BSD-3-Clause
"""A bar under cycles of strain, by hand."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True, kw_only=True)
class CyclicBar:
    """A bar whose backstress follows Armstrong and Frederick, pulled and pushed by prescribed strains.

    While it flows in the direction s, ``sigma = s Y + X``, ``X = s C / gamma + (X_0 - s C / gamma) exp(-gamma dp)``.

    Parameters
    ----------
    E, yield_stress : elastic modulus and Y, which does not change, force per area
    hardening : C, force per area
    recall : gamma, >= 0; with 0 Prager's ``X = X_0 + s C dp``

    References
    ----------
    Lemaitre, Chaboche (1990), Mechanics of Solid Materials, section 5.4.

    Examples
    --------
    >>> bar = CyclicBar(E=200.0, yield_stress=1.0, hardening=50.0, recall=25.0)
    >>> [round(stress, 5) for stress, _ in bar.follow([0.05, -0.05])]
    [2.24168, -2.51761]
    """

    E: float
    yield_stress: float
    hardening: float
    recall: float

    def backstress(self, before: float, direction: float, flow: float) -> float:
        """X after the plastic strain ``flow`` >= 0 in a direction of sign 1 or -1.

        Parameters
        ----------
        before : X_0, force per area
        direction : s
        flow : dp
        """
        reached = -np.expm1(-self.recall * flow) / self.recall if self.recall else flow
        return float(before * np.exp(-self.recall * flow) + direction * self.hardening * reached)

    def follow(self, strains: Iterable[float]) -> list[tuple[float, float]]:
        """Stress and accumulated plastic strain where the strain turns, from rest to one strain after the other."""
        plastic = accumulated = X = 0.0
        found = []
        for strain in strains:
            stress = self.E * (strain - plastic)
            s = float(np.sign(stress - X))
            if abs(stress - X) > self.yield_stress:
                flow = self._flow(stress, X, s)
                X = self.backstress(X, s, flow)
                plastic, accumulated, stress = plastic + s * flow, accumulated + flow, s * self.yield_stress + X
            found.append((stress, accumulated))
        return found

    def _flow(self, trial: float, before: float, direction: float) -> float:
        """dp that takes the stress without it back to the yield stress around the backstress."""

        def excess(flow: float) -> float:
            relative = direction * (trial - self.backstress(before, direction, flow))
            return relative - self.E * flow - self.yield_stress

        return float(brentq(excess, 0.0, (abs(trial) + abs(before)) / self.E, xtol=1e-16))
