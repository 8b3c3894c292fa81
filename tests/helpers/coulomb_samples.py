# SPDX-License-Identifier: BSD-3-Clause
"""Small random Coulomb problems, and the referee that tries every state."""

import dataclasses
import itertools

import numpy as np
from hypothesis import given, settings

from signorini.condense.basis import make_basis
from signorini.condense.operator import InterfaceOperator
from signorini.friction.certificate import certify
from signorini.friction.newton import in_states, y_in_states
from signorini.friction.problem import ContactProblem

HELD = 0


def for_all(examples=20, **strategies):
    """A property test of the same examples each time, without a deadline."""
    return lambda test: settings(deadline=None, derandomize=True, max_examples=examples)(given(**strategies)(test))


def random_problem(seed, pairs, motions=HELD, friction=None):
    """Compliance with random eigenvectors and eigenvalues 0.05 .. 0.95 (1 on the motions); every kind of load."""
    rng = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(rng.normal(size=(2 * pairs, 2 * pairs)))
    values = rng.uniform(0.05, 0.95, 2 * pairs)
    values[:motions] = 1.0
    W = (Q * values) @ Q.T
    return ContactProblem.of(
        W=(W + W.T) / 2,
        b=rng.normal(size=2 * pairs),
        friction=rng.choice([0.0, 0.2, 0.7, 1.5, 3.0, np.inf], pairs) if friction is None else np.full(pairs, friction),
        motions=Q[:, :motions] @ rng.normal(size=(motions, motions)),
        scale=1.0,
    )


def block_on_floor(pairs, load, friction=0.3):
    """A floating elastic block on a floor: three rigid motions; load = (normal, tangential, moment)."""
    rng = np.random.default_rng(pairs)
    x = np.linspace(-1.0, 1.0, pairs)
    one, zero = np.ones(pairs), np.zeros(pairs)
    R = np.stack([np.append(one, zero), np.append(zero, one), np.append(x, zero)], axis=1)
    Q, _ = np.linalg.qr(np.concatenate([R, rng.normal(size=(2 * pairs, 2 * pairs - 3))], axis=1))
    W = (Q * np.append(np.ones(3), np.linspace(0.1, 0.9, 2 * pairs - 3))) @ Q.T
    b = R @ np.linalg.solve(R.T @ R, np.array(load, dtype=float))
    return ContactProblem.of(W=(W + W.T) / 2, b=b, friction=np.full(pairs, friction), motions=R, scale=1.0)


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


def answer(result):
    """(d, n) y = r - h of a result."""
    return result.y
