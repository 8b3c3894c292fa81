# SPDX-License-Identifier: BSD-3-Clause
"""Natural frequencies of bars, beams and discs, and the loops of a bar whose one end lies in a rough bed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import j0, j1

from signorini.arrays import Array


def bar_frequencies(speed: float, length: float, count: int, *, clamped: bool) -> Array:
    """Along a bar, cycles per time, (count,): ``(2 k - 1) c / (4 L)`` with one end clamped, ``k c / (2 L)`` free.

    Parameters
    ----------
    speed : c = sqrt(E / rho), length over time
    length : L
    count : of frequencies, without the rigid motion
    clamped : one end; otherwise both are free

    Examples
    --------
    >>> bar_frequencies(2.0, 1.0, 2, clamped=True).tolist(), bar_frequencies(2.0, 1.0, 2, clamped=False).tolist()
    ([0.5, 1.5], [1.0, 2.0])
    """
    k = np.arange(1, count + 1)
    return np.asarray((2 * k - 1) * speed / (4.0 * length) if clamped else k * speed / (2.0 * length))


def free_beam_frequencies(speed: float, length: float, height: float, nu: float, count: int) -> Array:
    """Bending of a free beam of Timoshenko with a rectangular section, cycles per time, (count,).

    With ``b^4 = omega^2 rho A L^4 / (E I)``, ``r^2 = I / (A L^2)``, ``s^2 = E I / (kappa G A L^2)`` and Cowper's kappa.

    Parameters
    ----------
    speed : sqrt(E / rho), length over time
    length, height : of the beam
    nu : Poisson's ratio
    count : of frequencies, without rigid motions

    References
    ----------
    Huang (1961), The effect of rotatory inertia and of shear deformation on the frequency and normal mode equations of
    uniform beams, J. Appl. Mech. 28:579. Cowper (1966), The shear coefficient in Timoshenko's beam theory, 33:335.
    """
    r2 = height**2 / (12.0 * length**2)
    kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
    s2 = r2 * 2.0 * (1.0 + nu) / kappa

    def determinant(b2: float) -> float:
        root = math.sqrt((r2 - s2) ** 2 + 4.0 / b2**2)
        alpha, beta = math.sqrt(0.5 * (root - r2 - s2)), math.sqrt(0.5 * (root + r2 + s2))
        p, q = b2 * alpha, b2 * beta
        weight = b2 / math.sqrt(1.0 - b2**2 * r2 * s2)
        last = b2**2 * r2 * (r2 - s2) ** 2 + (3.0 * r2 - s2)
        return 2.0 - 2.0 * math.cosh(p) * math.cos(q) + weight * last * math.sinh(p) * math.sin(q)

    thin = [(0.5 * (2 * k + 1) * math.pi) ** 2 for k in range(1, count + 1)]  # b^2 of Euler's beam, nearly
    low = [0.6 * thin[0], *(0.5 * (one + other) for one, other in itertools.pairwise(thin))]
    roots = [_first_root(determinant, start, 1.05 * end) for start, end in zip(low, thin, strict=True)]
    return np.array(roots) * speed * height / (math.sqrt(12.0) * length**2) / (2.0 * math.pi)


def disc_frequencies(speed: float, radius: float, nu: float, count: int) -> Array:
    """Radial motion of a disc in plane strain, cycles per time: ``x J_0(x) = (1 - 2 nu) / (1 - nu) J_1(x)``.

    Parameters
    ----------
    speed : of pressure waves, sqrt((lambda + 2 G) / rho), length over time
    radius : of the disc
    nu : Poisson's ratio
    count : of frequencies

    References
    ----------
    Love (1927), A treatise on the mathematical theory of elasticity, section 201.
    """
    ratio = (1.0 - 2.0 * nu) / (1.0 - nu)

    def edge(x: float) -> float:
        return float(x * j0(x) - ratio * j1(x))

    roots = [_first_root(edge, 0.5 + k * math.pi, (k + 1.0) * math.pi) for k in range(count)]
    return np.array(roots) * speed / (2.0 * math.pi * radius)


def _first_root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root of a function between two places where its signs differ."""
    return float(brentq(function, low, high, xtol=1e-13 * high))


@dataclass(frozen=True, kw_only=True)
class BarInBed:
    """A bar along which friction of a rigid bed acts on one part, ``tau`` at most; the other sticks out.

    While the bar in the bed is at rest the free part vibrates as clamped, ``v = sqrt(2 / (rho A b)) sin(pi x / 2 b)``.
    The modal force ``Q M v`` pulls on the bed by ``F = g Q``, ``g = int rho A v dx``; slip goes as far as ``F / tau``
    and lets its end go by ``F^2 / (2 tau E A)`` (Goodman, Klumpp 1956). By Masing's rule a loop between -Q and Q takes
    ``D = 2 F^3 / (3 tau E A)``.

    Attributes
    ----------
    stiffness : E A, force
    line_density : rho A, mass per length
    friction : tau, force per length
    free : b, length
    bed : length in the bed

    Examples
    --------
    >>> bar = BarInBed(stiffness=10.0, line_density=0.1, friction=0.5, free=1.0, bed=1.0)
    >>> float(bar.dissipation(2.0) / bar.dissipation(1.0))
    8.0
    """

    stiffness: float
    line_density: float
    friction: float
    free: float
    bed: float

    @property
    def frequency(self) -> float:
        """Of the free part, its end clamped, cycles per time."""
        return math.sqrt(self.stiffness / self.line_density) / (4.0 * self.free)

    @property
    def pull(self) -> float:
        """g: the pull on the bed of the modal force 1."""
        return 2.0 / math.pi * math.sqrt(2.0 * self.line_density * self.free)

    def amplitude(self, share: float) -> float:
        """Displacement of the free end, were the bed stuck, under the force that slips through a share of the bed."""
        force = share * self.bed * self.friction / self.pull
        largest = math.sqrt(2.0 / (self.line_density * self.free))
        return force * largest / (2.0 * math.pi * self.frequency) ** 2

    def coordinate(self, force: Array) -> Array:
        """q at modal forces Q, ``Q / omega^2 + g F^2 / (2 tau E A)``."""
        slip = (self.pull * force) ** 2 / (2.0 * self.friction * self.stiffness)
        return np.asarray(force / (2.0 * math.pi * self.frequency) ** 2 + self.pull * slip)

    def dissipation(self, force: Array | float) -> Array:
        """Work that loops between -Q and Q take."""
        return np.asarray(2.0 * (self.pull * np.asarray(force)) ** 3 / (3.0 * self.friction * self.stiffness))

    def ratio(self, force: Array) -> Array:
        """Damping ratios of these loops, ``D / (2 pi Q q)``."""
        return np.asarray(self.dissipation(force) / (2.0 * math.pi * force * self.coordinate(force)))
