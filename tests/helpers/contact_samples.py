# SPDX-License-Identifier: BSD-3-Clause
"""Small contact problems of the plane and of space, random ones and bodies; the referee that tries every state."""

import dataclasses
import itertools

import numpy as np
from hypothesis import given, settings

from benchmarks.spatial_problems import from_compliance, punch
from signorini.condense.basis import make_basis
from signorini.condense.operator import InterfaceOperator
from signorini.friction.certificate import certify
from signorini.friction.newton import in_states, y_in_states
from signorini.friction.problem import ContactProblem

HELD = 0


def for_all(examples=20, **strategies):
    """A property test of the same examples each time, without a deadline."""
    return lambda test: settings(deadline=None, derandomize=True, max_examples=examples)(given(**strategies)(test))


def random_problem(seed, pairs, motions=HELD, friction=None, *, directions=2, **law):
    """Compliance with random eigenvectors and eigenvalues 0.05 .. 0.95 (1 on the motions); every kind of load.

    Parameters
    ----------
    friction : of all pairs, or (d - 1, n); None draws it
    directions : d, 2 in the plane and 3 in space
    law : what else the problem takes
    """
    rng, rows = np.random.default_rng(seed), directions * pairs
    Q, _ = np.linalg.qr(rng.normal(size=(rows, rows)))
    values = rng.uniform(0.05, 0.95, rows)
    values[:motions] = 1.0
    W = (Q * values) @ Q.T
    b = rng.normal(size=rows)
    if friction is None:
        friction = rng.choice([0.0, 0.2, 0.7, 1.5, 3.0, np.inf], pairs)
    elif np.ndim(friction) == 0:
        friction = np.full(pairs, friction)
    R = Q[:, :motions] @ rng.normal(size=(motions, motions))
    return ContactProblem.of(W=(W + W.T) / 2, b=b, friction=friction, motions=R, scale=1.0, **law)


def block_on_floor(pairs, load, friction=0.3, **law):
    """A floating elastic block on a floor, in the plane or, under a load of six, on a square of pairs in space.

    Its rigid motions are lifting, sliding, tilting and, in space, turning on the floor; the load is what works on each.
    """
    d = 2 if len(load) == 3 else 3
    side = round(pairs ** (1 / (d - 1)))
    x = np.stack(np.meshgrid(*(d - 1) * [np.linspace(-1.0, 1.0, side)], indexing="ij"), axis=-1).reshape(pairs, d - 1)
    R = np.zeros((d, pairs, len(load)))
    R[range(d), :, range(d)] = 1.0
    R[0, :, d : 2 * d - 1] = x
    if d == 3:
        R[1, :, 5], R[2, :, 5] = -x[:, 1], x[:, 0]
    R = R.reshape(d * pairs, -1)
    rng, free = np.random.default_rng(side), d * pairs - len(load)
    Q, _ = np.linalg.qr(np.concatenate([R, rng.normal(size=(d * pairs, free))], axis=1))
    W = (Q * np.append(np.ones(len(load)), np.linspace(0.1, 0.9, free))) @ Q.T
    b = R @ np.linalg.solve(R.T @ R, np.array(load, dtype=float))
    return ContactProblem.of(W=(W + W.T) / 2, b=b, friction=np.full(pairs, friction), motions=R, scale=1.0, **law)


def pressed_punch(pairs, friction, *, facets=0):
    """A curved punch pressed on a half-space, dragged and turned: A, c, the problem and the roots of its scaling."""
    A, c = punch(round(pairs**0.5))
    problem, root = from_compliance(A, c, np.full(pairs, friction), facets=facets)
    return A, c, problem, root


def with_stiffness(problem, factor):
    """The same problem scaled by another interface stiffness D; far off, few digits are left of it."""
    image, root = problem.image, np.sqrt(factor)
    motions = root * image.motions
    basis = make_basis(motions)
    A = factor * image.A
    leaning = basis.project(A)
    few = InterfaceOperator.of_compliance(A, motions, basis.R)
    resultant = basis.coefficients(image.motions.T @ problem.b)
    b = few.load(root * problem.free_motion() - leaning @ resultant, resultant)
    return dataclasses.replace(problem, image=few, b=b, scale=root * problem.scale)


def all_solutions(problem):
    """Every regular solution, with its index: each of the 4^n states solved and tested."""
    found = []
    choices = [(0, 1, 2, 3) if closed < 0 else (0, int(closed)) for closed in problem.law.closed]
    for state in itertools.product(*choices):
        system = in_states(problem, np.array(state))
        if not system.index:
            continue
        y = y_in_states(system, np.zeros((2, problem.pairs)))
        if (problem.law.states(y) == state).all() and certify(problem, y) < 1e-9:
            found.append((y, system.index))
    return found
