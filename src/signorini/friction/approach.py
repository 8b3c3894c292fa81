# SPDX-License-Identifier: BSD-3-Clause
"""Rigid bodies that a load carries through the air until they touch: where contact can bear the load from.

However small the load f is, nothing but contact resists it, and equilibrium is where the bodies come to rest. Their way
there is that of rigid bodies in a viscous fluid, of which only where it leads matters::

    v = f + P' r,    (gap rate, slip rate) = P v,    r in Coulomb's law of the pairs that touch

Piece by piece v is constant: up to where a gap closes. It vanishes where forces that friction allows balance f. None of
this takes energy, for all forces are infinitely small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import Spent
from signorini.condense.operator import InterfaceOperator
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import EXCHANGES, unresisted
from signorini.friction.solve import solve_contact
from signorini.law.bound import STICKING_FRICTION
from signorini.law.section import FrictionSection
from signorini.law.states import OPEN, STICK

MAX_PIECES = 200
"""Straight pieces of an approach; each ends where a gap closes."""

_PAIR_COMPLIANCE = 1e-6  # of the motion of a pair under a force on it: its own, which shares forces among many pairs
_VELOCITY_TOL = 1e-6  # of the load: a velocity
_CLOSING_TOL = 1e-9  # of the velocity: a gap that closes
_NOWHERE = 1e-9  # of what overlaps and motions would have to meet: no motion relieves the overlaps
_SAME_TIME_TOL = 1e-12  # of the way: gaps that close together


@dataclass(frozen=True, kw_only=True)
class Approach:
    """How far bodies moved, in terms of the motions given.

    Attributes
    ----------
    motion : (k,)
    loose : (k,) part of it on which nothing touched, so that of several motions the fluid decided between them
    gap : (n,) at its end, exactly 0 where pairs came to touch
    escape : (k,) where it has no end, a motion that the load goes on with and that contact does not resist, whatever
        touches: the proof that there is no equilibrium; otherwise None
    """

    motion: Array
    loose: Array
    gap: Array
    escape: Array | None = None


def approach(P: Array, gap: Array, friction: Array, load: Array, *, width: float) -> Approach | Spent | None:
    """The way of rigid bodies from where they are to where contact can bear a load; where none was found, why if known.

    Parameters
    ----------
    P : (d n, k) motions of the pairs, normals first: of k motions that the fluid resists alike, each on its own
    gap : (n,) not negative
    friction : (d - 1, n) along the tangents; infinite where touching pairs stick
    load : (k,) work of the load along each motion
    width : largest gap of pairs that touch

    Examples
    --------
    A point falls along -y, 2 above a floor whose friction holds it there:

    >>> found = approach(np.array([[0.0, 1.0], [1.0, 0.0]]), np.array([2.0]), np.array([[0.5]]),
    ...                  np.array([0.0, -3.0]), width=1e-12)
    >>> found.motion.tolist(), found.gap.tolist()
    ([0.0, -2.0], [0.0])
    """
    n, k = len(gap), len(load)
    motion, loose, now = np.zeros(k), np.zeros(k), gap.copy()
    load = load / (np.linalg.norm(load) or 1.0)
    for _ in range(MAX_PIECES):
        touching = now <= width
        v = _velocity(P, touching, friction, load)
        if v is None or isinstance(v, Spent):
            return v
        if not v.any():
            return Approach(motion=motion, loose=loose, gap=now)
        closing = -(P[:n] @ v)
        falls = ~touching & (closing > _CLOSING_TOL * np.linalg.norm(v) * np.linalg.norm(P[:n], axis=1))
        if not falls.any():
            escape = _escape(P, friction, load, v)
            if escape is None or isinstance(escape, Spent):
                return escape
            return Approach(motion=motion, loose=loose, gap=now, escape=escape)
        time = float((now[falls] / closing[falls]).min())
        motion += time * v
        loose += 0.0 if touching.any() else time * v
        now = now - time * closing
        now[now <= width + _SAME_TIME_TOL * time * float(np.abs(closing).max())] = 0.0
    return Spent(most=MAX_PIECES, of="straight pieces of a rigid approach")


def relieved(P: Array, gap: Array, *, width: float) -> Array | None:
    """The least motion (k,) after which nothing overlaps; None: overlaps press, wherever bodies go.

    ``min |y|  with  gap + P y >= 0``, a least distance (Lawson, Hanson 1974, chapter 23).

    Parameters
    ----------
    P : (n, k) what gaps change by, of k motions that weigh alike
    gap : (n,) of which some are negative
    width : largest gap of pairs that touch

    Examples
    --------
    >>> relieved(np.array([[0.0, 1.0], [0.0, -1.0]]), np.array([-2.0, 5.0]), width=1e-12).round(12).tolist()
    [0.0, 2.0]
    >>> relieved(np.array([[0.0, 1.0], [0.0, -1.0]]), np.array([-2.0, 1.0]), width=1e-12)  # squeezed
    """
    deepest = -float(gap.min())
    system = np.vstack([P.T, -gap / deepest])
    target = np.eye(len(system))[-1]
    try:
        multipliers, distance = scipy.optimize.nnls(system, target, maxiter=EXCHANGES * len(gap))
    except RuntimeError:  # it has not ended by then
        return None
    if distance < _NOWHERE:
        return None
    motion = deepest * (P.T @ multipliers) / distance**2  # the misfit of the last row, without its cancellation
    return np.asarray(motion) if (gap + P @ motion >= -width).all() else None


def _escape(P: Array, friction: Array, load: Array, v: Array) -> Array | Spent | None:
    """(k,) A motion along which the load works and which no pair resists: v, or another; None where none is known."""
    n, mu = friction.shape[1], np.minimum(friction, STICKING_FRICTION)
    along = mu * (P[n:] @ v).reshape(-1, n)
    if (P[:n] @ v >= np.linalg.norm(along, axis=0) - _CLOSING_TOL * np.linalg.norm(v)).all():
        return v
    return _unresisted(P, mu, load)


def _unresisted(P: Array, mu: Array, load: Array) -> Array | Spent | None:
    return unresisted(P, FrictionSection(axes=mu, sides=np.zeros(mu.shape[1], dtype=np.int64)), load)


def _velocity(P: Array, touching: BoolArray, friction: Array, load: Array) -> Array | Spent | None:
    """(k,) Velocity under a load of size 1, 0 where the touching pairs can bear it; None where none was found."""
    d, still = len(friction) + 1, np.zeros(len(load))
    rows, mu = P[np.tile(touching, d)], friction[:, touching]
    favoured = _unresisted(rows, np.minimum(mu, STICKING_FRICTION), load)
    if favoured is None or isinstance(favoured, Spent):
        return still if favoured is None else favoured
    if not touching.any():
        return load
    found = _forces(rows, mu, load)
    if found is None:
        return None
    forces, state = found
    v: Array = load + rows.T @ forces
    held = rows[np.concatenate([state != OPEN, np.tile(state == STICK, d - 1)])]
    v -= np.linalg.lstsq(held, held @ v, rcond=None)[0]  # what the compliance of the pairs lets pass
    return v if np.linalg.norm(v) > _VELOCITY_TOL else still


def _forces(rows: Array, friction: Array, load: Array) -> tuple[Array, IntArray] | None:
    """(d m,) Forces of m touching pairs on moving bodies and (m,) their states; None where none were found."""
    compliance = rows @ rows.T
    compliance[np.diag_indices_from(compliance)] += _PAIR_COMPLIANCE * compliance.trace() / len(compliance)
    none = np.zeros((len(rows), 0))
    image = InterfaceOperator.of_compliance(compliance, none, none)
    b = image.load(rows @ load, np.zeros(0))
    scale = float(np.abs(b).max())
    found = solve_contact(ContactProblem(image=image, b=b, friction=friction, scale=scale))
    return (found.r.ravel(), found.state) if found.solved else None
