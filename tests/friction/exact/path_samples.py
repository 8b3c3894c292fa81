# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems whose load paths are known, built directly on the interface."""

import numpy as np

from signorini.friction import CoulombProblem
from signorini.friction.exact import follow, initial_state


def one_node(mu):
    """Stiffness 2 in both directions, coupling -1; returns the problem and the load of a force (f_n, f_t)."""
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    problem = CoulombProblem(W=W, b=np.zeros(2), friction=[mu], motions=np.zeros((2, 0)), scale=4.0)
    return problem, lambda f_n, f_t: W @ [f_n, f_t]


class EqualBodies:
    """A curved punch on a body of the same material, held by contact alone: A_nt = 0, A_tt = A_nn.

    The kernel is that of a half-plane; the punch is given by its gap, x^2 / 2. Loads are the resultants P and Q.
    """

    def __init__(self, pairs, mu):
        n = self.n = pairs
        x = np.sort(np.random.default_rng(pairs).uniform(-1.0, 1.0, n)) * 1.3
        x -= x[np.argmin(np.abs(x))]
        A = -np.log(np.abs(x[:, None] - x) + 0.5 / n)
        P = np.eye(n) - np.ones((n, n)) / n
        A = P @ (A + A.T) @ P / 2
        T = np.kron(np.eye(2), np.linalg.inv(A + np.eye(n)))
        self.R = np.kron(np.eye(2), np.ones((n, 1)))
        W = np.eye(2 * n) - T + self.R @ self.R.T / n
        self.gap = np.append(x**2 / 2, np.zeros(n))
        self.problem = CoulombProblem(
            W=(W + W.T) / 2, b=np.zeros(2 * n), friction=np.full(n, mu), motions=self.R, scale=1.0
        )

    def load(self, P, Q):
        """b of a resultant P pressing, and of Q that pulls body 1 along +t."""
        return self.gap - self.problem.W @ self.gap + self.R @ [-P, Q] / self.n

    def start(self):
        return initial_state(self.problem, self.load(0.0, 0.0), motion=self.gap)

    def run(self, *loads):
        """Segments through the loads (P, Q)."""
        state, segments = self.start(), []
        for P, Q in loads:
            segments.append(follow(self.problem, state, self.load(P, Q)))
            state = segments[-1].end
        return segments


def at(segment, factor):
    """(h, r) of a followed segment at a factor: linear between breakpoints."""
    s = np.array([piece.factor for piece in segment.pieces])
    return tuple(
        np.array([np.interp(factor, s, column) for column in np.array([getattr(p, name) for p in segment.pieces]).T])
        for name in ("h", "r")
    )
