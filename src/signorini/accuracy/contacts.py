# SPDX-License-Identifier: BSD-3-Clause
"""Pressures and frictions of contacts beside those that recovered stresses have, and those of the mesh before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.accuracy.recovery import StressError
from signorini.arrays import Array, padded
from signorini.fem.boundary import boundary
from signorini.fem.space import Space
from signorini.model.model import Model
from signorini.solution.results import ContactResult

_FULL = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
"""Places of the entries of a tensor in xx, yy, zz, xy, yz, xz."""


@dataclass(frozen=True)
class ContactErrors:
    """Squares, summed over contacts with their areas, force squared per area.

    Attributes
    ----------
    pressure, friction : of differences
    scale : of the pressures themselves
    """

    pressure: float
    friction: float
    scale: float

    def scaled(self, share: float) -> ContactErrors:
        """With a share of the squares of differences."""
        return replace(self, pressure=share * self.pressure, friction=share * self.friction)


def trace_errors(space: Space, model: Model, contacts: Sequence[ContactResult], stress: StressError) -> ContactErrors:
    """Tractions of the law beside those of the recovered stresses on the body's own surface, along the same normals.

    Parameters
    ----------
    space, model : of the bodies
    contacts : at one load
    stress : recovered at that load
    """
    pressure = friction = scale = 0.0
    bodies = model.body_of_cells()
    for result in contacts:
        side = boundary(space, result.nonmortar, ("contact",))
        normals = side.nodal_normals[np.searchsorted(side.nodes, result.node)]
        normals = padded(normals, result.normals.shape[1])
        body = int(bodies[side.cells[0]])
        nodes, recovered = stress.nodal[body]
        tensors = _tensors(recovered[np.searchsorted(nodes, result.node)], normals.shape[1])
        traction = np.einsum("kij,kj->ki", tensors, normals)
        pressing = np.einsum("ki,ki->k", traction, result.normals)
        shear = traction - pressing[:, None] * result.normals
        pressure += float(result.area @ (pressing - result.pressure) ** 2)
        friction += float(result.area @ ((shear - result.shear) ** 2).sum(axis=1))
        scale += float(result.area @ result.pressure**2)
    return ContactErrors(pressure, friction, scale)


def level_errors(contacts: Sequence[ContactResult], before: Sequence[tuple[Array, Array]]) -> ContactErrors:
    """Tractions beside those of a coarser mesh, carried to this one.

    Parameters
    ----------
    contacts : at one load
    before : of every contact pressures (nodes,) and frictions (nodes, d) of the coarser mesh at the nodes of this one
    """
    pressure = friction = scale = 0.0
    for result, (pressing, shear) in zip(contacts, before, strict=True):
        pressure += float(result.area @ (pressing[result.node] - result.pressure) ** 2)
        friction += float(result.area @ ((shear[result.node] - result.shear) ** 2).sum(axis=1))
        scale += float(result.area @ result.pressure**2)
    return ContactErrors(pressure, friction, scale)


def _tensors(stress: Array, d: int) -> Array:
    """Stresses (k, 4 or 6) as matrices (k, d, d)."""
    whole = np.zeros((len(stress), 6))
    whole[:, : stress.shape[1]] = stress
    return whole[:, _FULL[:d, :d]]
