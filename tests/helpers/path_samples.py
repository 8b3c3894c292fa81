# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems whose load paths are known, built directly on the interface."""

from dataclasses import replace

import numpy as np

from signorini.friction.history import follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact


def one_node(mu):
    """Stiffness 2 in both directions, coupling -1; returns the problem and the load of a force (f_n, f_t)."""
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[mu], motions=np.zeros((2, 0)), scale=4.0)
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
        self.problem = ContactProblem.of(
            W=(W + W.T) / 2, b=np.zeros(2 * n), friction=np.full(n, mu), motions=self.R, scale=1.0
        )

    def load(self, P, Q):
        """b of a resultant P pressing, and of Q that pulls body 1 along +t."""
        return self.gap - self.problem.W @ self.gap + self.R @ [-P, Q] / self.n

    def travel(self, state):
        """Tangential motion of the body as a whole, on which Q works."""
        return float(self.R[:, 1] @ state.h.ravel()) / self.n

    def start(self):
        return initial_state(self.problem, self.load(0.0, 0.0), motion=self.gap.reshape(2, -1))

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
        np.array(
            [np.interp(factor, s, column) for column in np.array([getattr(p, name).ravel() for p in segment.pieces]).T]
        )
        for name in ("h", "r")
    )


def stiff(seed, pairs, coupling=1.0):
    """A random stiffness of a held interface; coupling times the size of the tangential rows."""
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(2 * pairs, 4 * pairs))
    B[pairs:] *= coupling
    return B @ B.T / (4 * pairs) + np.diag(rng.uniform(0.2, 1.0, 2 * pairs))


class Springs:
    """Pairs on a held body of given stiffness: S u = F + r, h = u + (initial gap, 0)."""

    def __init__(self, S, friction, gap=None):
        n = len(S) // 2
        self.S = S
        self.gap = np.append(np.zeros(n) if gap is None else gap, np.zeros(n))
        W = np.linalg.inv(S + np.eye(2 * n))
        self.problem = ContactProblem.of(
            W=(W + W.T) / 2, b=np.zeros(2 * n), friction=friction, motions=np.zeros((2 * n, 0)), scale=1.0
        )

    def load(self, F):
        """b of nodal forces F."""
        return self.problem.W @ F + self.gap - self.problem.W @ self.gap

    def run(self, *forces):
        """Segments from rest through nodal forces, up to one that is not followed."""
        state, segments = (
            initial_state(self.problem, self.load(np.zeros_like(self.gap)), motion=self.gap.reshape(2, -1)),
            [],
        )
        for F in forces:
            segments.append(follow(self.problem, state, self.load(F)))
            state = segments[-1].end
            if not segments[-1].followed:
                break
        return segments

    def strain_energy(self, state):
        """Of the body."""
        u = state.h.ravel() - self.gap
        return 0.5 * u @ self.S @ u

    def work(self, segments, forces):
        """Of the nodal forces, exact: all is linear between breakpoints."""
        total, start = 0.0, np.zeros_like(self.gap)
        for segment, F in zip(segments, forces, strict=False):
            s = np.array([piece.factor for piece in segment.pieces])
            u = np.array([piece.h.ravel() for piece in segment.pieces])
            f = (1 - s)[:, None] * start + s[:, None] * F
            total += 0.5 * np.sum((f[1:] + f[:-1]) * np.diff(u, axis=0))
            start = F
        return total


def increments(problem, start, ends):
    """Implicit increments that end at given loads b: the last (h, r)."""
    travelled, states = start.h[1], None
    for b in ends:
        origin = np.append(np.zeros(problem.pairs), travelled)
        result = solve_contact(replace(problem, b=b + problem.W @ origin - origin), states)
        assert result.solved, result.message
        travelled, states = travelled + result.slip[0], result.state
    return np.stack([result.gap, travelled]), result.r


def loads_at_breakpoints(segment, start, end):
    """b at the end of every piece."""
    return [(1 - piece.factor) * start + piece.factor * end for piece in segment.pieces[1:]]
