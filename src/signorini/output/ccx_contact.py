# SPDX-License-Identifier: BSD-3-Clause
"""Contact on the nonmortar nodes with the directions and signs of CalculiX."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, padded
from signorini.model.contact import Contact
from signorini.solution.results import ContactResult

_X_TANGENT_LIMIT = 1.0 - 1.5231e-6  # x component of a normal: beyond it CalculiX derives tangents from the z axis


def slave_values(contact: Contact, result: ContactResult) -> Array:
    """Opening, two relative tangential displacements, pressure and two shear stresses of every pair, (n, 6).

    Tangents: the part of the x axis across the normal n, which points into the slave body (where n runs along x that
    of the z axis), and n times that. The displacement is that of the slave, the nonmortar side, less the master's,
    with what the interface yields; the shear stress is what the slave exerts, so that both have one sign. An overlap,
    of an interface with a compliance, is a negative opening.
    """
    normals = padded(result.normals, 3)
    axes = tangents(normals)
    moved = result.along_tangents(result.slip) - contact.tangential_compliance * result.shear
    return np.column_stack(
        [
            result.gap,
            np.einsum("nki,ni->nk", axes, padded(moved, 3)),
            result.pressure,
            -np.einsum("nki,ni->nk", axes, padded(result.shear, 3)),
        ]
    )


def tangents(normals: Array) -> Array:
    """(n, 2, 3) of normals (n, 3).

    >>> tangents(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])).tolist()
    [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]]
    """
    axis = np.where((np.abs(normals[:, 0]) > _X_TANGENT_LIMIT)[:, None], np.eye(3)[2], np.eye(3)[0])
    first = axis - np.sum(axis * normals, axis=1)[:, None] * normals
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, np.cross(normals, first)], axis=1) + 0.0


def slave_energies(contact: Contact, result: ContactResult) -> Array:
    """Energy that the compliance of the interface stores at every pair, (n,)."""
    normal = 0.5 * contact.normal_compliance * result.pressure**2
    if contact.closure is not None:
        normal = contact.closure.stored(result.pressure)
    tangential = 0.5 * contact.tangential_compliance * np.sum(result.shear**2, axis=1)
    energies: Array = result.area * (normal + tangential)
    return energies
