# SPDX-License-Identifier: BSD-3-Clause
"""The end of a history, from which another goes on."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from signorini.arrays import IntArray
from signorini.errors import InputError
from signorini.interface.interface import Interface
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.solution.state import State

_WHERE = ("start",)


@dataclass(frozen=True, kw_only=True, eq=False)
class Checkpoint:
    """A state, and what it must fit.

    Attributes
    ----------
    state : of all bodies and pairs
    inactive : contacts that are switched off in it
    released : supports that do not hold in it
    contacts : names of all contacts, in order
    contact, node : (n,) contact and node of every pair
    mesh : digest of points and cells
    """

    state: State
    inactive: frozenset[str]
    released: frozenset[str]
    contacts: tuple[str, ...]
    contact: IntArray
    node: IntArray
    mesh: str

    def check(self, model: Model, interface: Interface) -> None:
        """Refuse to be the start of a model that it does not fit.

        Raises
        ------
        InputError
            What differs: the mesh, the number of moving obstacles, the contacts, or a load that the model lacks.
        """
        dofs = len(self.state.displacement)
        rigid = len(model.obstacles) + len(model.rigid_bodies)
        own = model.mesh.points.size + 2 * model.dimension * rigid
        if dofs != own or self.mesh != digest(model.mesh):
            found = f"was computed on another mesh ({dofs} dofs; the model has {own})"
            raise InputError(f"{found}; expected the same mesh, moving obstacles and rigid bodies", where=_WHERE)
        labels = tuple(contact.label for contact in model.contacts)
        if self.contacts != labels:
            found, expected = (", ".join(names) or "none" for names in (self.contacts, labels))
            raise InputError(f"has the contacts {found}; the model has {expected}, expected the same", where=_WHERE)
        if not np.array_equal(self.node, interface.node) or not np.array_equal(self.contact, interface.contact):
            raise InputError("pairs other nodes than the model; expected the same contact surfaces", where=_WHERE)
        strange = self.released - {support.label for support in model.supports}
        if strange:
            raise InputError(f"has released '{min(strange)}'; expected a support of that name", where=_WHERE)
        for name, factor in self.state.point.factors.items():
            if factor and name not in model.scaled_names:
                raise InputError(
                    f"carries '{name}' at factor {factor:g}, which the model has not; expected a load or "
                    "moving support of that name",
                    where=_WHERE,
                )


def digest(mesh: Mesh) -> str:
    """The same for two meshes only if points and cells are the same.

    >>> mesh = Mesh(points=[[0, 0], [1, 0], [0, 1]], cells={"triangle": [[0, 1, 2]]}, bodies={}, boundaries={})
    >>> len(digest(mesh))
    32
    """
    found = hashlib.blake2b(np.ascontiguousarray(mesh.points).tobytes(), digest_size=16)
    for family, cells in mesh.cells.items():
        found.update(family.encode())
        found.update(np.ascontiguousarray(cells, dtype=np.int64).tobytes())
    return found.hexdigest()
