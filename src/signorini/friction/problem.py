# SPDX-License-Identifier: BSD-3-Clause
"""The condensed 2D Coulomb contact problem."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.law import closed_states
from signorini.friction.posed import PosedContact
from signorini.law.bound import FrictionBound


@dataclass(frozen=True, kw_only=True)
class CoulombProblem(PosedContact):
    """Find h = (gap, slip increment) and r = (normal force, tangential force) of n pairs in Coulomb's law with::

        G h - W r = b,    G = I - W

    Unknowns are ordered n normals, then n tangents; gap >= 0 is open, normal force >= 0 presses, the tangential force
    acts on body 1. All quantities are scaled by the square roots of an interface stiffness D (the same for both
    directions of a pair): ``h = D^.5 u``, ``r = D^-.5 forces``, ``W = D^.5 (B (K + B'DB)^-1 B') D^.5``.

    Parameters
    ----------
    image : W, (2n, 2n), its compliance and rigid motions; or give W and motions to `of`
    b : (2n,) load: motion of the pairs under the loads plus ``G h0``, h0 = (initial gap, -slip of the step before)
    friction : (n,) mu >= 0; ``inf`` sticks wherever it is closed. A pair on the verge of opening may be in equilibrium
        neither sticking nor open; it slips then, under a normal force of 1e-6 of its friction
    adhesion, limit : (n,) scaled forces of `law.bound`: friction at no normal force, and the most there is;
        None stands for none
    scale : size of b's entries, from the data, that tolerances refer to; in the units of b

    Raises
    ------
    InputError
        Where shapes do not fit, entries are not finite, friction is negative, or a pair that may never slip is dragged
        by its supports.

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> problem.pairs, problem.floating
    (1, False)
    """

    @cached_property
    def locked(self) -> BoolArray:
        """(n,) Pairs whose tangential motion is that of their supports."""
        return self.image.still[self.pairs :]

    @cached_property
    def bound(self) -> FrictionBound:
        """Friction that can act: none at a locked pair that is not dragged, 1e6 for ``inf``."""
        still = self.locked & (self.b[self.pairs :] == 0)
        if self.adhesion is None and self.limit is None:
            return FrictionBound.coulomb(np.where(still, 0.0, self.friction))
        adhesion = 0.0 if self.adhesion is None else np.where(still, 0.0, self.adhesion)
        limit = np.inf if self.limit is None else self.limit
        return FrictionBound.of(np.where(still, 0.0, self.friction), adhesion=adhesion, limit=limit)

    @property
    def mu(self) -> Array:
        """(n,) Friction at the smallest normal forces, per normal force: Coulomb's coefficient where there is no other
        law.
        """
        return self.bound.slopes[0]

    @cached_property
    def closed(self) -> IntArray:
        """(n,) State of each pair where it is closed, UNDECIDED where the solution decides."""
        return closed_states(self.mu, self.locked, self.b[self.pairs :])

    @cached_property
    def _free(self) -> Array:
        return self.image.free_motion(self.b)

    def free_motion(self, b: Array) -> Array:
        """(2n,) Motion of the pairs under a load alone, without its rigid part; that of the problem's b is kept."""
        return self._free if b is self.b else self.image.free_motion(b)

    def _check(self) -> None:
        n = self.pairs
        self._check_data(2 * n, [(n,)])
        self._check_dragged(np.asarray(self.locked & (self.b[n:] != 0)))
