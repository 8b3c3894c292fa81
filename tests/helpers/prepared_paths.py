# SPDX-License-Identifier: BSD-3-Clause
"""A finite element model whose loads are followed exactly."""

import numpy as np

from signorini.engine.prepare import prepare
from signorini.friction.history import follow, initial_state


class PreparedPath:
    """The condensed contact problem of a model, with its loads by name and factor."""

    def __init__(self, model):
        self.prepared = prepare(model)
        self.problem = self.prepared.paths.law
        self.pairs = self.problem.pairs
        gap = self.prepared.interface.gap[self.prepared.paths.condensed.active]
        self.offset = np.stack([gap, np.zeros_like(gap)])

    def forces(self, factors):
        """Nodal forces of the loads; what is not named does not act."""
        return sum(factors.get(name, 0.0) * f for name, f in self.prepared.loads.items())

    def load(self, factors):
        """b under the loads."""
        condensed = self.prepared.paths.condensed
        f = self.prepared.constraints.transform.T @ self.forces(factors)
        return condensed.right_hand_side(condensed.reduce(f).load, self.offset)

    def start(self):
        """Nothing acts yet."""
        root = self.prepared.paths.condensed.root
        return initial_state(self.problem, self.load({}), motion=root * self.offset)

    def run(self, *loads):
        """Segments through the loads, up to one that is not followed."""
        state, segments = self.start(), []
        for factors in loads:
            segments.append(follow(self.problem, state, self.load(factors)))
            state = segments[-1].end
            if not segments[-1].followed:
                break
        return segments

    def traction(self, r):
        """Forces of the pairs per area."""
        area = self.prepared.interface.area[self.prepared.paths.condensed.active]
        return self.prepared.paths.condensed.root * r / area

    def displacement(self, factors, piece):
        """Of every degree of freedom, at a breakpoint."""
        condensed, T = self.prepared.paths.condensed, self.prepared.constraints.transform
        f = T.T @ self.forces(factors)
        h, r = piece.h / condensed.root, piece.r * condensed.root
        return T @ condensed.displacement(condensed.reduce(f), h, r, self.offset)

    def energies(self, loads):
        """Work of the loads, strain energy at the end and dissipation, along segments through the loads."""
        segments = self.run(*loads)
        assert all(segment.followed for segment in segments)
        work, before, u = 0.0, {}, 0.0
        for factors, segment in zip(loads, segments, strict=True):
            old = self.forces(before)
            for piece in segment.pieces:
                s = piece.factor
                now = {name: (1 - s) * before.get(name, 0.0) + s * value for name, value in factors.items()}
                moved = self.displacement(now, piece)
                work += 0.5 * (old + self.forces(now)) @ (moved - u)
                old, u = self.forces(now), moved
            before = factors
        return work, 0.5 * u @ self.prepared.K @ u, segments[-1].end.dissipation.sum()
