# SPDX-License-Identifier: BSD-3-Clause
"""Semismooth Newton of Alart and Curnier: linearise the law of every pair, solve, read the law off the answer, repeat.

Iterates are in equilibrium and break the law, by ``r - P(r - h)``, a force. In the plane this is the method of
`friction.newton`. A step is shortened where no part of the last violations is reached; nearly always the whole of it is
taken, and five or six steps are usual.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.attempt import MethodRun
from signorini.friction.krylov import LARGE
from signorini.friction.spatial.certificate import certify
from signorini.friction.spatial.equilibrium import Equilibrium, linear_system
from signorini.friction.spatial.iterated import balanced
from signorini.friction.spatial.law import SpatialTangent, split, tangent

MEMORY = 5
"""Last violations of which a step must undercut the largest."""

SHARP = 1e-13
"""What an iterate may lack, relative, without one more step."""

SHORTEST = 2.0**-6
DECREASE = 1e-4


@dataclass(frozen=True, kw_only=True)
class NewtonEnd:
    """Where Newton's method ended.

    Attributes
    ----------
    force, rigid : (3n,) and (k,) r and a of the best iterate; zero where there was none
    y : (3n,) ``r - h`` there
    residual : `certify` of y on the problem as posed
    attempt : how it went
    converged : whether the law is obeyed to the tolerance, with the layer where there is one
    """

    force: Array
    rigid: Array
    y: Array
    residual: float
    attempt: MethodRun
    converged: bool


def newton(
    equilibrium: Equilibrium,
    law: SpatialTangent,
    *,
    force: Array | None = None,
    rigid: Array | None = None,
    limit: int = 25,
    tolerance: float = 1e-10,
    method: str = "newton",
) -> NewtonEnd:
    """Newton's method from a linearised law.

    Parameters
    ----------
    equilibrium : the problem as posed, or with a proximal layer
    law : the law of every pair, linear: `sticking`, or `tangent` at the last solution
    force, rigid : (3n,) and (k,) that forces left undetermined depart least from; 0 where not given
    limit : most systems solved
    tolerance : of `certify`; with a layer of the violation of the law

    References
    ----------
    Alart, Curnier (1991), Computer Methods in Applied Mechanics and Engineering 92:353-375. Grippo, Lampariello,
    Lucidi (1986), SIAM Journal on Numerical Analysis 23:707-716 (the search).

    Examples
    --------
    >>> from signorini.friction.spatial.law import sticking
    >>> from signorini.friction.spatial.problem import SpatialProblem
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.3, 0.4]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> end = newton(Equilibrium.of(problem), sticking(problem))
    >>> split(problem, end.y)[1].round(12).tolist(), end.attempt.end, end.attempt.iterations
    ([2.0, -0.12, -0.16], 'certified', 1)
    """
    problem = equilibrium.problem
    r = np.zeros(3 * problem.pairs) if force is None else force
    a = np.zeros(problem.motions.shape[1]) if rigid is None else rigid
    h, history = r, [np.inf]
    changes: list[int] = []
    best, end, converged = (np.inf, r, a, r - h), "limit reached", False
    for _ in range(limit):
        found = _balanced(equilibrium, law, r, a, settled=changes[-1:] == [0])
        if found is None:
            end = "singular system"
            break
        r, a, h, violation = _searched(equilibrium, (r, a, h), found, max(history[-MEMORY:]))
        history.append(violation)
        following = tangent(problem, r - h)
        changes.append(int(np.count_nonzero(~following.same_states(law))))
        law = following
        done = converged  # the step after the first certified one squares its error
        lacking = _lacking(equilibrium, r, h, violation)
        if lacking < best[0]:
            best = lacking, r, a, r - h
        converged = converged or lacking <= tolerance
        if done or lacking <= SHARP:
            break
    if converged:
        end = "certified" if equilibrium.as_posed else "converged"
    _, r, a, y = best
    if not equilibrium.as_posed:
        y = r - Equilibrium.of(problem).moved(r, a)
    attempt = MethodRun(method=method, iterations=len(changes), changes=tuple(changes), end=end)
    residual = certify(problem, y) if np.isfinite(best[0]) else np.inf
    return NewtonEnd(force=r, rigid=a, y=y, residual=residual, attempt=attempt, converged=converged)


def _balanced(
    equilibrium: Equilibrium, law: SpatialTangent, r: Array, a: Array, *, settled: bool
) -> tuple[Array, Array, Array] | None:
    """Forces, rigid motion and motions that balance under the linearised law; None where nothing does."""
    if equilibrium.as_posed and np.count_nonzero(law.closed) + law.left.sum() >= LARGE:
        found = balanced(equilibrium.problem, law, r, a, settled=settled)
        if found is not None:
            return found
    return linear_system(equilibrium, law).solve(r, a)


def _searched(
    equilibrium: Equilibrium,
    before: tuple[Array, Array, Array],
    found: tuple[Array, Array, Array],
    reference: float,
) -> tuple[Array, Array, Array, float]:
    """The whole step, or the first part of it that undercuts the reference, or the best part tried."""
    best, length = None, 1.0
    while True:
        r, a, h = (old + length * (new - old) if length < 1.0 else new for old, new in zip(before, found, strict=True))
        violation = _violation(equilibrium, r, h)
        if best is None or violation < best[3]:
            best = r, a, h, violation
        if violation <= (1.0 - DECREASE * length) * reference or length <= SHORTEST:
            return best
        length /= 2.0


def _violation(equilibrium: Equilibrium, r: Array, h: Array) -> float:
    """Size of what the law lacks, a scaled force."""
    return float(np.linalg.norm(r - split(equilibrium.problem, r - h)[1]))


def _lacking(equilibrium: Equilibrium, r: Array, h: Array, violation: float) -> float:
    """What the iterate lacks, relative: `certify`, or with a layer the violation of the law."""
    if equilibrium.as_posed:
        return certify(equilibrium.problem, r - h)
    return violation / max(float(np.linalg.norm(r)), equilibrium.problem.scale, 1e-300)
