# SPDX-License-Identifier: BSD-3-Clause
"""The condensed 3D Coulomb contact problem."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.errors import InputError
from signorini.friction.posed import PosedContact
from signorini.law.bound import STICKY, FrictionBound


@dataclass(frozen=True, kw_only=True)
class SpatialProblem(PosedContact):
    """Find h = (gap, slip increment) and r = (normal force, tangential force) of n pairs in Coulomb's law with::

        G h - W r = b,    G = I - W

    Unknowns are ordered n normals, then n first tangents, then n second tangents; signs and scaling are those of
    `CoulombProblem`: gap >= 0 is open, normal force >= 0 presses, the tangential force acts on body 1;
    ``h = D^.5 u``, ``r = D^-.5 forces``, ``W = D^.5 (B (K + B'DB)^-1 B') D^.5``, D the same in the three directions of
    a pair.

    Friction bounds the tangential force of a pair by ``|(r_1 / mu_1, r_2 / mu_2)| <= p``, an ellipse whose axes are the
    tangents of the pair; the slip increment is normal to the ellipse, against the force (maximum dissipation).

    Parameters
    ----------
    image : W, (3n, 3n), its compliance and rigid motions; or give W and motions to `of`
    b : (3n,) load: motion of the pairs under the loads plus ``G h0``, h0 = (initial gap, -slip of the step before)
    friction : (n,) mu >= 0, or (n, 2) along the tangents; ``inf`` sticks wherever it is closed. A pair on the verge of
        opening may be in equilibrium neither sticking nor open; it slips then, under a normal force of 1e-6 of its
        friction
    scale : size of b's entries, from the data, that tolerances refer to; in the units of b
    adhesion, limit : (n,) scaled forces of `law.bound`: friction at no normal force, and the most there is,
        along the axis of the larger friction; None stands for none
    tresca : (n,) pairs whose ``friction`` is the bound itself, a scaled force, whatever the normal force, also where
        the pair is open; None stands for none
    facets : corners of a polygon inscribed in the ellipse that stands for it, the first on the first tangent; a
        multiple of 4, or 0 for the ellipse itself; one number, or (n,)

    Raises
    ------
    InputError
        Where shapes do not fit, entries are not finite, friction is negative, or a pair that may never slip is dragged
        by its supports.

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.0]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> problem.pairs, problem.floating
    (1, False)

    References
    ----------
    De Saxce, Feng (1998), Mathematical and Computer Modelling 28:225-245. Acary, Brogliato (2008), Numerical Methods
    for Nonsmooth Dynamical Systems, section 3.9 (the cone and its facets).
    """

    tresca: BoolArray | None = None
    facets: int | IntArray = 0

    def __post_init__(self) -> None:
        if self.tresca is not None:
            object.__setattr__(self, "tresca", frozen(self.tresca, dtype=np.bool_))
        super().__post_init__()

    @cached_property
    def bounded(self) -> BoolArray:
        """(n,) Pairs whose friction does not depend on the normal force, ``tresca``."""
        return np.zeros(self.pairs, np.bool_) if self.tresca is None else self.tresca

    @cached_property
    def locked(self) -> BoolArray:
        """(n, 2) Tangents along which the pair moves as its supports do."""
        n = self.pairs
        return self.image.still[n:].reshape(2, n).T

    @cached_property
    def bound(self) -> FrictionBound:
        """Of the friction along the axis of the larger friction; that of Tresca's law does not depend on the force."""
        given = self.friction.reshape(self.pairs, -1 if self.pairs else 1).max(axis=1, initial=0.0)
        adhesion = 0.0 if self.adhesion is None else self.adhesion
        limit = np.inf if self.limit is None else self.limit
        bound = FrictionBound.of(np.where(self.bounded, 0.0, given), adhesion=adhesion, limit=limit)
        if not self.bounded.any():
            return bound
        known = np.where(self.bounded, given, 0.0)
        slopes, kinks = np.where(self.bounded, 0.0, bound.slopes), bound.kinks.copy()
        kinks[1:, self.bounded] = np.inf
        return FrictionBound(slopes=slopes, starts=np.where(self.bounded, known, bound.starts), kinks=kinks)

    @cached_property
    def axes(self) -> Array:
        """(n, 2) Half-axes of the section over the larger of them; none along a locked tangent that is not dragged."""
        n = self.pairs
        given = np.minimum(self.friction.reshape(n, -1 if n else 1) * np.ones((1, 2)), STICKY)
        largest = given.max(axis=1, initial=0.0)[:, None]
        shape = np.divide(given, largest, out=np.ones_like(given), where=largest > 0)
        still = self.locked & (self.b[n:].reshape(2, n).T == 0)
        return np.asarray(np.where(still, 0.0, shape), dtype=np.float64)

    @cached_property
    def mu(self) -> Array:
        """(n, 2) Friction at the smallest normal forces, per normal force; in Tresca's law friction itself."""
        bound = self.bound
        return self.axes * np.where(self.bounded, bound.starts[0], bound.slopes[0])[:, None]

    @cached_property
    def dragged(self) -> BoolArray:
        """(n,) Pairs whose whole tangential motion is that of their supports, and not zero."""
        moved = self.b[self.pairs :].reshape(2, -1).any(axis=0)
        return np.asarray(self.locked.all(axis=1) & moved, dtype=np.bool_)

    @cached_property
    def sides(self) -> IntArray:
        """(n,) Corners of the polygon of every pair, ``facets``."""
        return np.broadcast_to(np.asarray(self.facets, dtype=np.int64), (self.pairs,)).copy()

    @cached_property
    def free_motion(self) -> Array:
        """(3n,) Motion of the pairs under the load alone, without its rigid part."""
        return self.image.free_motion(self.b)

    def _check(self) -> None:
        n = self.pairs
        self._check_data(3 * n, [(n,), (n, 2)])
        if self.bounded.shape != (n,):
            raise InputError(f"has shape {self.bounded.shape}; expected {(n,)}", where=("tresca",))
        if not np.isfinite(self.friction[self.bounded]).all():
            raise InputError("is infinite at a pair in Tresca's law; expected a force", where=("friction",))
        facets = np.asarray(self.facets)
        if facets.shape not in ((), (n,)) or (facets < 0).any() or (facets % 4).any():
            raise InputError(
                f"is {self.facets}; expected 0 or a multiple of 4, or one for each pair", where=("facets",)
            )
        self._check_dragged(np.asarray(self.locked & (self.b[n:].reshape(2, n).T != 0)))


