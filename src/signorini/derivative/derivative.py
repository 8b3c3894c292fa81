# SPDX-License-Identifier: BSD-3-Clause
"""The derivative of one output of a history by everything that is given."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, extent
from signorini.checks import vector
from signorini.derivative.by_name import ByName
from signorini.derivative.changes import GapChange
from signorini.derivative.node_gradient import node_gradient
from signorini.derivative.parameters import given_value, names_of, split
from signorini.derivative.shape_sides import ShapeSides
from signorini.derivative.taped_history import DirectionalDerivative, apart
from signorini.derivative.touching_start import GapRate
from signorini.errors import InputError
from signorini.solution.sensitivities import Validity


class Derivative(DirectionalDerivative):
    """The derivative of an output of a history by everything that is given, from one way back through its events.

    Every mapping is by name, and each of its numbers is found when it is asked for.

    Parameters
    ----------
    history : the history
    output : what is differentiated

    Attributes
    ----------
    value : of the output
    friction, adhesion, shear_limit : by contact, per unit of the coefficient or traction
    interference : by contact, per length
    gap : by contact, (n,) per length that the initial gap of each of its nodes grows by
    load, support : by name, per factor that multiplies the load, or what the support prescribes, all along the history
    E, nu, expansion : by body, per unit of it
    """

    def __repr__(self) -> str:
        return f"Derivative of {self.output!r}: {self.value:.6g}"

    @cached_property
    def friction(self) -> ByName:
        """By contact, per unit of the coefficient; by "contact@step" of one that a step gives."""
        return self._all("friction")

    @cached_property
    def adhesion(self) -> ByName:
        """By contact, per unit of the traction without pressure."""
        return self._all("adhesion")

    @cached_property
    def shear_limit(self) -> ByName:
        """By contact, per unit of the largest traction."""
        return self._all("shear_limit")

    @cached_property
    def interference(self) -> ByName:
        """By contact, per length."""
        return self._all("interference")

    @cached_property
    def gap(self) -> ByName:
        """By contact, (n,) per length that the gap of each of its nodes grows by."""
        return ByName(names_of(self._history.prepared, "gap"), self._gap)

    @cached_property
    def load(self) -> ByName:
        """By load, per factor that multiplies it all along the history."""
        return self._all("load")

    @cached_property
    def support(self) -> ByName:
        """By moving support or obstacle, per factor that multiplies what it prescribes."""
        return self._all("support")

    @cached_property
    def E(self) -> ByName:
        """By body, per unit of Young's modulus."""
        return self._all("E")

    @cached_property
    def nu(self) -> ByName:
        """By body, per unit of Poisson's ratio."""
        return self._all("nu")

    @cached_property
    def expansion(self) -> ByName:
        """By body, per unit of the thermal expansion."""
        return self._all("expansion")

    def by(self, parameter: str) -> float:
        """The derivative by a parameter as ``kind.name``, "friction.contact" or "E.pad"."""
        kind, name = split(parameter)
        return float(self._all(kind)[name])

    def sides(self, parameter: str) -> tuple[float, float]:
        """The derivatives by a parameter, ``kind.name``, downwards and upwards; the same but at an event.

        Raises
        ------
        InputError
            Where one of both is not known.
        """
        kind, name = split(parameter)
        return self.to_sides(self._history.change(kind, name), self._given(kind, name), f"'{parameter}'")

    def holds(self, parameter: str) -> Validity:
        """In which changes of a parameter, ``kind.name``, the sequence of events stays; to first order."""
        return self._history.holds(*split(parameter))

    def shape(self, motion: ArrayLike) -> float:
        """The derivative by a motion of the nodes, (nodes, d): a dimension of the bodies as it grows by 1.

        Normals, areas, gaps and loads move along.

        Raises
        ------
        InputError
            Where the motion has another shape, moves nothing, or the output has another derivative to each side of it.
        """
        sides = ShapeSides.of(self._history.prepared, motion)
        low, high = self._to_sides(sides)
        if apart(low, high):
            why = sides.kink(self._history.view) if len(sides.kinked) else self.why_apart(sides.change)
            words = f"the derivative has two sides, {low:.6g} and {high:.6g}; shape_sides(motion) gives both"
            raise InputError(f"{why}: {words}", where=("motion",))
        return self.upwards(sides.change) if len(sides.kinked) else high

    def shape_sides(self, motion: ArrayLike) -> tuple[float, float]:
        """The derivatives by a motion of the nodes, (nodes, d), backwards and forwards along it; mostly the same.

        They differ where nodes leave a straight side opposite a smooth one, part flush ends, or change gaps of pairs
        that touch before anything is loaded; and at an event.

        Raises
        ------
        InputError
            Where the motion has another shape, moves nothing, or one of both is not known.
        """
        return self._to_sides(ShapeSides.of(self._history.prepared, motion))

    def _to_sides(self, sides: ShapeSides) -> tuple[float, float]:
        """The derivatives backwards and forwards along a motion."""
        size = self._length / float(np.abs(sides.motion).max())
        if not len(sides.kinked):
            return self.to_sides(sides.change, size, "the motion")
        found = list(self.between_peaks(sides.change, size))
        for k, way in enumerate((-1.0, 1.0)):
            parts = list(sides.towards(way))
            end = self.beside(parts[0][1], "the motion")[k]
            gap = GapRate.sum([(weight, GapRate.of(part)) for weight, part in parts])
            found[k] += sum(weight * end.along(part) for weight, part in parts) + end.through_start(gap, way)
        return found[0], found[1]

    def profile(self, contact: str, change: ArrayLike) -> float:
        """The derivative by a profile: gaps of a contact that grow all at once, (n,) length per unit, node by node.

        It is the sum of the products of both with `gap` where that is known, and may be known where that is not, as
        where both keep a symmetry.

        Raises
        ------
        InputError
            Where the profile has another shape, or the output has another derivative to each side of it.
        """
        return self.one(*self._profile(contact, change), "the derivative by the profile", "profile_sides")

    def profile_sides(self, contact: str, change: ArrayLike) -> tuple[float, float]:
        """The derivatives by a profile, as of `profile`, downwards and upwards; the same but at an event.

        Raises
        ------
        InputError
            Where the profile has another shape, or one of both is not known.
        """
        return self.to_sides(*self._profile(contact, change), "the profile")

    def _profile(self, contact: str, change: ArrayLike) -> tuple[GapChange, float]:
        """Gaps that grow by a profile, and how much of it is a lot."""
        own = self._history.view.pairs(contact)
        grows = np.array(vector(change, ("change",), dimension=int(own.sum())))
        if not grows.any():
            raise InputError("is 0 everywhere; expected a profile that changes some gap", where=("change",))
        gap = np.zeros(len(own))
        gap[own] = grows
        return GapChange(gap=gap), self._length / float(np.abs(grows).max())

    @property
    def _length(self) -> float:
        """Of the bodies."""
        return float(extent(self._history.prepared.model.mesh.points).max())

    def _given(self, kind: str, name: str) -> float:
        """The size of a parameter as it is given; 1 where that tells none."""
        found = abs(given_value(self._history.prepared, kind, name))
        return found if np.isfinite(found) and found else 1.0

    @cached_property
    def nodes(self) -> Array:
        """(nodes, d) By the place of every node, per length; `shape` of any motion is the sum of its products with it.

        Radii of nodes on the axis stay.

        Raises
        ------
        InputError
            Where motions of single nodes do not add up: those of a straight side opposite another meshed one, and
            those that take apart what pairs do together.
        """
        points = self._history.prepared.model.mesh.points
        return np.array(self._by_nodes).reshape(points.shape)

    @cached_property
    def _by_nodes(self) -> Any:
        """(nodes d,) What `nodes` is, where displacements are."""
        found = node_gradient(self._history.view, self._adjoint, self._read)
        self.refuse_by_nodes("nodes")
        return found

    def _all(self, kind: str) -> ByName:
        return ByName(names_of(self._history.prepared, kind), lambda name: self._by(kind, name))

    def _by(self, kind: str, name: str) -> float:
        """The derivative by one parameter.

        Raises
        ------
        InputError
            Where it has two sides.
        """
        what = f"the derivative by '{kind}.{name}'"
        return self.one(self._history.change(kind, name), self._given(kind, name), what, f"sides('{kind}.{name}')")

    def _gap(self, contact: str) -> Array:
        """(n,) The derivative by the gaps of a contact, node by node.

        Raises
        ------
        InputError
            Where that has two sides.
        """
        return self.by_gaps()[self._history.view.pairs(contact)]
