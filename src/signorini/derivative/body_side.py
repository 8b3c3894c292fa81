# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and pairs at one side of a parameter: only what it may change is assembled, when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, distinct
from signorini.engine.examine import on_ranks
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.fem.foundation import make_springs
from signorini.fem.kinematics import of_bodies, straining_groups
from signorini.fem.loads import forces_at, load_forces
from signorini.fem.space import Space
from signorini.fem.stiffness import stiffness, stiffness_change
from signorini.fem.supports import Constraints, make_constraints
from signorini.fem.thermal import given_temperature, thermal_forces
from signorini.interface.first_tangents import without_jumps
from signorini.interface.interface import Interface, make_interface
from signorini.interface.sectors import sector_interface
from signorini.model.body import Body
from signorini.model.conditions import BODY_LOADS, Load
from signorini.model.model import Model
from signorini.sparse_rows import chosen_columns, chosen_rows


@dataclass(frozen=True, kw_only=True, eq=False)
class BodySide:
    """Bodies and pairs at one side of a parameter.

    Attributes
    ----------
    prepared : the model between both sides of the parameter
    model, space : what is on the mesh, and the mesh
    body : number of the body whose material the parameter is of; None where the parameter moves nodes
    motion, part : (nodes, d) that does so, length, and how much of it leads here; None where nodes stay
    """

    prepared: Prepared
    model: Model
    space: Space
    body: int | None = None
    motion: Array | None = None
    part: float = 0.0

    def stiffness_change(self, other: BodySide, width: float) -> Any:
        """(dofs, dofs) What the stiffness at the other side has beyond that at this one, in parts of a width.

        It is multiplied with displacements where these are: on the ranks of MPI, by rows of the matrix there.
        """
        prepared, K = self.prepared, self.prepared.K
        if self.body is not None:
            given = self.model.bodies[self.body], other.model.bodies[self.body], width
            if on_ranks(K):
                return K.of_pieces(_stiffness_of_material, *given)
            return _stiffness_of_material(self.space, self.model, *given)
        assert self.motion is not None
        parts, springs = (self.part, other.part, width), self._springs_change(other, width)
        if on_ranks(K):
            of_cells = K.of_pieces(_stiffness_of_motion, K.at_pieces(self.motion), *parts)
            return _WithSprings(of_cells, springs, prepared.constraints) if springs.nnz else of_cells
        found = _stiffness_of_motion(prepared.space, self.model, self.motion, *parts)
        return sp.csr_array(found + springs) if springs.nnz else found

    def _springs_change(self, other: BodySide, width: float) -> sp.csr_array:
        """(dofs, dofs) What foundations have beyond those at this side, in parts of a width."""
        found = sp.csr_array((self.space.number_of_dofs, self.space.number_of_dofs))
        for side, sign in ((self, -1.0), (other, 1.0)) if self.model.foundations else ():
            for springs in make_springs(side.space, side.model).values():
                found = sp.csr_array(found + sign * (springs.T @ springs))
        return sp.csr_array(found / width)

    @cached_property
    def loads(self) -> Mapping[str, Any]:
        """(dofs,) At factor 1, by name, of loads that the parameter may change, where vectors of displacements are."""
        if self.body is not None:
            body = self.model.bodies[self.body]
            heats = [load for load in self.model.loads if load.temperature is not None and load.on == body.name]
            return {load.label: self._heat(load, body) for load in heats}
        rigid, every = [body.name for body in self.model.rigid_bodies], enumerate(self.model.loads)
        return {load.label: self._moved(i, load) for i, load in every if load.on not in rigid}

    def _heat(self, load: Load, body: Body) -> Any:
        """(dofs,) Forces of a temperature of a body."""
        K, given = self.prepared.K, load.temperature
        if callable(given):
            load = replace(load, temperature=np.array(given_temperature(load, self.space.mesh.points)))
        if on_ranks(K):
            return K.vector_of_pieces(_heat_of_material, *at_pieces(K, load), body)
        return _heat_of_material(self.space, self.model, load, load.temperature, body)

    def _moved(self, i: int, load: Load) -> Any:
        """(dofs,) Forces of load i where nodes are."""
        K, constraints, given = self.prepared.K, self.prepared.constraints, load.temperature
        if not (load.kind in BODY_LOADS or given is not None):
            nodes, forces = forces_at(self.space, self.model, load, ("load", i))
            return constraints.spread(self.space.dofs(nodes).ravel(), forces.ravel())
        if on_ranks(K) and not callable(given):  # a function of places may be known here alone
            return K.vector_of_pieces(_load_of_motion, *at_pieces(K, load), K.at_pieces(self.motion), self.part)
        return constraints.placed(load_forces(self.space, self.model, load, ("load", i)))

    @cached_property
    def interface(self) -> Interface:
        """The pairs."""
        return pairs_at(self.prepared, self.space, self.model)


class _WithSprings(NamedTuple):
    """A matrix (dofs, dofs) of cells, on the ranks, and of foundations, which is here.

    Attributes
    ----------
    cells, springs : both
    constraints : know where displacements are
    """

    cells: Any
    springs: sp.csr_array
    constraints: Constraints

    def __matmul__(self, u: Any) -> Any:
        """Products with displacements (dofs, k)."""
        seen = distinct(self.springs.indices)
        forces = chosen_columns(chosen_rows(self.springs, seen), seen) @ u[seen]
        return self.cells @ u + self.constraints.spread(seen, forces)


