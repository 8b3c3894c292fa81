# SPDX-License-Identifier: BSD-3-Clause
"""Tensions of bonds that open, round after round, until they are those that lines say at the openings found.

With t the tensions, S the slopes of the lines and W the compliance of all else as these bonds feel it, openings are
``g - W t``, lines say ``S (o - g + W t)``, and equilibrium is stable where ``S^-1 - W`` is positive definite.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.linalg.anderson import anderson

_MEMORY = 40  # rounds that count: more than bonds that open at once and differ
_SEEN = 1e-6  # of the strength: changes of tensions that are less tell nothing of stiffnesses
_INDEPENDENT = 1e-4  # of the largest change: what is less in a direction is none
_NEUTRAL = 1e-9  # of the stiffness of lines: bodies that resist by no more do not
_ALIKE = 1e-6  # of the largest part in a motion: bonds that take the same part in it
_STILL = 1e-9  # of the strength: tensions that have settled, unless another round still halves what they lack
_DIGITS = 1e-12  # of the strength: lacks of which no round is asked to halve them


class Tensions:
    """Tensions that were given and what lines said to them, in rounds in which the same bonds opened.

    Attributes
    ----------
    given, said : (m,) of every round
    free, driven : (n,) bonds whose tensions are looked for; that have let go, to see whether others hold
    lack : by how much lines said otherwise in the last round, of the strength
    """

    def __init__(self, pairs: int) -> None:
        self.given: list[Array] = []
        self.said: list[Array] = []
        self.free = np.zeros(pairs, np.bool_)
        self.driven = np.zeros(pairs, np.bool_)
        self.lack = np.inf

    def settled(self, opens: BoolArray, tension: Array, line: Array, limit: Array, allowed: float) -> bool:
        """Whether tensions that were given are those that lines say, as far as rounds tell.

        Parameters
        ----------
        opens : (n,) bonds that open
        tension, line : (n,) given, and what lines say to it, force
        limit : (n,) the most of each, force
        allowed : what an answer may lack that others follow, force
        """
        before, lack = self.lack, np.abs(line - tension)[opens]
        self.lack = float((lack / limit[opens]).max(initial=0.0))
        if (lack <= allowed).all() or self.lack <= _DIGITS:
            return True
        return self.lack <= _STILL and self.lack > 0.5 * before

    def forget(self) -> None:
        """Something else has changed than tensions."""
        self.given, self.said, self.lack = [], [], np.inf

    def following(self, opens: BoolArray, tension: Array, line: Array, slope: Array, limit: Array) -> Array:
        """(n,) Tensions of the next round.

        Parameters
        ----------
        opens : (n,) bonds that open
        tension, line : (n,) given, and what lines say to it, force
        slope : (n,) fall of lines, force per length
        limit : (n,) the most of each, force
        """
        self.driven &= opens
        free = opens & ~self.driven & ((tension > 0.0) | (line > 0.0))
        if (np.abs(line - tension) <= _STILL * limit)[free].all():  # driven bonds that are short of their end hold on
            back = self.driven & (line > 0.0)
            self.driven &= ~back
            free |= back
        if (free != self.free).any():
            self.free = free
            self.forget()
        following = np.where(opens & ~self.driven, line, 0.0)
        if not free.any():
            return following
        self.given, self.said = (
            [*kept[1 - _MEMORY :], new[free]] for kept, new in ((self.given, tension), (self.said, line))
        )
        torn = self._unstable(slope[free], limit[free])
        if torn is not None:
            self.driven[np.flatnonzero(free)[torn]] = True
            following[self.driven] = 0.0
            return following
        found = anderson(self.given, self.said, 1.0 / limit[free])
        following[free] = np.clip(found, 0.0, limit[free])
        return following

    def _unstable(self, slope: Array, limit: Array) -> BoolArray | None:
        """(m,) Bonds that open most in a motion that bodies do not resist, as rounds have seen; None: no such."""
        root = np.sqrt(slope)[:, None]
        changes, missing = (np.diff(np.stack(each, axis=1), axis=1) / root for each in (self.given, self.said))
        counts = np.abs(changes * root / limit[:, None]).max(axis=0, initial=0.0) > _SEEN
        changes, missing = changes[:, counts], (changes - missing)[:, counts]
        if not changes.shape[1]:
            return None
        left, sizes, right = np.linalg.svd(changes, full_matrices=False)
        some = sizes > _INDEPENDENT * sizes[0]
        resisted = left[:, some].T @ missing @ (right[some].T / sizes[some])
        values, ways = np.linalg.eigh(0.5 * (resisted + resisted.T))
        if values[0] > _NEUTRAL:
            return None
        part = (left[:, some] @ ways[:, 0]) * root[:, 0] / limit
        part = part if part.sum() > 0.0 else -part
        return np.asarray(part >= (1.0 - _ALIKE) * part.max())
