# SPDX-License-Identifier: BSD-3-Clause
"""The condensed contact problem with friction, in the plane and in space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray, frozen, read_only
from signorini.condense.operator import InterfaceOperator
from signorini.errors import InputError
from signorini.law.bound import STICKING_FRICTION, Bound, FrictionBound
from signorini.law.pair import PairLaw
from signorini.law.section import FrictionSection
from signorini.law.states import SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED


@dataclass(frozen=True, kw_only=True)
class ContactProblem:
    """Find h = (gap, slip increment) and r = (normal force, tangential force) of n pairs in the law of friction with::

        G h - W r = b,    G = I - W

    Pairs have d rows, 2 in the plane and 3 in space: n normals, then n of every tangent; gap >= 0 is open, normal force
    >= 0 presses, the tangential force acts on body 1. All quantities are scaled by the square roots of an interface
    stiffness D (the same in all directions of a pair): ``h = D^.5 u``, ``r = D^-.5 forces``, ``W = D^.5 (B (K +
    B'DB)^-1 B') D^.5``. In space friction bounds the tangential force by ``|(r_1 / mu_1, r_2 / mu_2)| <= p``, an
    ellipse whose axes are the tangents of the pair; the slip increment is normal to it, against the force (maximum
    dissipation).

    Parameters
    ----------
    image : W, (d n, d n), its compliance and rigid motions; or give W and motions to `of`.
        ``dataclasses.replace(problem, b=...)`` shares it
    b : (d n,) load: motion of the pairs under the loads plus ``G h0``, h0 = (initial gap, -slip of the step before)
    friction : (n,) mu >= 0, or (d - 1, n) along the tangents; ``inf`` sticks wherever it is closed. A pair on the verge
        of opening may be in equilibrium neither sticking nor open; it slips then, under a normal force of 1e-6 of its
        friction. Or any other `Bound`, of scaled forces
    scale : size of b's entries, from the data, that tolerances refer to; in the units of b
    adhesion, limit : (n,) scaled forces of `law.bound`: friction at no normal force, and the most there is, along the
        axis of the larger friction; None stands for none
    tresca : (n,) pairs whose ``friction`` is the bound itself, a scaled force, whatever the normal force, also where
        the pair is open; None stands for none
    facets : corners of a polygon inscribed in the ellipse that stands for it, the first on the first tangent; a
        multiple of 4, or 0 for the ellipse itself; one number, or (n,)
    axes : (d - 1, n) friction along the tangents over the largest, where it is a `Bound`; None: as ``friction`` says

    Raises
    ------
    InputError
        Where shapes do not fit, entries are not finite, friction is negative, or a pair that may never slip is dragged
        by its supports.

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> problem.pairs, problem.directions, problem.floating
    (1, 2, False)

    References
    ----------
    De Saxce, Feng (1998), Mathematical and Computer Modelling 28:225-245. Acary, Brogliato (2008), Numerical Methods
    for Nonsmooth Dynamical Systems, section 3.9 (the cone and its facets).
    """

    image: InterfaceOperator
    b: Array
    friction: Array | Bound
    scale: float
    adhesion: Array | None = None
    limit: Array | None = None
    tresca: BoolArray | None = None
    facets: int | IntArray = 0
    axes: Array | None = None

    @classmethod
    def of(cls, *, W: ArrayLike, motions: ArrayLike, **law: Any) -> Self:
        """The problem of a given W, (d n, d n), and the rigid motions that the pairs see, (d n, k), W R = R.

        Parameters
        ----------
        W : symmetric, spectrum in [0, 1]; 1 belongs to rigid motions alone. Exactly zero tangential rows say that
            supports lock the pair's motion along that tangent. Kept with W R = R restored to rounding
        motions : k = 0 where supports hold every body
        law : what else the problem takes
        """
        return cls(image=InterfaceOperator.of_form(np.asarray(W), np.asarray(motions)), **law)

    def __post_init__(self) -> None:
        object.__setattr__(self, "b", read_only(self.b))
        for name in ("friction", "adhesion", "limit"):
            given = getattr(self, name)
            if given is not None and not isinstance(given, Bound):
                object.__setattr__(self, name, read_only(given))
        if self.tresca is not None:
            object.__setattr__(self, "tresca", frozen(self.tresca, dtype=np.bool_))
        self._check_shapes()
        self._check_friction()
        if not (np.isfinite(self.scale) and self.scale >= 0):
            raise InputError(f"is {self.scale}; expected a finite number >= 0", where=("scale",))

    @property
    def W(self) -> Array:
        """(d n, d n) InterfaceOperator form, formed when first asked for."""
        return self.image.W

    @property
    def motions(self) -> Array:
        """(d n, k) Rigid motions seen by the pairs."""
        return self.image.motions

    @cached_property
    def pairs(self) -> int:
        """Number of pairs n."""
        if isinstance(self.friction, Bound):
            return len(self.friction.steepest)
        return self.friction.shape[-1]

    @cached_property
    def directions(self) -> int:
        """Rows of a pair, d; without pairs as the friction says, 2 where it is a number a pair."""
        if self.pairs:
            return len(self.b) // self.pairs
        return 2 if isinstance(self.friction, Bound) or self.friction.ndim == 1 else len(self.friction) + 1

    @property
    def floating(self) -> bool:
        """Whether some body is held by contact alone."""
        return bool(self.motions.shape[1])

    def by_pair(self, rows: Array) -> Array:
        """(d, n) Rows of pairs, (d n,), as the law takes them."""
        return rows.reshape(self.directions, self.pairs)

    @cached_property
    def guided(self) -> bool:
        """Whether supports lock the motion of any pair along any tangent."""
        return bool(self.image.still[self.pairs :].any())

    @cached_property
    def locked(self) -> BoolArray:
        """(d - 1, n) Tangents along which the pair moves as its supports do."""
        return self.image.still[self.pairs :].reshape(self.directions - 1, self.pairs)

    @cached_property
    def still(self) -> BoolArray:
        """(d - 1, n) Tangents along which supports keep the pair from moving."""
        return np.asarray(self.locked & (self.by_pair(self.b)[1:] == 0), dtype=np.bool_)

    @cached_property
    def bounded(self) -> BoolArray:
        """(n,) Pairs whose friction does not depend on the normal force, ``tresca``."""
        return np.zeros(self.pairs, np.bool_) if self.tresca is None else self.tresca

    @property
    def unbounded(self) -> BoolArray:
        """(n,) Pairs without any bound on their friction: they stick wherever they are closed."""
        if isinstance(self.friction, Bound):
            return np.zeros(self.pairs, dtype=np.bool_)
        endless = np.atleast_2d(np.isinf(self.friction)).any(axis=0)
        return np.asarray(endless if self.limit is None else endless & np.isinf(self.limit), dtype=np.bool_)

    @cached_property
    def bound(self) -> Bound:
        """Friction that can act along the axis of the larger friction: none where the pair cannot move."""
        if isinstance(self.friction, Bound):
            return self.friction
        mu = self.friction if self.friction.ndim == 1 else self.friction.max(axis=0)
        moves = ~self.still.all(axis=0) if self.guided else np.True_
        mu = np.where(moves, mu, 0.0) if self.guided else mu
        if self.adhesion is None and self.limit is None and self.tresca is None:
            return FrictionBound.coulomb(mu)
        adhesion = 0.0 if self.adhesion is None else np.where(moves, self.adhesion, 0.0)
        limit = np.inf if self.limit is None else self.limit
        if not self.bounded.any():
            return FrictionBound.of(mu, adhesion=adhesion, limit=limit)
        return FrictionBound.of(np.where(self.bounded, 0.0, mu), adhesion=adhesion, limit=limit).fixed(self.bounded, mu)

    @property
    def pieces(self) -> FrictionBound:
        """The bound as one of straight branches, which exact histories and the paths of the plane need.

        Raises
        ------
        InputError
            Where it is another.
        """
        if not isinstance(self.bound, FrictionBound):
            raise InputError("has no straight branches, which exact histories follow", where=("friction",))
        return self.bound

    @property
    def straight(self) -> bool:
        """Whether the bound has straight branches, see `pieces`."""
        return isinstance(self.bound, FrictionBound)

    @property
    def piecewise_linear(self) -> bool:
        """Whether every pair obeys one of a few linear laws: in the plane, with a bound of straight branches."""
        return self.directions == 2 and self.straight

    @cached_property
    def section(self) -> FrictionSection:
        """Of the friction cones, for a larger friction of 1."""
        shape = np.ones((self.directions - 1, self.pairs)) if self.axes is None else self.axes
        if self.pairs and not isinstance(self.friction, Bound) and self.friction.ndim == 2:
            given = np.minimum(self.friction, STICKING_FRICTION)
            largest = given.max(axis=0)
            shape = np.divide(given, largest, out=shape, where=largest > 0)
        sides = np.broadcast_to(np.asarray(self.facets, dtype=np.int64), (self.pairs,))
        return FrictionSection(axes=np.where(self.still, 0.0, shape) if self.guided else shape, sides=sides.copy())

    @cached_property
    def law(self) -> PairLaw:
        """The law of the pairs; of its arrays the tangents that supports drag depend on b."""
        drag = np.where(self.locked.all(axis=0), self.by_pair(self.b)[1:], 0.0) if self.guided else None
        dragged = drag is not None and drag.any()
        return PairLaw(bound=self.bound, section=self.section, drag=drag if dragged else None)

    def closed_states(self, pair: int) -> list[int]:
        """Codes that a pair of the plane can have where it is closed: stick, and slip on every branch of its bound."""
        closed = int(self.law.closed[pair])
        slips = (SLIP_PLUS, SLIP_MINUS) if closed == UNDECIDED else (closed,)
        held = [STICK] if closed == UNDECIDED else []
        return held + [code + 2 * j for j in range(self.pieces.branch_counts[pair]) for code in slips]

    @property
    def mu(self) -> Array:
        """(n,) Friction at the smallest normal forces, per normal force: Coulomb's coefficient where there is no other
        law.
        """
        return self.bound.steepest

    @property
    def half_axes(self) -> Array:
        """(d - 1, n) Half-axes of the cones that hold all friction: sections per normal force, at the smallest."""
        return self.section.axes * self.mu

    @cached_property
    def _free(self) -> Array:
        return self.image.free_motion(self.b)

    def free_motion(self, b: Array | None = None) -> Array:
        """(d n,) Motion of the pairs under a load alone, without its rigid part; that of the problem's b is kept."""
        return self._free if b is None or b is self.b else self.image.free_motion(b)

    def misfit(self, h: Array, r: Array, b: Array | None = None) -> Array:
        """(d n,) ``b - (G h - W r)``, the motion that equilibrium lacks.

        Parameters
        ----------
        h, r : (d, n) motions and forces
        b : (d n,) another load than the problem's
        """
        moved = h.ravel()
        return (self.b if b is None else b) + self.image.applied(moved + r.ravel()) - moved

    def _check_shapes(self) -> None:
        n, rows = self.pairs, len(self.motions)
        if rows not in (2 * n, 3 * n):
            raise InputError(f"has {rows} rows; expected {2 * n} or {3 * n} for {n} pairs", where=("W",))
        data: list[tuple[str, Array | BoolArray, list[tuple[int, ...]]]] = [("b", self.b, [(rows,)])]
        if not isinstance(self.friction, Bound):
            tangents = (rows // n - 1,) if n else (1, 2)  # without a pair nothing tells the plane from space
            data.append(("friction", self.friction, [(n,), *((k, n) for k in tangents)]))
            others = (("adhesion", self.adhesion), ("limit", self.limit), ("tresca", self.tresca))
            data += [(name, given, [(n,)]) for name, given in others if given is not None]
        if self.axes is not None:
            data.append(("axes", self.axes, [(len(self.b) // max(1, n) - 1, n)]))
        for name, found, expected in data:
            if found.shape not in expected:
                said = " or ".join(map(str, expected))
                raise InputError(f"has shape {found.shape}; expected {said} for {n} pairs", where=(name,))
        if not np.isfinite(self.b).all():
            raise InputError("has entries that are not finite", where=("b",))
        facets = np.asarray(self.facets)
        if facets.shape not in ((), (n,)) or (facets < 0).any() or (facets % 4).any():
            raise InputError(
                f"is {self.facets}; expected 0 or a multiple of 4, or one for each pair", where=("facets",)
            )
        if n and self.directions == 2 and facets.any():
            raise InputError("is not 0; in the plane the section of the cone is an interval", where=("facets",))

    def _check_friction(self) -> None:
        """Refuse friction that is none, and pairs without bound on it that supports pull along."""
        if isinstance(self.friction, Bound):
            return
        friction = self.friction
        if not (friction >= 0).all():
            raise InputError(
                "has negative entries or NaN; expected mu >= 0, inf for pairs that stick", where=("friction",)
            )
        for name, given in (("adhesion", self.adhesion), ("limit", self.limit)):
            if given is not None and not ((given >= 0) & (np.isfinite(given) | (name == "limit"))).all():
                raise InputError("has negative entries or NaN; expected scaled forces >= 0", where=(name,))
        if self.tresca is not None and not np.isfinite(friction[..., self.tresca]).all():
            raise InputError("is infinite at a pair in Tresca's law; expected a force", where=("friction",))
        endless = np.isinf(friction) if self.limit is None else np.isinf(friction) & np.isinf(self.limit)
        if self.guided and np.any(self.locked & ~self.still & endless):
            raise InputError(
                "is infinite at a pair whose supports drag it along: it can neither slip nor stick; give a finite mu",
                where=("friction",),
            )
