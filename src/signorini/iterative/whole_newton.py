# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method on equilibrium and the law of contact together, its systems solved by one Krylov method.

Forces r and motions h of the pairs are read off trial forces ``y = r - D_0 (B z + h_0 + C r)``, so that they obey the
law as posed, friction bound included. To first order the law near them is ``dr = S (dr / D - B dz - c) + m dr_n``, with

    S    the springs of `PairSprings` at ``r - E D h``
    c    ``B z + h_0 + C r - h``, what bodies have moved otherwise than the law reads
    m    friction of slipping pairs per normal force, with its direction

and together with ``K dz - B' dr = f + B' r - K z`` that is one system in (dz, dr). It is preconditioned by what a round
of multipliers does: a cycle for ``K + B' S B``, then ``dr = - S B dz``. That leaves a fifth of the multipliers' error
and less, so that the system takes hardly more iterations than one with K alone. States are read with a D_0 as that of
the condensed interface, far below D, with which Newton's method would go round in circles.

References
----------
Alart, Curnier (1991), A mixed formulation for frictional contact problems, CMAME 92:353-375.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.iterative.rounds import MultiplierRounds
from signorini.iterative.springs import PairSprings
from signorini.law.pair import PairLaw
from signorini.linalg.krylov import MAX_DIRECTIONS, conjugate_residuals

_MAX_STEPS = 16  # states of a thousand pairs settle within eight
_PATIENCE = 8  # steps within which equilibrium and law have to come nearer: states of 5000 pairs wander first
_WHILE_STATES_CHANGE, _SETTLED = 0.1, 1e-3  # what a system leaves of its right side
_NEWTON_AIM = 0.1  # of the tolerance: what of it Newton stops at, since residuals of rounds are measured otherwise


@dataclass(frozen=True, kw_only=True, eq=False)
class LawfulPairs:
    """Pairs that obey the law, and the law near them.

    Attributes
    ----------
    forces : (d, a) r
    lag : (d, a) c, length
    state : (a,) codes
    springs : S
    share : (d - 1, a) m
    residual : of equilibrium and of c, in units of the data
    rest : (b,) ``f + B' r - K z``
    """

    forces: Array
    lag: Array
    state: IntArray
    springs: PairSprings
    share: Array
    residual: float
    rest: Array


def newton_on_all(rounds: MultiplierRounds) -> None:
    """Newton's method from the displacements and forces of some rounds, which are taken over where it ends.

    Parameters
    ----------
    rounds : left as they were where it does not converge
    """
    load, before = rounds.load, (rounds.z, rounds.multiplier)
    pairs, best, changed = _lawful(rounds), [np.inf], True
    for _ in range(_MAX_STEPS):
        if pairs.residual <= _NEWTON_AIM * load.tolerance:
            rounds.take(rounds.z, pairs.forces)
            return
        best.append(min(best[-1], pairs.residual))
        if not np.isfinite(pairs.residual) or sum(rounds.iterations) > load.most:
            break
        if len(best) > _PATIENCE and best[-1] >= best[-_PATIENCE]:
            break
        needed = 0.3 * _NEWTON_AIM * load.tolerance / pairs.residual
        if not _step(rounds, pairs, _WHILE_STATES_CHANGE if changed else max(_SETTLED, needed)):
            break
        state, pairs = pairs.state, _lawful(rounds)
        rounds.changes.append(int(np.count_nonzero(pairs.state != state)))
        changed = rounds.changes[-1] > 0
    rounds.take(*before)


def _step(rounds: MultiplierRounds, pairs: LawfulPairs, tolerance: float) -> bool:
    """Solve a system as far as a tolerance and take the step; whether so many iterations were enough."""
    bodies, n, shape = rounds.bodies, len(rounds.z), pairs.forces.shape
    weak = np.divide(1.0, rounds.D, out=np.zeros_like(rounds.D), where=rounds.D > 0)
    cycle = rounds.cycle(rounds.held(pairs.springs))

    def product(w: Array) -> Array:
        dz, dr = w[:n], w[n:].reshape(shape)
        push = pairs.springs.forces(weak * dr - rounds.bodies.seen(dz))
        push[1:] += pairs.share * dr[0]
        return np.concatenate([bodies.internal(dz) - bodies.pushed(push), (dr - push).ravel()])

    def precondition(w: Array) -> Array:
        dz = cycle(w[:n])
        return np.concatenate([dz, w[n:] - pairs.springs.forces(rounds.bodies.seen(dz)).ravel()])

    lag = pairs.springs.forces(pairs.lag)
    right = np.concatenate([pairs.rest - bodies.pushed(lag), -lag.ravel()])
    w, count = conjugate_residuals(product, precondition, right, tolerance)
    rounds.iterations.append(count)
    rounds.take(rounds.z + w[:n], pairs.forces + w[n:].reshape(shape))
    return count < MAX_DIRECTIONS


def _lawful(rounds: MultiplierRounds) -> LawfulPairs:
    """The pairs at the displacements and multipliers of some rounds, put on the law."""
    load, tied, dragged = rounds.load, rounds.bodies.tied, rounds.dragged
    law = PairLaw(bound=load.bound, section=rounds.section)
    read = rounds.D / np.sqrt(len(tied))  # D_0
    y = rounds.with_dragged(rounds.multiplier - read * (rounds.relative + rounds.C * rounds.multiplier))
    found = law.split(y)[1]
    r = np.where(tied, y, found)
    h = np.divide(r - y, read, out=np.zeros_like(y), where=read > 0)
    bound = load.bound.at(np.maximum(r[0], 0.0))
    slope = load.bound.tangent(np.maximum(r[0], 0.0))[0]
    trial = rounds.with_dragged(r - rounds.softened * h)
    springs = PairSprings.of(rounds.section, trial, bound, rounds.softened, tied)
    slips = _slipping(rounds, trial, bound) & (r[0] > 0)
    lag = rounds.relative + rounds.C * r - h
    lag[1:, dragged] = 0.0
    rest = load.f + rounds.bodies.pushed(r) - rounds.internal
    balance = np.abs(np.concatenate([rest, rounds.bodies.resultants(rest)])).max(initial=0.0) / load.force
    apart = np.where(rounds.bodies.moves, np.abs(lag), 0.0).max(initial=0.0) / load.length
    share = slope * np.divide(r[1:], bound, out=np.zeros_like(r[1:]), where=slips & (bound > 0))
    return LawfulPairs(
        forces=r,
        lag=lag,
        state=law.states(y),
        springs=springs,
        share=share,
        residual=float(max(balance, apart)),
        rest=rest,
    )


def _slipping(rounds: MultiplierRounds, trial: Array, bound: Array) -> BoolArray:
    """(a,) Pairs whose friction is all used up."""
    return ~rounds.section.project(trial[1:], bound).inside & ~rounds.bodies.tied
