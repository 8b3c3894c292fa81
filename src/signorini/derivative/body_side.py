# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and pairs at one side of a parameter: only what it may change is assembled, when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.fem.foundation import make_springs
from signorini.fem.kinematics import of_bodies, straining_groups
from signorini.fem.loads import nodal_loads
from signorini.fem.space import Space
from signorini.fem.stiffness import stiffness, stiffness_change
from signorini.fem.supports import make_constraints
from signorini.fem.thermal import thermal_forces
from signorini.interface.first_tangents import without_jumps
from signorini.interface.interface import Interface, make_interface
from signorini.interface.sectors import sector_interface
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class BodySide:
    """Bodies and pairs at one side of a parameter.

    Attributes
    ----------
    prepared : the model between both sides of the parameter
    model, space : what is on the mesh, and the mesh
    body : number of the body whose material the parameter is of; None where the parameter moves nodes
    """

    prepared: Prepared
    model: Model
    space: Space
    body: int | None = None

    def stiffness_change(self, other: BodySide) -> sp.csr_array:
        """(dofs, dofs) What the stiffness at the other side has beyond that at this one."""
        if self.body is None:
            low, high = self._stiffness, other._stiffness
            if np.array_equal(low.indptr, high.indptr) and np.array_equal(low.indices, high.indices):
                return sp.csr_array((high.data - low.data, low.indices, low.indptr), shape=low.shape)
            return sp.csr_array(high - low)
        own = of_bodies(straining_groups(self.space, self.model), np.arange(len(self.model.bodies)) == self.body)
        return stiffness_change(self.space, self.model, other.model, own)

    @property
    def _stiffness(self) -> sp.csr_array:
        """(dofs, dofs) Of all that a motion of nodes may change."""
        K = stiffness(self.space, self.model)
        for springs in make_springs(self.space, self.model).values() if self.model.foundations else ():
            K = sp.csr_array(K + springs.T @ springs)
        return K

    @cached_property
    def loads(self) -> Mapping[str, Array]:
        """(dofs,) At factor 1, by name, of loads that the parameter may change."""
        if self.body is None:
            return nodal_loads(self.space, self.model)
        name, found = self.model.bodies[self.body].name, {}
        for load in self.model.loads:
            if load.temperature is not None and load.on == name:
                found[load.label] = np.zeros(self.space.number_of_dofs)
                found[load.label][: self.space.dofs_of_nodes] = thermal_forces(self.space, self.model, load)
        return found

    @cached_property
    def interface(self) -> Interface:
        """The pairs."""
        return pairs_at(self.prepared, self.space, self.model)


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


def moved_side(prepared: Prepared, motion: Array) -> BodySide:
    """Bodies whose nodes a motion (nodes, d), length, takes elsewhere before anything is loaded.

    What stands for the size of the model in unknowns of obstacles stays as it is.

    Parameters
    ----------
    prepared : the model as it is
    motion : of the nodes

    Raises
    ------
    InputError
        Where supports or rigid bodies would hold the moved nodes otherwise.
    """
    space, model = prepared.space, prepared.model
    moved = space.at(space.mesh.points + motion, space.displacement)
    side = BodySide(prepared=prepared, model=model, space=moved)
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
