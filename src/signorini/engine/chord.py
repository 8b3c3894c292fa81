# SPDX-License-Identifier: BSD-3-Clause
"""Events of an exact path beside the straight way between two whole states: how far off it, and the bodies there.

Loads change linearly, so that what takes bodies off the straight way is what forces of pairs do alone, which need no
load to be eliminated, and it stores what these forces do on the pairs, ``r . B u = u K u``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.engine.prepare import Prepared
from signorini.solution.state import State

LOOKS_TOGETHER = 16
"""Displacements found at a time: so many right-hand sides take about twice as long as one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Chord:
    """The straight way from one whole state to another, and m states of a path between them.

    Attributes
    ----------
    prepared : condensed
    ends : the whole states
    factors : (m,) where on the way the states are, 0 .. 1
    moved : (d, a, m) motions of the active pairs off the way, length
    forces : (d, a, m) their forces off the way
    """

    prepared: Prepared
    ends: tuple[State, State]
    factors: Array
    moved: Array
    forces: Array

    @staticmethod
    def of(prepared: Prepared, ends: tuple[State, State], factors: Array, between: Sequence[State]) -> Chord:
        """The way between two states.

        Parameters
        ----------
        prepared, ends, factors : see `Chord`
        between : the m states on the path, of which only the contacts are known
        """
        active = prepared.paths.condensed.active
        begin, *path, end = (
            np.stack([state.motion, state.forces], axis=0)[..., active] for state in (ends[0], *between, ends[1])
        )
        off = np.array(path) - begin - factors[:, None, None, None] * (end - begin)
        moved, forces = np.moveaxis(off, 0, 3)
        return Chord(prepared=prepared, ends=ends, factors=factors, moved=moved, forces=forces)

    def energy(self, first: int, last: int) -> float:
        """The most that bodies store off the straight way between two of the states, at states between these.

        Parameters
        ----------
        first, last : numbers of the two; -1 and m are the ends of the chord
        """
        factors = np.concatenate([self.factors, [1.0, 0.0]])  # the last is found by -1
        inside = slice(first + 1, last)
        part = (factors[inside] - factors[first]) / (factors[last] - factors[first])

        def off(path: Array) -> Array:
            none = np.zeros((*path.shape[:2], 2))
            path = np.concatenate([path, none], axis=2)
            begin, end = path[..., [first]], path[..., [last]]
            return np.asarray(path[..., inside] - begin - part * (end - begin))

        forces, compliance = off(self.forces), self.prepared.paths.condensed.compliance
        stored = 0.5 * (forces * (off(self.moved) - compliance[..., None] * forces)).sum(axis=(0, 1))
        return float(stored.max(initial=0.0))

    def displacements(self, which: IntArray) -> Array:
        """(k, dofs) Displacements of the bodies at k of the states, length."""
        condensed, T = self.prepared.paths.condensed, self.prepared.constraints.transform
        one, two = (end.displacement for end in self.ends)
        found = []
        for first in range(0, len(which), LOOKS_TOGETHER):
            own = which[first : first + LOOKS_TOGETHER]
            none = condensed.reduce(np.zeros((T.shape[1], len(own))))
            offset = np.zeros_like(condensed.compliance)
            off = T @ condensed.displacement(none, self.moved[..., own], self.forces[..., own], offset)
            part = self.factors[own, None]
            found.append((1.0 - part) * one + part * two + off.T)
        return np.concatenate(found)