def at_pieces(K: Any, load: Load) -> tuple[Load, Any]:
    """A load as ranks are sent it, and its temperature, by nodes of their pieces where it varies; no function."""
    given = load.temperature
    if given is None:
        return load, None
    return replace(load, temperature=0.0), K.at_pieces(given) if isinstance(given, np.ndarray) else given


def under_load(model: Model, load: Load, temperature: Any) -> tuple[Model, Load]:
    """The model, or that of a piece, which has none, under a load with a temperature, and that load."""
    load = load if temperature is None else replace(load, temperature=temperature)
    loads = [load if each.label == load.label else each for each in model.loads] or [load]
    return replace(model, loads=loads), load


def _of_material(model: Model, body: Body) -> Model:
    """The model with another body of that name."""
    bodies = [body if each.name == body.name else each for each in model.bodies]
    return replace(model, bodies=bodies)


def _stiffness_of_material(space: Space, model: Model, low: Body, high: Body, width: float) -> sp.csr_array:
    """(dofs, dofs) What another material of a body adds to the stiffness of cells, in parts of a width."""
    own = np.array([each.name == low.name for each in model.bodies])
    before, after = (_of_material(model, body) for body in (low, high))
    if not own.any():
        return sp.csr_array((space.number_of_dofs, space.number_of_dofs))
    found = stiffness_change(space, before, after, of_bodies(straining_groups(space, before), own))
    found.data /= width
    return found


def _stiffness_of_motion(
    space: Space, model: Model, motion: Array, low: float, high: float, width: float
) -> sp.csr_array:
    """(dofs, dofs) What a motion (nodes, d) changes of the stiffness of cells between two parts, over a width."""
    one, other = (stiffness(_at(space, motion, part), model) for part in (low, high))
    if np.array_equal(one.indptr, other.indptr) and np.array_equal(one.indices, other.indices):
        return sp.csr_array(((other.data - one.data) / width, one.indices, one.indptr), shape=one.shape)
    return sp.csr_array((other - one) / width)


def _at(space: Space, motion: Array, part: float) -> Space:
    """Cells whose nodes a part of a motion has taken elsewhere before anything was loaded."""
    return space.at(space.mesh.points + part * motion, space.displacement)


def _heat_of_material(space: Space, model: Model, load: Load, temperature: Any, body: Body) -> Array:
    """(dofs,) Forces of a temperature, one number or that of every node, of a body that may be none of the model."""
    found = np.zeros(space.number_of_dofs)
    if any(each.name == body.name for each in model.bodies):
        hot, load = under_load(_of_material(model, body), load, temperature)
        found[: space.dofs_of_nodes] = thermal_forces(space, hot, load)
    return found


def _load_of_motion(space: Space, model: Model, load: Load, temperature: Any, motion: Array, part: float) -> Array:
    """(dofs,) Forces of a load on a body that may be none of the model, whose nodes are a part of a motion farther."""
    if all(body.name != load.on for body in model.bodies):
        return np.zeros(space.number_of_dofs)
    under, load = under_load(model, load, temperature)
    return load_forces(_at(space, motion, part), under, load, ("load",))


def pairs_at(prepared: Prepared, space: Space, model: Model) -> Interface:
    """The pairs of a model where its nodes are, under the supports that it always has.

    Parameters
    ----------
    prepared : the model as it is, whose first tangents go on
    space, model : of the bodies and their contacts
    """
    found = (sector_interface if model.cyclic_symmetries else make_interface)(space, model, prepared.always)
    return without_jumps(found, prepared.interface)


def multiplier(prepared: Prepared, name: str) -> float:
    """What a prepared model multiplies a load of its model by; temperatures are so in the model already."""
    hot = any(load.label == name and load.temperature is not None for load in prepared.model.loads)
    return 1.0 if hot else prepared.multiplied.get(name, 1.0)


def moved_side(prepared: Prepared, motion: Array, part: float) -> BodySide:
    """Bodies whose nodes a part of a motion (nodes, d) takes elsewhere before anything is loaded.

    What stands for the size of the model in unknowns of obstacles stays as it is.

    Parameters
    ----------
    prepared : the model as it is
    motion, part : of the nodes, length, and how much of it

    Raises
    ------
    InputError
        Where supports or rigid bodies would hold the moved nodes otherwise.
    """
    space, model = prepared.space, prepared.model
    side = BodySide(prepared=prepared, model=model, space=_at(space, motion, part), motion=motion, part=part)
    if places_matter(model):
        here, there = (make_constraints(where, model) for where in (space, side.space))
        changed = abs(here.transform - there.transform).max() if here.transform.nnz else 0.0
        if changed > 0.0 or any((there.prescribed[name] != u).any() for name, u in here.prescribed.items()):
            words = "moves nodes that supports or rigid bodies hold by where they are; derivatives do not know that"
            raise InputError(words, where=("motion",))
    return side


def places_matter(model: Model) -> bool:
    """Whether what holds a node depends on where it is."""
    varying = any(not isinstance(part, float | int | None) for support in model.supports for part in support.u)
    return bool(model.couples or varying)
