# SPDX-License-Identifier: BSD-3-Clause
"""The piece of a mesh that a rank assembles: its nodes and all cells that they are in, so that its rows are whole.

Nothing is added across ranks: nodes and cells of a piece are in the order of the mesh, and so are the sums in its rows.
They have the bits of the rows that one process would make.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.internal_forces import internal_forces
from signorini.fem.kinematics import straining_groups
from signorini.fem.space import Space, make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.supports import Constraints
from signorini.model.body import Body
from signorini.model.kind import axes
from signorini.model.mesh import Mesh
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class PartOfBodies:
    """Some cells of a mesh with their bodies, as they are sent to a rank.

    Attributes
    ----------
    nodes : (m,) their numbers in the mesh, ascending
    points : (m, d) where they are
    cells : family to (k, corners) nodes, counted in the part
    bodies : of the cells; cells of other bodies are elsewhere
    body : (k,) of every cell, one family after the other, the number of its body among those of the part
    kind, thickness : of the model
    """

    nodes: IntArray
    points: Array
    cells: Mapping[str, IntArray]
    bodies: Sequence[Body]
    body: IntArray
    kind: str
    thickness: float

    def model(self, of_mesh: Mapping[str, Any] | None = None, **more: Any) -> Model:
        """A model of these cells and bodies alone.

        Parameters
        ----------
        of_mesh : what its mesh has beside them, see `Mesh`
        more : what it has itself, see `Model`
        """
        named = {body.name: np.flatnonzero(self.body == i) for i, body in enumerate(self.bodies)}
        mesh = Mesh(points=self.points, cells=self.cells, bodies=named, **(of_mesh or {}))
        return Model(mesh, kind=self.kind, thickness=self.thickness, bodies=self.bodies, **more)  # type: ignore[arg-type]


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece(PartOfBodies):
    """What a rank assembles.

    Attributes
    ----------
    own : (m,) nodes of this rank; the others are corners of their cells
    springs : (m d, m d) of elastic foundations
    """

    own: BoolArray
    springs: sp.csr_array

    def made(self, work: Callable[..., Any], *given: Any) -> Any:
        """What a function makes of the space of these cells and a model of them, ``work(space, model, *given)``.

        Parameters
        ----------
        work, given : the function, and what else it is given
        """
        model = self.model()
        return work(make_space(model.mesh, kind=self.kind), model, *given)

    def assembled(self) -> OwnStiffness:
        """The stiffness of the piece, by the kernel that assembles whole meshes."""
        K = self.made(stiffness)
        if self.springs.nnz:
            K = sp.csr_array(K + self.springs)
        else:
            K.eliminate_zeros()  # as the sum does, which takes the memory of two
        return OwnStiffness(K=K, own=self.own_dofs)

    @property
    def own_dofs(self) -> BoolArray:
        """(p,) Dofs of own nodes."""
        return np.repeat(self.own, len(axes(self.kind)))


@dataclass(frozen=True, kw_only=True, eq=False)
class OwnStiffness:
    """The stiffness of a piece on its rank.

    Attributes
    ----------
    K : (p, p) of all dofs of the piece; rows of its own nodes are whole
    own : (p,) dofs of its own nodes
    """

    K: sp.csr_array
    own: BoolArray

    def forces(self, u: Array, how: str) -> Array:
        """Forces on the dofs of own nodes of displacements (p,) of the piece: K u.

        Parameters
        ----------
        u : displacements
        how : "plain", "sharp" as of `internal_forces`, or "sizes": |K| |u|
        """
        if how == "sharp":
            return internal_forces(self.K, u)[self.own]
        found: Array = (abs(self.K) @ np.abs(u) if how == "sizes" else self.K @ u)[self.own]
        return found


def pieces(
    space: Space, model: Model, constraints: Constraints, owner: IntArray, whole: Sequence[IntArray]
) -> Iterator[Piece]:
    """The pieces of all ranks, one after the other.

    Parameters
    ----------
    space, model : of the bodies
    constraints : with the springs of foundations
    owner : (n,) rank that owns each node
    whole : nodes of every rank whose rows must be whole, see `whole_nodes`
    """
    d, count = space.components, len(space.mesh.points)
    springs = sp.csr_array((d * count, d * count))
    for rows in constraints.springs.values():
        springs = sp.csr_array(springs + (rows.T @ rows)[: d * count, : d * count])
    groups = list(straining_groups(space, model))
    for rank, nodes in enumerate(whole):
        asked = np.zeros(count, dtype=np.bool_)
        asked[nodes] = True
        cells: dict[str, list[IntArray]] = {}
        body: dict[str, list[IntArray]] = {}
        for group in groups:
            here = asked[group.cells].any(axis=1)
            cells.setdefault(group.block.family, []).append(group.cells[here])
            body.setdefault(group.block.family, []).append(group.body[here])
        joined = {family: np.concatenate(found) for family, found in cells.items()}
        for found in joined.values():
            asked[found] = True
        local = np.flatnonzero(asked)
        place = np.cumsum(asked) - 1
        bodies, own_body = np.unique(
            np.concatenate([part for family in joined for part in body[family]]), return_inverse=True
        )
        dofs = (d * local[:, None] + np.arange(d)).ravel()
        yield Piece(
            nodes=local,
            points=space.mesh.points[local],
            own=owner[local] == rank,
            cells={family: place[found] for family, found in joined.items() if len(found)},
            bodies=[model.bodies[i] for i in bodies],
            body=own_body,
            kind=model.kind,
            thickness=model.thickness,
            springs=sp.csr_array(springs[dofs][:, dofs]),
        )


def whole_nodes(transform: sp.csr_array, d: int, owner: IntArray, column_owner: IntArray, ranks: int) -> list[IntArray]:
    """Nodes of every rank whose rows must be whole: its own, and those that move with an unknown of its own.

    Parameters
    ----------
    transform : (dofs, z) see `Constraints`
    d : displacements of a node
    owner, column_owner : (n,) and (z,) rank of every node and of every free displacement
    ranks : how many there are
    """
    entries = transform.tocoo()
    nodes, by = entries.row // d, column_owner[entries.col]
    meshed = nodes < len(owner)
    return [np.union1d(np.flatnonzero(owner == r), nodes[meshed & (by == r)]) for r in range(ranks)]
