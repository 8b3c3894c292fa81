# SPDX-License-Identifier: BSD-3-Clause
"""Cattaneo and Mindlin: pressed cylinders of equal materials, then pulled sideways, once or to and fro."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.reference.hertz import HertzLine


@dataclass(frozen=True, kw_only=True)
class CattaneoMindlin:
    """Line contact at constant normal force P under a tangential force Q, ``|Q| < mu P``.

    Equal materials (or Dundurs' beta = 0), half-planes: Q does not change the pressure. The friction is the full slip
    of the normal force P less that of P - Q/mu (Ciavarella, Jaeger)::

        q = mu p_0 [sqrt(1 - x^2/a^2) - (c/a) sqrt(1 - x^2/c^2)],    c/a = sqrt(1 - Q / mu P)

    Parameters
    ----------
    normal : the contact under P
    friction : mu

    References
    ----------
    Cattaneo (1938); Mindlin (1949); Johnson (1985), Contact Mechanics, section 7.2; Ciavarella (1998), Int. J. Solids
    Struct. 35; Jaeger (1998), J. Tribol. 120.

    Examples
    --------
    >>> pulled = CattaneoMindlin(normal=HertzLine(force=1.0, radius=1.0, modulus=1.0), friction=0.5)
    >>> round(pulled.stick_half_width(0.35) / pulled.normal.half_width, 6)
    0.547723
    """

    normal: HertzLine
    friction: float

    def stick_half_width(self, Q: float) -> float:
        """``c``, length, for a force that has grown from 0."""
        return self.normal.half_width * float(np.sqrt(max(1.0 - abs(Q) / self._most, 0.0)))

    def traction(self, x: ArrayLike, Q: float) -> Array:
        """q at x for a force that has grown from 0, force per area."""
        less = self._pressed(1.0 - abs(Q) / self._most).pressure(x)
        traction: Array = np.sign(Q) * self.friction * (self.normal.pressure(x) - less)
        return traction

    def traction_back(self, x: ArrayLike, highest: float, Q: float) -> Array:
        """q at x where the force has come back from ``highest`` to Q, not below ``-highest``."""
        drop = (highest - Q) / (2.0 * self._most)
        less = self._pressed(1.0 - drop).pressure(x)
        traction: Array = self.traction(x, highest) - 2.0 * self.friction * (self.normal.pressure(x) - less)
        return traction

    def loss(self, highest: float) -> float:
        """Dissipation of a cycle between ``highest`` and ``-highest``, work per length.

        Masing's rule on ``delta(Q) = mu [alpha(P) - alpha(P - Q/mu)]``, alpha the normal approach, whose part that is
        not linear is ``-P ln P / (pi E*)``; the linear part, which depends on the bodies, drops out.
        """
        P, X = self.normal.force, highest / self.friction

        def primitive(y: float) -> float:
            return 0.5 * y**2 * float(np.log(y)) - 0.25 * y**2 if y > 0.0 else 0.0

        def approach(y: float) -> float:
            return y * float(np.log(y)) if y > 0.0 else 0.0

        far = approach(P) - approach(P - X)
        area = X * approach(P) - (primitive(P) - primitive(P - X))
        return float(-(self.friction**2) * (4.0 * X * far - 8.0 * area) / (np.pi * self.normal.modulus))

    @property
    def _most(self) -> float:
        return self.friction * self.normal.force

    def _pressed(self, part: float) -> HertzLine:
        """The contact under a part of the normal force; a trace of it where there is none."""
        force = max(part, 1e-300) * self.normal.force
        return HertzLine(force=force, radius=self.normal.radius, modulus=self.normal.modulus)
