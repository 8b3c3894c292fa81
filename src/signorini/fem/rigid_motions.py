# SPDX-License-Identifier: BSD-3-Clause
"""Rigid motions of connected parts as displacements of all dofs, and what supports take of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray, among, distinct, index_type
from signorini.fem.rigid import ConnectedBody, rotation_planes
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.sparse_rows import chosen_columns, chosen_rows, gram, of_entries

_FEW_DOFS = 10_000  # up to which motions are made at once, which takes less than to make some rows twice


def rigid_motions(space: Space, parts: Sequence[ConnectedBody]) -> sp.csr_array:
    """Translations along x and y and the rotation ``(-(y - y_c), x - x_c) / size`` of each part, (dofs, motions).

    In space three translations and the rotations ``e_k x (x - c) / size``. Axisymmetric parts move along the axis
    alone, with twist turn about it as well, ``u_t = r / size``: widening a ring or tilting a plate strains it.
    """
    twists = space.components > space.dimension
    d = space.dimension
    full = d + len(rotation_planes(d))
    rows, columns, values = [], [], []
    start, narrow = np.cumsum([0, *(part.motions for part in parts)]), index_type(space.number_of_dofs)
    for i, part in enumerate(parts):
        lever = (space.mesh.places_of(part.nodes) - part.centre) / part.size
        one, along = np.ones(len(part.nodes)), space.dofs(part.nodes).T
        motions = [(k, dofs, one) for k, dofs in enumerate(along)]
        if twists and part.rotations:
            motions[2:] = [(2, along[2], space.mesh.places_of(part.nodes)[:, 0] / part.size)]
        for k, (first, second) in enumerate([] if twists else rotation_planes(d), start=d):
            motions += [(k, along[first], -lever[:, second]), (k, along[second], lever[:, first])]
        if part.obstacle >= 0:
            motions = [(k, dof, np.ones(1)) for k, dof in enumerate(space.obstacle_dofs(part.obstacle)[:full, None])]
        kept = [*part.axes, *range(d, d + part.rotations)]
        for k, dofs, value in motions:
            if k in kept:
                rows.append(dofs)
                columns.append(np.full(len(dofs), start[i] + kept.index(k), narrow))
                values.append(value)
    row, column = (np.concatenate(numbers, dtype=narrow, casting="same_kind") for numbers in (rows, columns))
    return of_entries(np.concatenate(values), row, column, (space.number_of_dofs, int(start[-1])))


class RigidMotions:
    """Rigid motions of all parts, made when somebody asks for them; of large meshes some rows, where they will do.

    Parameters
    ----------
    space, parts : see `rigid_motions`
    """

    def __init__(self, space: Space, parts: Sequence[ConnectedBody]) -> None:
        self._space, self._parts, self._keeps = space, parts, True
        self._kept = rigid_motions(space, parts) if space.number_of_dofs <= _FEW_DOFS else None

    @property
    def matrix(self) -> sp.csr_array:
        """(dofs, motions of all parts), see `rigid_motions`."""
        found = rigid_motions(self._space, self._parts) if self._kept is None else self._kept
        if self._keeps:
            self._kept = found
        return found

    def seen_by(self, dofs: IntArray) -> sp.csr_array:
        """(dofs, motions of all parts) Rows of some dofs (k,); those of others may be empty."""
        if self._kept is not None:
            return self._kept
        asked = among([dofs // self._space.components], self._space.number_of_dofs // self._space.components)
        return rigid_motions(self._space, [part.among(asked) for part in self._parts])

    def forget(self) -> None:
        """Keep them no longer: they are larger than all else that is known of the mesh."""
        self._kept, self._keeps = None, False


def resistance(rigid: RigidMotions, constraints: Constraints) -> Array:
    """(motions of all parts, motions of all parts) Products of what supports and elastic foundations take of motions.

    Parameters
    ----------
    rigid : motions of all parts
    constraints : what supports hold, and elastic foundations
    """
    # what supports, rigid boundaries and equations hold is what the free displacements cannot represent: nothing of the
    # dofs that these are
    leaders = constraints.leaders
    others = np.flatnonzero(~among([leaders], len(constraints.free)))
    lost, follow = chosen_rows(rigid.seen_by(others), others), chosen_rows(constraints.transform, others)
    if follow.nnz:
        seen = distinct(follow.indices)
        lost = lost - chosen_columns(follow, seen) @ chosen_rows(rigid.seen_by(leaders[seen]), leaders[seen])
    # springs count as held, whatever their stiffness
    springs = [(S / abs(S).max()) @ rigid.seen_by(S.indices) for S in constraints.springs.values()]
    return gram(sp.csr_array(sp.vstack([lost, *springs])) if springs else lost)
