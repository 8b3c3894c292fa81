# SPDX-License-Identifier: BSD-3-Clause
"""Supports, rigid boundaries and equations: the displacements that remain unknown."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, Self

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, Data, IntArray, elsewhere, index_type
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.foundation import make_springs
from signorini.fem.links import Few, Links, eliminate, make_links, refuse_contradictions
from signorini.fem.obstacles import arm, driven
from signorini.fem.places import dofs_on_axis, nodes_at, place_dofs
from signorini.fem.space import Space
from signorini.fem.varying import at_nodes
from signorini.model.links import directions
from signorini.model.model import Model
from signorini.sparse_rows import chosen_columns, renumbered, rows_of, selection, transposed, turned_rows


class Motions(Protocol):
    """Motions of all dofs, see :class:`signorini.fem.rigid.RigidMotions`."""

    @property
    def matrix(self) -> sp.csr_array:
        """(dofs, k)."""


@elsewhere("transform")
@dataclass(frozen=True, kw_only=True, eq=False)
class Constraints:
    """``u = T z + sum_k s_k g_k``: z the free displacements, g_k what support k prescribes at factor 1.

    Attributes
    ----------
    free : (dofs,) index into z; -1 where a support, the axis (or nothing at all) holds the dof, -2 where equations
        give it; dofs that move together share one
    transform : (dofs, z) sparse T, one entry 1 a row, but of dofs that follow from others in equations
    prescribed : name of moving support or obstacle to (dofs,) displacements at factor 1
    springs : elastic foundations by name, see :func:`signorini.fem.foundation.make_springs`
    owner : (dofs,) index of the support that holds the dof, otherwise -1
    nodes : (z,) a node of each free displacement; those of obstacles follow the nodes of the mesh
    dependent, shares : (k,) dofs that follow from others, (k, dofs) ``u[dependent] = shares @ u``
    """

    free: IntArray
    transform: sp.csr_array
    prescribed: Mapping[str, Array]
    springs: Mapping[str, sp.csr_array]
    owner: IntArray
    nodes: IntArray
    dependent: IntArray
    shares: sp.csr_array

    def prescribing(self, prescribed: Mapping[str, Array]) -> Self:
        """Constraints that prescribe something else; ``prescribed`` as above."""
        made = copy(self)
        object.__setattr__(made, "prescribed", prescribed)
        return made

    @property
    def zeros(self) -> Array:
        """(dofs,) Zeros, where vectors of all displacements are: here, or on the ranks of MPI."""
        return np.zeros(len(self.free))

    def placed(self, values: Data) -> Data:
        """Values (dofs,), which nobody changes, where vectors of all displacements are."""
        return values

    def spread(self, dofs: IntArray, values: Array) -> Array:
        """(dofs, ...) Values at some dofs (k,), each once, zero elsewhere, where vectors of all displacements are."""
        result = np.zeros((len(self.free), *values.shape[1:]))
        result[dofs] = values
        return result

    def beside(self, columns: Sequence[Array]) -> Array:
        """(n, k) Values (n,) of all dofs, or of the free displacements, side by side; at least one."""
        return np.stack(columns, axis=-1)

    def displaced(self, free: Array) -> Array:
        """(dofs,) Displacements by free ones (z,) alone, ``T z``; of several (z, k) at once (dofs, k)."""
        found: Array = self.transform @ free
        return found

    def free_of(self, displacement: Array) -> Array:
        """(z,) The free displacements in some of all dofs (dofs,)."""
        return displacement[self.leaders]

    def spread_free(self, free: IntArray, values: Array) -> Array:
        """(z, ...) Values at some free displacements (k,), each once, zero elsewhere, where vectors of these are."""
        result = np.zeros((self.transform.shape[1], *values.shape[1:]))
        result[free] = values
        return result

    def carried(self, rigid: Motions, by: Array) -> Array:
        """(dofs,) Displacements by combinations (k,) of k rigid motions, where vectors of all displacements are."""
        found: Array = rigid.matrix @ by
        return found

    def of_free(self, rigid: Motions, by: Array) -> Array:
        """(z, m) The free displacements in combinations (k, m) of k rigid motions."""
        found: Array = (rigid.matrix @ by)[self.leaders]
        return found

    def resultants(self, rigid: Motions, forces: Array) -> Array:
        """(k,) Work of forces (dofs,) on k rigid motions."""
        found: Array = transposed(rigid.matrix) @ forces
        return found

    def on_free(self, forces: Array) -> Array:
        """(z,) What forces (dofs,) are on the free displacements, ``T^T f``; of several (dofs, k) at once (z, k)."""
        found: Array = self._transposed @ forces
        return found

    def in_free(self, rows: sp.csr_array) -> sp.csr_array:
        """(k, z) Rows (k, dofs), whose entries stand at one place each, in terms of the free displacements, ``B T``."""
        count = self.transform.shape[1]
        if len(self.transform.indices) != count or len(self.dependent):
            return sp.csr_array(rows @ self.transform)
        found = turned_rows(renumbered(rows, self.free, count))  # with the digits that the product has
        found.eliminate_zeros()
        return found

    @cached_property
    def _transposed(self) -> sp.csc_array:
        """T^T, asked for in every round of small models."""
        return transposed(self.transform)

    @property
    def leaders(self) -> IntArray:
        """(z,) The first dof of each free displacement."""
        given = np.flatnonzero(self.free >= 0)[::-1]
        first = np.empty(self.transform.shape[1], np.int64)
        first[self.free[given]] = given  # the last that is written stays
        return first

    @property
    def held(self) -> BoolArray:
        """(dofs,) Whether a support, the axis or nothing at all holds the dof."""
        return np.asarray(self.free == -1)

    @cached_property
    def alone(self) -> BoolArray:
        """(dofs,) Free displacements that no other dof follows."""
        count = np.bincount(self.transform.indices, minlength=self.transform.shape[1])
        return np.asarray((self.free >= 0) & (count[self.free] == 1)) if len(count) else self.free >= 0

    def completed(self, displacement: Array) -> Array:
        """Displacements of all dofs (dofs,), those of dependent ones as they follow from the others."""
        completed = np.array(displacement)
        completed[self.dependent] = self.shares @ displacement
        return completed

    def support_forces(self, lacking: Array) -> Array:
        """(dofs,) Forces of supports: what equilibrium lacks (dofs,), where equations hand it on to."""
        force = self.handed_on(np.where(self.alone, 0.0, lacking))
        return np.where(self.held, force, 0.0)

    def handed_on(self, forces: Array) -> Array:
        """Forces on all dofs (dofs,), those on dependent ones given to the dofs that they follow from."""
        if not len(self.dependent):
            return forces
        given = forces.copy()
        given[self.dependent] = 0.0
        result: Array = given + self.shares.T @ forces[self.dependent]
        return result

    def foundation_forces(self, displacement: Array) -> Array:
        """Forces of all elastic foundations on the bodies, (dofs,)."""
        return sum((-(S.T @ (S @ displacement)) for S in self.springs.values()), np.zeros(len(self.free)))


def transform_of(free: IntArray, count: int, dependent: IntArray, shares: sp.csr_array) -> sp.csr_array:
    """(dofs, z) Displacements of the free ones, T of `Constraints`.

    Parameters
    ----------
    free, dependent, shares : as there
    count : of the free displacements, z
    """
    given = free >= 0
    start = np.concatenate([np.zeros(1, np.int32), np.cumsum(given, dtype=np.int32)])
    columns = free[given].astype(np.int32)
    T = rows_of(np.ones(len(columns)), columns, start, (len(free), count))
    if len(dependent):
        T = sp.csr_array(T + selection(dependent, len(free)).T @ (shares @ T))
    return T


@dataclass(frozen=True, kw_only=True, eq=False)
class _Prescribed:
    """What is known before anything is solved for.

    Attributes
    ----------
    held : (dofs,)
    owner : (dofs,) index of the support, otherwise -1
    values : name to dofs (k,), each once, and (k,) what they are at factor 1; 0 elsewhere
    """

    held: BoolArray
    owner: IntArray
    values: dict[str, Few]


def make_constraints(
    space: Space,
    model: Model,
    *,
    without: Collection[str] = (),
    spread: Callable[[IntArray, Array], Array] | None = None,
) -> Constraints:
    """Read supports, rigid loaded boundaries, equations and rigid bodies.

    Parameters
    ----------
    space, model : of the supports
    without : names of supports that do not act
    spread : puts what they prescribe where vectors of all displacements are, see `Constraints.spread`; None: here

    Raises
    ------
    InputError
        If two supports prescribe different values at one node, a support moves a node off the axis of an axisymmetric
        body, a rigid boundary carries a support in its direction, or equations contradict what supports prescribe.
    """
    links = make_links(space, model) if model.couples else None
    given = _prescribed(space, model, links, without)
    leader = _leaders(space, model, given)
    total = space.number_of_dofs
    follows, shares = np.zeros(total, bool), selection(np.empty(0, np.int32), total)
    if links is not None:
        # dofs of a rigid loaded boundary are one unknown
        C = sp.csr_array(links.C @ selection(leader, total))
        links = replace(links, C=C, first=leader[links.first])
        found = eliminate(links, given.held)
        refuse_contradictions(space, links, found, given.values)
        follows[found.dependent], shares = True, found.shares
    free = np.full(total, -1)
    unknown = np.flatnonzero(~given.held & ~follows & (leader == np.arange(total)))
    free[unknown] = np.arange(len(unknown))
    free[follows] = -2
    free = np.where(given.held, -1, free[leader])
    dependent = np.flatnonzero(free == -2)
    if len(dependent):
        shares = shares[np.searchsorted(np.flatnonzero(follows), leader[dependent])]
    narrow = index_type(total)
    made = Constraints(
        free=free.astype(narrow),
        transform=transform_of(free, len(unknown), dependent, shares),
        prescribed={},
        springs=make_springs(space, model) if model.foundations else {},
        owner=given.owner.astype(narrow),
        nodes=unknown // space.components,
        dependent=dependent,
        shares=shares,
    )
    put = spread or made.spread
    return made.prescribing({name: put(*_completed(made, few)) for name, few in given.values.items()})


def _completed(constraints: Constraints, few: Few) -> Few:
    """Displacements of held dofs, and with them those of dependent ones."""
    (dofs, values), dependent = few, constraints.dependent
    if not len(dependent):
        return few
    given = chosen_columns(constraints.shares, dofs) @ values
    return np.concatenate([dofs, dependent]), np.concatenate([values, given])


def _prescribed(space: Space, model: Model, links: Links | None, without: Collection[str]) -> _Prescribed:
    """What supports, moving obstacles and the axis hold, and what belongs to nothing."""
    total, d = space.number_of_dofs, space.components
    axis_dofs = dofs_on_axis(space, model)
    owner = np.full(total, -1)
    known: Few = np.zeros(0, np.int64), np.zeros(0)
    prescribed = {support.label: [known] for support in model.supports if support.moves}
    for i, support in enumerate(model.supports):
        if support.label in without:
            continue
        places = place_dofs(space, model, support.on, ("support", i, "on"))
        for axis, part in enumerate(support.u):
            if part is None:
                continue
            dofs = places[:, axis]
            value = _values(space, model, i, axis, dofs)
            moved = np.isin(dofs, axis_dofs) & (value != 0.0)
            _check_axis(space, dofs[moved], i, value[moved])
            _check_agreement(space, model, owner, known, dofs, i, value)
            new = owner[dofs] < 0
            owner[dofs[new]] = i
            known = _joined([known, (dofs[new], value[new])])
            if support.moves:
                prescribed[support.label].append((dofs[new], value[new]))
    held = owner >= 0
    for j, obstacle in enumerate(model.obstacles):
        dofs = space.obstacle_dofs(j)
        held[dofs], path = driven(model, j)
        if path.any():
            prescribed[obstacle.label] = [(dofs, path)]
    for j in range(len(model.rigid_bodies)):
        dofs = space.obstacle_dofs(len(model.obstacles) + j)
        held[dofs[len(directions(space.dimension)) :]] = True
        held[dofs[[0] if model.twists else [0, 2]]] |= model.axisymmetric
    loose = np.zeros(total, bool)
    loose[: d * len(space.used)] = np.repeat(~space.used, d)
    if links is not None:
        loose[links.C.indices] = False
    held |= loose
    held[axis_dofs] = True
    return _Prescribed(held=held, owner=owner, values={name: _joined(parts) for name, parts in prescribed.items()})


def _joined(parts: Sequence[Few]) -> Few:
    """Some dofs and more of them."""
    dofs, values = zip(*parts, strict=True)
    return np.concatenate(dofs), np.concatenate(values)


def _values(space: Space, model: Model, i: int, axis: int, dofs: IntArray) -> Array:
    """What support i prescribes in a direction at factor 1, (k,) for its dofs (k,)."""
    support, where = model.supports[i], ("support", i, "u", axis)
    part = support.u[axis]
    assert part is not None
    if isinstance(part, float | int):
        turns = axis >= space.dimension and bool((dofs >= space.dofs_of_nodes).any())
        return np.full(len(dofs), part * arm(model) if turns else part)  # of rotations: lengths
    if (dofs >= space.dofs_of_nodes).any():
        raise InputError("varies, but a rigid body moves as one; expected a number", where=where)
    nodes = dofs // space.components
    on = str(support.on)
    side = boundary(space, on, (*where[:2], "on")) if on in space.mesh.boundaries else None
    return at_nodes(part, space, nodes, where, side)


def _leaders(space: Space, model: Model, given: _Prescribed) -> IntArray:
    """(dofs,) The dof that each follows: on a rigid loaded boundary the first one there; itself elsewhere."""
    leader = np.arange(space.number_of_dofs)
    for i, load in enumerate(model.loads):
        if load.spread != "displacement" or load.force is None:
            continue
        nodes = nodes_at(space, load.on, ("load", i, "on"))
        for axis in (axis for axis, part in enumerate(load.force) if part is not None):
            dofs = nodes * space.components + axis
            blocked = dofs[given.held[dofs] | (leader[dofs] != dofs)]
            if len(blocked):
                owner = given.owner[blocked[0]]
                by = "the axis" if given.held[blocked[0]] else "another load"
                by = f"support '{model.supports[owner].label}'" if owner >= 0 else by
                number = space.mesh.labels[blocked[0] // space.components]
                raise InputError(
                    f"the boundary should move rigidly in {model.axes[axis]}, but {by} holds node {number} in that "
                    'direction; expected the component to be free (None, in a deck "free")',
                    where=("load", i, "force"),
                )
            leader[dofs] = dofs[0]
    return leader


def _check_axis(space: Space, dofs: IntArray, i: int, value: Array) -> None:
    if len(dofs):
        node, axis = divmod(int(dofs[0]), space.components)
        number = space.mesh.labels[node]
        raise InputError(
            f"u_{'rzt'[axis]} = {value[0]:g} at node {number}, which is on the axis and stays there; expected 0 or "
            'None (in a deck "free")',
            where=("support", i, "u"),
        )


def _check_agreement(
    space: Space, model: Model, owner: IntArray, known: Few, dofs: IntArray, i: int, value: Array
) -> None:
    """Two supports may share a dof if neither moves it."""
    both = np.flatnonzero(owner[dofs] >= 0)
    order = np.argsort(known[0])
    other_value = known[1][order[np.searchsorted(known[0], dofs[both], sorter=order)]]
    apart = (value[both] != 0.0) | (other_value != 0.0)
    for dof, own, theirs in zip(dofs[both][apart], value[both][apart], other_value[apart], strict=True):
        other = model.supports[owner[dof]]
        node, axis = divmod(int(dof), space.components)
        on = (
            f"u_{model.axes[axis]} = {own:g} at node {space.mesh.labels[node]}, where"
            if (node < space.mesh.number_of_nodes)
            else f"{own:g} for a rigid body in a direction in which"
        )
        raise InputError(
            f"'{model.supports[i].label}' prescribes {on} "
            f"support '{other.label}' prescribes {theirs:g}; expected one support to move a node in a direction",
            where=("support", i, "u"),
        )
