# SPDX-License-Identifier: BSD-3-Clause
"""How outputs change with the shape of the sides while motions and forces of the pairs stay: areas, normals, places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.derivative.functionals import lever_arm, mean_tangent, value, weights
from signorini.derivative.view import HistoryView
from signorini.interface.interface import Interface
from signorini.model.outputs import AtNode, HalfWidth, Mean, Moment, Output, Peak, Resultant, WeightedSum


@dataclass(frozen=True, kw_only=True, eq=False)
class ShapeWeights:
    """How an output changes with what pairs have of the shape of their sides.

    Attributes
    ----------
    area, normals, tangents, moments : with those of `Interface`, each of its shape, moments (d, n, 1 or 3)
    places : (n, d) with places of the nodes of the pairs themselves
    """

    area: Array
    normals: Array
    tangents: Array
    moments: Array
    places: Array

    @classmethod
    def of(cls, output: Output, view: HistoryView) -> ShapeWeights:
        """Of an output of contacts; zero of those that know no shape."""
        interface = view.interface
        found = cls(
            area=np.zeros(len(interface)),
            normals=np.zeros_like(interface.normals),
            tangents=np.zeros_like(interface.tangents),
            moments=np.zeros((interface.directions, len(interface), interface.moments.shape[1])),
            places=np.zeros((len(interface), view.space.dimension)),
        )
        for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
            found._add(factor, part, view)
        return found

    def of_pairs(self, interface: Interface) -> Array:
        """(n,) The parts of pairs in the sum of what is weighted, but for places."""
        moments = interface.moments.reshape(self.moments.shape)
        return np.asarray(
            self.area * interface.area
            + np.sum(self.normals * interface.normals, axis=1)
            + np.sum(self.tangents * interface.tangents, axis=(1, 2))
            + np.sum(self.moments * moments, axis=(0, 2))
        )

    def _add(self, factor: float, output: Output, view: HistoryView) -> None:
        """Add a part of an output times its factor."""
        i, interface = view.number(output.load_factor), view.interface
        own, r = view.pairs(getattr(output, "contact", "")), view.forces(i)
        if isinstance(output, Peak) or (isinstance(output, AtNode) and output.field in ("pressure", "traction")):
            at = np.flatnonzero(weights(output, view)[i].r.any(axis=0))
            self.area[at] -= factor * value(output, view) / interface.area[at]
        elif isinstance(output, Mean):
            weighted = np.array(output.weights) if output.weights else np.ones(int(own.sum()))
            self.area[own] -= factor * value(output, view) * weighted / float(weighted @ interface.area[own])
        elif isinstance(output, Resultant | Moment):
            pressed = factor * r[0] * own * (output.of != "friction")
            rubbed = factor * r[1:] * own * (output.of != "pressure")
            along = np.array(output.along if isinstance(output, Resultant) else ())
            if isinstance(output, Moment):
                axis = 0 if interface.directions == 2 else output.axis
                along = lever_arm(np.array(output.about), axis)
                self.moments[0, :, axis] += pressed
                self.moments[1:, :, axis] += rubbed
            self.normals[:] += pressed[:, None] * along
            self.tangents[:] += rubbed.T[:, :, None] * along
        elif isinstance(output, HalfWidth):
            self._add_half_width(factor, output, view, r[0])

    def _add_half_width(self, factor: float, output: HalfWidth, view: HistoryView, force: Array) -> None:
        """Places of the pairs along the side, and the mean tangent that they are projected on."""
        interface, own = view.interface, view.pairs(output.contact)
        places, width, f = view.space.mesh.points[interface.node[own]], value(output, view), force[own]
        # the width is the root of a multiple of sum f s^2 / sum f
        if view.model.axisymmetric:
            s, tangent = places[:, 0], np.array([1.0, 0.0])
        else:
            tangent = mean_tangent(interface, own)
            middle = np.array(output.about) if output.about else f @ places / f.sum()
            s = (places - middle) @ tangent
        second = float(f @ s**2) / float(f.sum())
        per_place = factor * width / second * f * s / float(f.sum())
        self.places[own] += per_place[:, None] * tangent
        if not view.model.axisymmetric:
            turned = per_place @ (places - middle)
            turned -= (turned @ tangent) * tangent
            mean = interface.tangents[own, 0].mean(axis=0)
            self.tangents[own, 0] += turned / (float(np.linalg.norm(mean)) * int(own.sum()))
