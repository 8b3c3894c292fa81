# SPDX-License-Identifier: BSD-3-Clause
"""The law of a pair in one unknown: ``y = r - h``, force minus relative motion, d numbers a pair.

Because a pair never presses and gapes at once, and never has friction to spare while it slips, y tells both::

    p = max(y_n, 0)      gap = max(-y_n, 0)
    r_t = the point nearest to y_t of the section of size F(p)      slip = r_t - y_t

with F the bound of the friction, ``mu p`` in Coulomb's law (see `law.bound`), and the section an interval in the plane,
an ellipse or a polygon in space (see `law.section`). Every y obeys the law; what is left to solve is equilibrium: in
the plane one piecewise linear equation in y with four pieces a pair, or two more for every further branch of F.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.law.bound import Bound, FrictionBound
from signorini.law.section import FrictionSection, Projection
from signorini.law.states import OPEN, SLIP, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

_DRAG_FORCE = 1e12  # of the friction: a trial force along which a dragged pair slips, whatever else acts on it


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """The law near a y, to first order: what every pair leaves unknown (see `law.section` for the notation).

    Attributes
    ----------
    closed : (n,) pairs that press
    left : (n,) number of tangential directions whose force is unknown: d - 1 where it sticks, fewer where it slips
    share : (d - 1, n) tangential force per normal force; zero where it sticks
    fixed : (d - 1, n) tangential force that does not depend on the normal force, where friction is bounded so
    tau : (d - 1, n) the unknown direction where one of two is left
    kappa : (n,) slip per force along it
    """

    closed: BoolArray
    left: IntArray
    share: Array
    fixed: Array
    tau: Array
    kappa: Array

    @classmethod
    def of_states(cls, bound: FrictionBound, state: IntArray) -> Tangent:
        """The law of the plane while pairs keep states, (n,) codes with their branch."""
        none = np.zeros((1, len(state)))
        return cls(
            closed=state != OPEN,
            left=(state == STICK).astype(np.int64),
            share=bound.slope(state)[None],
            fixed=none if bound.branches == 1 else bound.start(state)[None],
            tau=none,
            kappa=none[0],
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class PairLaw:
    """The law of n pairs; arrays of pairs are (d, n), the normal in row 0, or (d - 1, n) for tangents.

    Attributes
    ----------
    bound : of the friction, along the longest half-axis of the section
    section : of the friction cones, of size 1
    drag : (d - 1, n) tangential motion of pairs whose supports alone decide it, 0 for the others; None for none

    Examples
    --------
    >>> law = PairLaw(bound=FrictionBound.of([0.5, 0.5]), section=FrictionSection.round(1, 2))
    >>> h, r = law.split(np.array([[2.0, -3.0], [1.5, 4.0]]))
    >>> h.tolist(), r.tolist()
    ([[0.0, 3.0], [-0.5, -4.0]], [[2.0, 0.0], [1.0, 0.0]])
    >>> law = PairLaw(bound=FrictionBound.of([0.5]), section=FrictionSection.round(2, 1))
    >>> h, r = law.split(np.array([[2.0], [3.0], [4.0]]))
    >>> h.round(12).tolist(), r.round(12).tolist()
    ([[0.0], [-2.4], [-3.2]], [[2.0], [0.6], [0.8]])
    """

    bound: Bound
    section: FrictionSection
    drag: Array | None = None

    @cached_property
    def dragged(self) -> BoolArray:
        """(n,) Pairs that supports drag along."""
        none = np.zeros(len(self.section.sides), dtype=np.bool_)
        return none if self.drag is None else np.asarray(self.drag.any(axis=0), dtype=np.bool_)

    @cached_property
    def closed(self) -> IntArray:
        """(n,) The state of each pair wherever it is closed, UNDECIDED where y decides.

        A pair without friction slips, and so does one that supports drag; friction opposes that.

        Examples
        --------
        >>> bound, drag = FrictionBound.of([0.0, 0.3, 0.3]), np.array([[0.0, 0.1, 0.0]])
        >>> PairLaw(bound=bound, section=FrictionSection.round(1, 3), drag=drag).closed.tolist()
        [2, 3, -1]
        """
        closed = np.where(self.dragged, SLIP_PLUS, UNDECIDED)
        if self.drag is not None and len(self.drag) == 1:
            closed[self.drag[0] > 0] = SLIP_MINUS
        closed[~self.rubs] = SLIP_PLUS
        return closed.astype(np.int64)

    @cached_property
    def rubs(self) -> BoolArray:
        """(n,) Pairs with any friction along any tangent."""
        some = (self.bound.steepest > 0) | (self.bound.tangent(np.zeros(len(self.section.sides)))[1] > 0)
        return np.asarray(some & self.section.axes.any(axis=0), dtype=np.bool_)

    def split(self, y: Array) -> tuple[Array, Array]:
        """Motion h = (gap, slip increment) and force r = (normal, tangential) of y, each (d, n), with ``y = r - h``."""
        r = np.empty_like(y)
        np.maximum(y[0], 0.0, out=r[0])
        size = self.bound.at(r[0])
        r[1:] = self.section.nearest(self._trial(y, size), size)
        return r - y, r

    def tangent(self, y: Array) -> Tangent:
        """The law near y, (d, n), to first order."""
        pressing = np.maximum(y[0], 0.0)
        size = self.bound.at(pressing)
        found = self._projected(y, size)
        slips, closed = ~found.inside, y[0] > 0
        slope, start = self.bound.tangent(pressing)
        unit = np.divide(found.r, size, out=np.zeros_like(found.r), where=slips & (size > 0))
        return Tangent(
            closed=closed,
            left=found.left,
            share=np.where(closed, unit * slope, 0.0),
            fixed=unit * start,
            tau=found.tau,
            kappa=found.kappa,
        )

    @property
    def sticking(self) -> Tangent:
        """Every pair closed and sticking, where its friction and its supports let it."""
        y = np.zeros((1 + len(self.section.axes), len(self.section.sides)))
        y[0] = 1.0
        return self.tangent(y)

    def states(self, y: Array) -> IntArray:
        """(n,) Codes of the pieces that y, (d, n), lies in; in the plane those of slip with their branch of the bound.

        Examples
        --------
        >>> law = PairLaw(bound=FrictionBound.of([0.5, 0.5]), section=FrictionSection.round(1, 2))
        >>> law.states(np.array([[2.0, -3.0], [0.5, 4.0]])).tolist()
        [1, 0]
        """
        if len(y) == 3:
            slips = self.split(y)[0][1:].any(axis=0) | ~self.rubs
            return np.where(y[0] <= 0, OPEN, np.where(slips, SLIP, STICK)).astype(np.int64)
        state = np.where(np.abs(y[1]) <= self.bound.at(y[0]), STICK, np.where(y[1] >= 0, SLIP_PLUS, SLIP_MINUS))
        state = np.where(self.closed == UNDECIDED, state, self.closed)
        state = np.where(y[0] <= 0, OPEN, state).astype(np.int64)
        return self.bound.coded(state, y[0]) if isinstance(self.bound, FrictionBound) else state

    def reserve(self, r: Array) -> Array:
        """(n,) Friction to spare under forces r, (d, n): what the normal force could still carry; 0 on the limit."""
        return np.asarray(self.bound.at(np.maximum(r[0], 0.0)) - self.section.effort(r[1:]), dtype=np.float64)

    def _trial(self, y: Array, size: Array) -> Array:
        """(d - 1, n) Tangential part of y, in space of dragged pairs far along the friction that opposes their motion.

        In the plane their states tell (see `closed`), and y itself is in equilibrium with that friction.
        """
        if self.drag is None or len(self.drag) == 1 or not self.dragged.any():
            return y[1:]
        beyond = _DRAG_FORCE * np.maximum(size, self.bound.steepest)[self.dragged]
        drag, trial = self.drag[:, self.dragged], y[1:].copy()
        trial[:, self.dragged] = -beyond * drag / np.linalg.norm(drag, axis=0)
        return trial

    def _projected(self, y: Array, size: Array) -> Projection:
        found = self.section.project(self._trial(y, size), size)
        if self.drag is not None:
            found.left[self.dragged] = 0
        return found
