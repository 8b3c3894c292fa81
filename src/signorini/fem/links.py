# SPDX-License-Identifier: BSD-3-Clause
"""Equations between displacements, and rigid bodies, as rows ``C u = 0`` over all dofs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.fem.cyclic import cyclic_rows
from signorini.fem.obstacles import arm, carried
from signorini.fem.places import nodes_at, place_dofs
from signorini.fem.space import Space
from signorini.model.links import AXES, Equation, directions
from signorini.model.model import Model
from signorini.sparse_rows import chosen_columns

Few = tuple[IntArray, Array]
"""Some dofs (k,), each once, and values (k,) there; 0 elsewhere."""

_AGREEMENT_TOL = 1e-9  # of what supports prescribe: what equations may ask otherwise of it
_CANCELLED_TOL = 1e-11  # of the largest coefficient of an equation: smaller ones are what is left where others cancel


@dataclass(frozen=True, kw_only=True, eq=False)
class Links:
    """Homogeneous equations, one a row.

    Attributes
    ----------
    C : (rows, dofs) coefficients, the largest of each row 1
    first : (rows,) the dof that each should be solved for
    source : (rows,) number of the equation of the model, then of its rigid bodies, then of its cyclic symmetries
    equations, rigid_bodies : how many of them the model has
    """

    C: sp.csr_array
    first: IntArray
    source: IntArray
    equations: int
    rigid_bodies: int

    def where(self, row: int) -> Where:
        """The place in the model that a row comes from."""
        number = int(self.source[row])
        for key, count in (("equation", self.equations), ("rigid_body", self.rigid_bodies)):
            if number < count:
                return (key, number)
            number -= count
        return ("cyclic_symmetry", number)


def linked_nodes(model: Model) -> IntArray:
    """Sorted nodes that equations and rigid bodies name by sets or numbers: they may belong to no cell."""
    mesh = model.mesh
    places = [on for equation in model.equations for on, _, _ in equation.terms]
    places += [body.on for body in model.rigid_bodies]
    sets = {on for on in places if isinstance(on, str) and on in mesh.nodes}
    numbers = np.array([on for on in places if isinstance(on, int)], np.int64)
    found = [mesh.nodes[name] for name in sets]
    return np.unique(np.concatenate([np.flatnonzero(np.isin(mesh.labels, numbers)), *found]).astype(np.int64))


def make_links(space: Space, model: Model) -> Links:
    """The rows of all equations, rigid bodies and cyclic symmetries.

    Raises
    ------
    InputError
        If places of an equation have different numbers of nodes, or a rigid body that no equation names is one node.
    """
    parts = [_equation(space, model, i, equation) for i, equation in enumerate(model.equations)]
    parts += [_rigid(space, model, j) for j in range(len(model.rigid_bodies))]
    parts += [cyclic_rows(space, model, j) for j in range(len(model.cyclic_symmetries))]
    sizes = [len(columns) for columns, _ in parts]
    none = np.empty(0, np.int64)
    widths = [np.full(len(columns), columns.shape[1]) for columns, _ in parts]
    columns = np.concatenate([none, *(columns.ravel() for columns, _ in parts)])
    values = np.concatenate([np.empty(0), *(values.ravel() for _, values in parts)])
    ends = np.cumsum(np.concatenate([[0], *widths]).astype(np.int64))
    C = sp.csr_array((values, columns, ends), shape=(sum(sizes), space.number_of_dofs))
    C.sum_duplicates()
    size = abs(C).max(axis=1).toarray().ravel() if len(ends) > 1 else np.ones(0)
    C.data /= np.repeat(np.where(size > 0.0, size, 1.0), np.diff(C.indptr))
    C.data[abs(C.data) < _CANCELLED_TOL] = 0.0
    C.eliminate_zeros()
    return Links(
        C=C,
        first=np.concatenate([none, *(columns[:, 0] for columns, _ in parts)]),
        source=np.repeat(np.arange(len(parts)), sizes),
        equations=len(model.equations),
        rigid_bodies=len(model.rigid_bodies),
    )


def _equation(space: Space, model: Model, i: int, equation: Equation) -> tuple[IntArray, Array]:
    """Dofs and coefficients, (rows, terms) each."""
    where: Where = ("equation", i, "terms")
    names = [body.name for body in model.rigid_bodies]
    columns = []
    for k, (on, axis, _) in enumerate(equation.terms):
        dofs = place_dofs(space, model, on, (*where, k))
        known = directions(space.dimension) if on in names else AXES[: space.components]
        if axis not in known:
            raise InputError(f"'{axis}' is no direction here; expected one of {', '.join(known)}", where=(*where, k))
        columns.append(dofs[:, known.index(axis)])
    count = max(len(column) for column in columns)
    for k, column in enumerate(columns):
        if len(column) not in (1, count):
            raise InputError(f"has {len(column)} nodes; expected 1 or {count}, as other terms have", where=(*where, k))
    column = np.stack([np.broadcast_to(column, count) for column in columns], axis=1)
    size = [1.0 if axis in AXES else arm(model) for _, axis, _ in equation.terms]  # dofs of rotations are lengths
    values = np.array([coefficient for _, _, coefficient in equation.terms]) / size
    return column, np.broadcast_to(values, column.shape)


def rigid_nodes(space: Space, model: Model, j: int) -> IntArray:
    """Sorted nodes of the rigid body of number j.

    Parameters
    ----------
    space, model : where the body is

    Raises
    ------
    InputError
        If there is nothing where it is.
    """
    on = model.rigid_bodies[j].on
    if on not in model.mesh.bodies:
        return nodes_at(space, on, ("rigid_body", j, "on"))
    cells = np.flatnonzero(model.body_of_cells() == [body.name for body in model.bodies].index(on))
    own = [
        cells[(cells >= block.first) & (cells < block.first + len(block.cells))] - block.first for block in space.blocks
    ]
    return np.unique(
        np.concatenate([block.cells[some] for block, some in zip(space.blocks, own, strict=True)], axis=None)
    )


def _rigid(space: Space, model: Model, j: int) -> tuple[IntArray, Array]:
    """``u_i - u - theta x (x_i - point) = 0`` for every node of a rigid body: dofs and coefficients."""
    body, d = model.rigid_bodies[j], space.dimension
    where: Where = ("rigid_body", j, "on")
    nodes = rigid_nodes(space, model, j)
    if len(nodes) < 2 and not any(on == body.name for other in model.equations for on, _, _ in other.terms):
        raise InputError("is one node, and no equation names it; expected two nodes or more", where=where)
    weights = carried(model, space.mesh.points[nodes], np.array(body.point))[:, :, : len(directions(d))]
    own, shared = space.dofs(nodes), place_dofs(space, model, body.name, where)[0]
    columns = np.concatenate([own[:, :, None], np.broadcast_to(shared, weights.shape)], axis=2)
    values = np.concatenate([np.ones((*own.shape, 1)), -weights], axis=2)
    return columns.reshape(own.size, -1), values.reshape(own.size, -1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Eliminated:
    """Equations solved for some dofs in terms of others.

    Attributes
    ----------
    dependent : (k,) sorted dofs that follow
    shares : (k, dofs) from what: ``u[dependent] = shares @ u``, where no dependent dof has a share
    left, rows : (m, dofs) what equations leave to held dofs alone, and which equations they are
    """

    dependent: IntArray
    shares: sp.csr_array
    left: sp.csr_array
    rows: IntArray


def eliminate(links: Links, held: BoolArray) -> Eliminated:
    """Solve the equations, each for its first dof, or where that is held or given already for another.

    Parameters
    ----------
    held : (dofs,) which are never solved for

    Notes
    -----
    An equation whose first dof is in no other is solved at once. The others, chains and those that supports meddle
    with, are eliminated one by one, in order.
    """
    C, total = links.C, links.C.shape[1]
    none = np.empty(0, np.int64)
    if not len(links.first):
        return Eliminated(dependent=none, shares=_stacked([], total), left=_stacked([], total), rows=none)
    occurs = np.bincount(C.indices, minlength=total)
    leading = np.asarray(C[np.arange(len(links.first)), links.first]).ravel()
    plain = ~held[links.first] & (occurs[links.first] == 1) & (leading != 0.0)
    solved, left = _one_by_one(C, links.first, np.flatnonzero(~plain), held)
    tangled = np.array(sorted(solved), np.int64)
    simple = np.flatnonzero(plain)
    own = links.first[simple]
    shares = -(sp.diags_array(1.0 / leading[simple]) @ C[simple]).tocoo() if len(simple) else sp.coo_array((0, total))
    keep = shares.col != own[shares.row]
    entries = (shares.data[keep], (shares.row[keep], shares.col[keep]))
    shares = sp.csr_array(entries, shape=(len(simple), total))
    chained = _stacked([solved[dof] for dof in tangled.tolist()], total)
    if len(tangled):
        shares = _substituted(shares, tangled, chained)
    dependent = np.concatenate([own, tangled])
    order = np.argsort(dependent)
    return Eliminated(
        dependent=dependent[order],
        shares=sp.csr_array(sp.csr_array(sp.vstack([shares, chained]))[order]),
        left=_stacked([left[row] for row in left], total),
        rows=np.array(list(left), np.int64),
    )


_Row = dict[int, float]


def refuse_contradictions(space: Space, links: Links, found: Eliminated, given: Mapping[str, Few]) -> None:
    """What equations leave to held dofs alone must hold for what supports prescribe.

    Parameters
    ----------
    space, links, found : equations, and what is left of them
    given : name of a support to what it prescribes at factor 1

    Raises
    ------
    InputError
        The first that does not.
    """
    for name, (dofs, u) in given.items():
        left = chosen_columns(found.left, dofs)
        wrong = abs(left @ u) > _AGREEMENT_TOL * (abs(left) @ abs(u))
        if wrong.any():
            row = int(np.argmax(wrong))
            dof = int(found.left.indices[found.left.indptr[row]])
            node = dof // space.components
            at = f" (node {space.mesh.labels[node]})" if node < space.mesh.number_of_nodes else ""
            raise InputError(
                f"contradicts the supports: all its displacements are held{at}, and '{name}' does not move them as it "
                "asks; expected one of them to be free",
                where=links.where(int(found.rows[row])),
            )


def _one_by_one(
    C: sp.csr_array, first: IntArray, rows: IntArray, held: BoolArray
) -> tuple[dict[int, _Row], dict[int, _Row]]:
    """Dofs in terms of dofs that are not solved for; and what rows leave to held dofs alone."""
    solved: dict[int, _Row] = {}
    users: dict[int, set[int]] = {}  # dof to the solved ones that have a share of it
    left: dict[int, _Row] = {}
    for row in rows.tolist():
        part = slice(C.indptr[row], C.indptr[row + 1])
        given = dict(zip(C.indices[part].tolist(), C.data[part].tolist(), strict=True))
        size = max(map(abs, given.values()), default=0.0)
        now: _Row = {}
        for dof, value in given.items():
            for other, share in solved.get(dof, {dof: 1.0}).items():
                now[other] = now.get(other, 0.0) + value * share
        now = {dof: value for dof, value in now.items() if abs(value) > _CANCELLED_TOL * size}
        free = {dof: value for dof, value in now.items() if not held[dof]}
        if not free:
            if now:
                left[row] = now
            continue
        pivot = int(first[row]) if int(first[row]) in free else max(free, key=lambda dof: abs(free[dof]))
        shares = {dof: -value / now[pivot] for dof, value in now.items() if dof != pivot}
        for user in users.pop(pivot, set()):
            factor = solved[user].pop(pivot)
            for dof, share in shares.items():
                solved[user][dof] = solved[user].get(dof, 0.0) + factor * share
                users.setdefault(dof, set()).add(user)
        solved[pivot] = shares
        for dof in shares:
            users.setdefault(dof, set()).add(pivot)
    return solved, left


def _stacked(rows: list[_Row], total: int) -> sp.csr_array:
    counts = np.array([0, *(len(row) for row in rows)], np.int64)
    columns = np.array([dof for row in rows for dof in row], np.int64)
    values = np.array([value for row in rows for value in row.values()], np.float64)
    return sp.csr_array((values, columns, np.cumsum(counts)), shape=(len(rows), total))


def _substituted(shares: sp.csr_array, solved: IntArray, rows: sp.csr_array) -> sp.csr_array:
    """Shares of solved dofs, given to those that they follow from."""
    total = shares.shape[1]
    rest = np.ones(total)
    rest[solved] = 0.0
    there = sp.csr_array(shares[:, solved])
    result = sp.csr_array(shares @ sp.diags_array(rest) + there @ rows)
    result.eliminate_zeros()
    return result
