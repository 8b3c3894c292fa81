# SPDX-License-Identifier: BSD-3-Clause
"""Loops of a mode, and the stiffness and damping of a joint that they tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.short import Short
from signorini.solution.history import History


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DampingLoop(Short):
    """A loop from the largest modal force to its opposite and back.

    Attributes
    ----------
    coordinate : (n,) q, length times mass^1/2
    force : (n,) Q, force over mass^1/2
    dissipation : work that friction, and plastic flow, take from it
    """

    coordinate: Array
    force: Array
    dissipation: float

    @property
    def half_range(self) -> float:
        """Half of the difference of q between both ends."""
        return float(np.ptp(self.coordinate)) / 2.0

    @property
    def square(self) -> float:
        """Secant stiffness, omega^2, of both ends."""
        return float(np.ptp(self.force) / np.ptp(self.coordinate))

    @property
    def ratio(self) -> float:
        """Damping ratio ``D / (2 pi omega^2 q^2)``."""
        return self.dissipation / (2.0 * np.pi * self.square * self.half_range**2)

    @property
    def closure(self) -> float:
        """How far its ends are apart, of its range: 0 for a loop that repeats."""
        return float(abs(self.coordinate[-1] - self.coordinate[0]) / np.ptp(self.coordinate))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class JointDamping(Short):
    """What the joints of a model do to one of its modes, by amplitude.

    Attributes
    ----------
    mode : number from 1, of the stuck joints
    frequency : of the stuck joints, cycles per time
    reach : the largest displacement of a node at q = 1
    loops : one an amplitude, ascending
    history : of the loops, which goes on from the preload
    message : why there are fewer loops than were asked for, or empty
    """

    mode: int
    frequency: float
    reach: float
    loops: tuple[DampingLoop, ...]
    history: History
    message: str = ""

    @property
    def amplitudes(self) -> Array:
        """(k,) Largest displacement of a node in the mode, half of the range of each loop, length."""
        return self.reach * np.array([loop.half_range for loop in self.loops])

    @property
    def frequencies(self) -> Array:
        """(k,) Of the secant of each loop, cycles per time."""
        return np.sqrt([loop.square for loop in self.loops]) / (2.0 * np.pi)

    @property
    def ratios(self) -> Array:
        """(k,) Damping ratios."""
        return np.array([loop.ratio for loop in self.loops])

    @property
    def dissipations(self) -> Array:
        """(k,) Work that each loop takes."""
        return np.array([loop.dissipation for loop in self.loops])

    @property
    def exponents(self) -> Array:
        """(k - 1,) Of the dissipation as a power of the amplitude, between loops; NaN where nothing slips."""
        D = self.dissipations
        with np.errstate(divide="ignore", invalid="ignore"):
            found: Array = np.diff(np.log(D)) / np.diff(np.log(self.amplitudes))
        return np.where((D[:-1] > 0.0), found, np.nan)
