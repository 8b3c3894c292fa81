# SPDX-License-Identifier: BSD-3-Clause
"""Volume strain of cells that yield as pressure sees it: what motions in which bodies flow have to leave alone."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.elasticity import STRAIN_PARTS
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.groups import PointGroup
from signorini.plasticity.laws import Heat

_FLOWING = 1e4  # of the strain of first yield: so far on the elastic part is little


def volume_rows(bodies: YieldingBodies) -> sp.csr_array:
    """A, (rows, dofs): ``|A v|^2`` is the integral of the square of the volume strain of a motion v (dofs,).

    Where a rule has negative weights, that of their sizes: it is 0 for the same motions. With a mean dilatation it
    is the projected one, with internal modes what is left where they keep as much of the volume as they can. None
    in plane stress, where the thickness gives way.
    """
    d, dofs = bodies.space.components, bodies.space.number_of_dofs
    found = [sp.csr_array((0, dofs))]
    for group in bodies.groups if not bodies.laws.thin else ():
        rows = _rows_of_cells(group, d)
        columns = (d * group.cells[:, :, None] + np.arange(d)).reshape(len(rows), 1, -1)
        indices = np.broadcast_to(columns, rows.shape).ravel()
        starts = np.arange(0, rows.size + 1, rows.shape[2])
        found.append(sp.csr_array((rows.ravel(), indices, starts), shape=(len(starts) - 1, dofs)))
    return sp.csr_array(sp.vstack(found))


def flow_strains(bodies: YieldingBodies, v: Array, heat: Heat) -> Array:
    """(p, n) Strains of a motion (dofs,) in which bodies flow, shear strains twice the tensor's.

    Amplitudes of internal modes are about those for which flow takes least, and such that volume is kept where it can
    be: whichever they are, the bound holds, because stresses in equilibrium do no work on modes.

    Parameters
    ----------
    bodies, v : the points, and the motion
    heat : tells the yield stress
    """
    rate = bodies.strains(v)
    if bodies.internal:
        largest = (bodies.laws.stress.max(axis=(1, 2))[bodies.body] / (2.0 * bodies.laws.shear[bodies.body])).max()
        far = _FLOWING * largest / (np.abs(rate).max() or 1.0)
        rate = bodies.respond(far * v, bodies.untouched(), heat).points.strain / far
    if bodies.laws.thin:  # the thickness gives way
        rate[:, 2] = -(rate[:, 0] + rate[:, 1])
        return rate
    for group in bodies.groups:
        if group.internal:
            of_modes = _trace(group.modes.gradients, bodies.space.components)
            volume = rate[group.own, :3].sum(axis=1).reshape(*group.weights.shape, 1)
            group.add_mode_strains(-(np.linalg.pinv(of_modes) @ volume).ravel(), rate[group.own])
    return rate


def _rows_of_cells(group: PointGroup, components: int) -> Array:
    """(m, rows, k d) The rows of every cell."""
    trace = _trace(group.gradients, components)
    if group.group.formulation == "mean dilatation":
        functions = group.group.block.pressures
        weighted = group.weights[:, :, None] * functions
        root = np.linalg.cholesky(functions.T @ weighted)
        return np.asarray(np.linalg.solve(root, weighted.swapaxes(1, 2) @ trace))
    size = np.sqrt(np.abs(group.weights))[:, :, None]  # the rule of wedges has points that count negative
    rows = size * trace
    if group.internal:
        of_modes = size * _trace(group.modes.gradients, components)
        return np.asarray(rows - of_modes @ (np.linalg.pinv(of_modes) @ rows))
    return rows


def _trace(gradients: Array, components: int) -> Array:
    """(m, q, k d) Volume strain of unit motions of shape functions or modes with gradients (m, q, k, e)."""
    parts = STRAIN_PARTS[components, gradients.shape[3]]
    rows = gradients @ ((parts >= 0) & (parts < 3)).T.astype(np.float64)
    return rows.reshape(*rows.shape[:2], -1)
