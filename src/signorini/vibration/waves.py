# SPDX-License-Identifier: BSD-3-Clause
"""Waves around a ring of sectors: bodies whose next sector moves alike but for a phase, ``u(R x) = exp(i a) R u(x)``.

With h nodal diameters ``a = 2 pi h / N``. Real and imaginary parts are unknowns of their own, so that every mode is
there twice, a quarter of a wave apart; half a turn of phase needs one of them alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.links import Links, eliminate
from signorini.fem.space import Space
from signorini.fem.supports import make_constraints
from signorini.interface.sectors import wave_motions
from signorini.model.model import Model
from signorini.solution.checkpoint import Checkpoint
from signorini.sparse_rows import selection
from signorini.vibration.bodies import VibratingBodies, vibrating_bodies

_SAME_TURN_TOL = 1e-12  # entry of a rotation


def waves_of(model: Model, diameters: int, end: Checkpoint | None = None) -> VibratingBodies:
    """A sector with its neighbours a phase apart.

    Parameters
    ----------
    model : with cyclic symmetries
    diameters : nodal diameters h, 1 up to half the number of sectors
    end : of a history, see :func:`signorini.vibration.bodies.vibrating_bodies`

    Raises
    ------
    InputError
        If there are no so many waves; see there, too.
    """
    sectors = {symmetry.sectors for symmetry in model.cyclic_symmetries}
    if len(sectors) != 1 or not 0 < diameters <= max(sectors) // 2:
        known = "none" if not sectors else f"at most {max(sectors) // 2}, half the sectors"
        raise InputError(f"is {diameters}; the model has {known}", where=("nodal_diameters",))
    angle = 2.0 * np.pi * diameters / max(sectors)
    apart = vibrating_bodies(model, end, apart=True)
    space, constraints, single = apart.space, apart.constraints, 2 * diameters == max(sectors)
    held = constraints if end is None else make_constraints(space, model, without=end.standing.loosened)
    T = constraints.transform
    near, far = (sp.csr_array(part @ T) for part in wave_motions(space, model, held, angle))
    real, imaginary = (sp.csr_array(part @ T) for part in _sides(space, model, angle))
    K, M, mass, B, rows = apart.K, apart.M, apart.mass, near, real
    copies = 1 if single else 2
    if not single:
        rows = sp.csr_array(sp.block_array([[real, -imaginary], [imaginary, real]]))
        K, M, mass, T = (sp.csr_array(sp.block_diag([part, part])) for part in (K, M, mass, T))
        B = _by_direction(sp.csr_array(sp.block_array([[near, -far], [far, near]])), len(apart.compliance))
    kept, follows = _solved(rows)
    return replace(
        apart,
        constraints=replace(
            constraints, transform=sp.csr_array(T @ follows), nodes=np.tile(constraints.nodes, copies)[kept]
        ),
        K=sp.csr_array(follows.T @ K @ follows),
        M=sp.csr_array(follows.T @ M @ follows),
        mass=mass,
        B=sp.csr_array(B @ follows),
        tied=np.tile(apart.tied, copies),
        closed=np.tile(apart.closed, copies),
        compliance=np.tile(apart.compliance, (1, copies)),
        copies=copies,
    )


def _sides(space: Space, model: Model, angle: float) -> tuple[sp.csr_array, sp.csr_array]:
    """Real and imaginary part of ``u(R x) - exp(i a) R u(x)`` at the first sides of sectors, (rows, dofs) each."""
    real, imaginary = [], []
    ahead: Array | None = None
    for j in range(len(model.cyclic_symmetries)):
        turn, first, second = cyclic_sides(space, model, j)
        ahead = turn if ahead is None else ahead
        phase = angle if np.abs(turn - ahead).max() <= _SAME_TURN_TOL else -angle
        near, far = (_rows(space, nodes) for nodes in (first, second))
        turned = sp.csr_array(sp.kron(sp.eye_array(len(first)), turn) @ near)
        real.append(far - np.cos(phase) * turned)
        imaginary.append(-np.sin(phase) * turned)
    return sp.csr_array(sp.vstack(real)), sp.csr_array(sp.vstack(imaginary))


def _rows(space: Space, nodes: IntArray) -> sp.csr_array:
    """Rows that take the displacements of nodes, node by node, from all dofs."""
    return selection(space.dofs(nodes).ravel(), space.number_of_dofs)


def _by_direction(B: sp.csr_array, directions: int) -> sp.csr_array:
    """Rows of the real and the imaginary part of pairs, direction by direction."""
    n = B.shape[0] // (2 * directions)
    order = np.arange(B.shape[0]).reshape(2, directions, n).swapaxes(0, 1).ravel()
    return sp.csr_array(B[order])


def _solved(rows: sp.csr_array) -> tuple[IntArray, sp.csr_array]:
    """Displacements that stay free where ``rows z = 0``, (k,), and all as they follow from these, (z, k)."""
    size = abs(rows).max(axis=1).toarray().ravel()
    rows = sp.csr_array(sp.diags_array(1.0 / np.where(size > 0.0, size, 1.0)) @ rows)
    rows.eliminate_zeros()
    rows = sp.csr_array(rows[np.diff(rows.indptr) > 0])
    rows.sort_indices()
    largest = np.array([part.argmax() for part in np.split(np.abs(rows.data), rows.indptr[1:-1])], int)
    first = rows.indices[rows.indptr[:-1] + largest].astype(np.int64)
    count = len(first)
    links = Links(C=rows, first=first, source=np.zeros(count, np.int64), equations=1, rigid_bodies=0)
    found = eliminate(links, np.zeros(rows.shape[1], bool))
    kept = np.setdiff1d(np.arange(rows.shape[1]), found.dependent)
    onto = selection(kept, rows.shape[1]).T
    dependent = selection(found.dependent, rows.shape[1]).T
    return kept, sp.csr_array(onto + dependent @ found.shares @ onto)