def from_compliance(
    A: ArrayLike, c: ArrayLike, friction: ArrayLike, *, facets: int = 0
) -> tuple[SpatialProblem, Array]:
    """The problem ``u = A r + c`` of bodies that supports hold, in its image form.

    With X = D^.5 A D^.5 the image form is ``W = X (I + X)^-1``, ``b = (I + X)^-1 D^.5 c``; it exists for any
    positive semidefinite A. D is 3 over the trace of a pair's block.

    Parameters
    ----------
    A : (3n, 3n) symmetric positive semidefinite compliance, ordered as in `SpatialProblem`, length per force
    c : (3n,) motion of the pairs under the loads, gaps included, length
    friction, facets : see `SpatialProblem`

    Returns
    -------
    problem, root : root (3n,) holds the square roots of D: ``u = h / root``, forces ``r root``

    Examples
    --------
    >>> problem, root = from_compliance(4.0 * np.eye(3), [-1.0, 0.0, 0.0], [0.3])
    >>> problem.W.diagonal().tolist(), problem.b.tolist(), root.tolist()
    ([0.5, 0.5, 0.5], [-0.25, 0.0, 0.0], [0.5, 0.5, 0.5])
    """
    compliance, offset = np.asarray(A, dtype=np.float64), np.asarray(c, dtype=np.float64)
    if compliance.shape != (len(offset), len(offset)) or len(offset) % 3:
        raise InputError(f"has shape {compliance.shape}, c {offset.shape}; expected (3n, 3n) and (3n,)", where=("A",))
    trace = compliance.diagonal().reshape(3, -1).sum(axis=0)
    if not (trace > 0).all():
        raise InputError(f"pair {int(np.argmin(trace))} has no positive compliance in any direction", where=("A",))
    root = np.tile(np.sqrt(3.0 / trace), 3)
    X = root[:, None] * compliance * root
    softened = np.linalg.solve(X + np.eye(len(X)), np.column_stack([X, root * offset]))
    W, b = softened[:, :-1], softened[:, -1]
    problem = SpatialProblem.of(
        W=(W + W.T) / 2,
        b=b,
        friction=np.asarray(friction, dtype=np.float64),
        motions=np.zeros((len(offset), 0)),
        scale=float(np.abs(b).max(initial=0.0)),
        facets=facets,
    )
    return problem, root
