# SPDX-License-Identifier: BSD-3-Clause
"""Bodies as they vibrate about a state: stiffness and mass on the free displacements, and the pairs that touch."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, extent
from signorini.engine.bolts import with_bolts
from signorini.errors import InputError
from signorini.fem.links import linked_nodes
from signorini.fem.mass import mass_matrix
from signorini.fem.space import Space, make_space
from signorini.fem.stiffness import reduced_stiffness, stiffness
from signorini.fem.supports import Constraints, make_constraints
from signorini.interface.interface import Interface, make_interface, pairs_of
from signorini.interface.sectors import sector_interface
from signorini.law.states import OPEN
from signorini.model.model import Model
from signorini.model.modes import SLIPPING, STUCK
from signorini.solution.checkpoint import Checkpoint

_TOUCHING_GAP = 1e-9  # of the size of the mesh: smaller gaps of an unsolved model are closed
_SPRINGING_SHARE = 1.0 - 1e-9  # of a pressure: where lines of a closure meet, the one by which it springs back
_HELD_ROW = 1e-10  # of the largest row of B: smaller ones are rounding, supports hold such pairs


@dataclass(frozen=True, kw_only=True, eq=False)
class VibratingBodies:
    """A model about a state, on its z free displacements.

    Attributes
    ----------
    space, constraints : of the model, under the supports of the state
    K, M : (z, z) stiffness, with foundations, and mass
    mass : (dofs, dofs)
    B : (d n, z) relative displacements of the pairs
    tied, closed : (n,) pairs that are tied; others that touch
    compliance : (d, n) of the pairs as contacts state it, length per force
    stretch : omega^2 of the size that stretching the bodies has
    copies : 2 where displacements have a real and an imaginary part, one after the other; 1 otherwise
    """

    space: Space
    constraints: Constraints
    K: sp.csr_array
    M: sp.csr_array
    mass: sp.csr_array
    B: sp.csr_array
    tied: BoolArray
    closed: BoolArray
    compliance: Array
    stretch: float
    copies: int = 1

    def rows(self, joint: str) -> IntArray:
        """Rows of B that a joint holds: those of ties; of closed pairs all, those along the normal, or none."""
        kept = np.repeat(self.tied[None], len(self.compliance), axis=0)
        if joint in (STUCK, SLIPPING):
            kept[0] |= self.closed
        if joint == STUCK:
            kept[1:] |= self.closed
        size = np.sqrt(np.asarray(self.B.multiply(self.B).sum(axis=1)).ravel())
        seen = size > _HELD_ROW * size.max(initial=0.0)
        return np.flatnonzero(kept.ravel() & seen)


def vibrating_bodies(model: Model, end: Checkpoint | None = None, *, apart: bool = False) -> VibratingBodies:
    """A model at the end of a history, or as it was drawn.

    Parameters
    ----------
    model : the model
    end : of the history, whose supports hold and whose closed pairs touch; None: pairs without a gap touch
    apart : of sectors: without what holds their sides to each other

    Raises
    ------
    InputError
        For what no mode is computed of, by its place in the model.
    """
    model = with_bolts(model)
    _refuse(model)
    carriers = len(model.obstacles) + len(model.rigid_bodies)
    space = make_space(model.mesh, kind=model.kind, obstacles=carriers, linked=linked_nodes(model))
    standing = None if end is None else end.standing
    posed = replace(model, cyclic_symmetries=()) if apart else model
    constraints = make_constraints(space, posed, without=standing.released if standing else ())
    _refuse_massless(model, space, constraints)
    always = make_constraints(space, model, without=standing.loosened) if standing else constraints
    interface = (sector_interface if model.cyclic_symmetries else make_interface)(space, model, always)
    if end is not None:
        end.check(model, interface)
    K, mass, T = stiffness(space, model), mass_matrix(space, model), constraints.transform
    for springs in constraints.springs.values():
        K = sp.csr_array(K + springs.T @ springs)
    return VibratingBodies(
        space=space,
        constraints=constraints,
        K=reduced_stiffness(K, T),
        M=sp.csr_array(T.T @ mass @ T),
        mass=mass,
        B=sp.csr_array(interface.B @ T),
        tied=interface.tied,
        closed=_closed(model, interface, end),
        compliance=_compliance(model, interface, end),
        stretch=_stretch(space, K, mass),
    )


def _refuse(model: Model) -> None:
    """What no mode is computed of."""
    if any(contact.cohesion for contact in model.contacts):
        i = next(i for i, contact in enumerate(model.contacts) if contact.cohesion)
        raise InputError("is given; modes do not know bonds", where=("contact", i, "cohesion"))
    if model.slides:
        i = next(i for i, contact in enumerate(model.contacts) if contact.slides)
        raise InputError('is "finite"; modes know pairs that stay', where=("contact", i, "sliding"))


def _refuse_massless(model: Model, space: Space, constraints: Constraints) -> None:
    """A rigid obstacle that moves freely has no mass to vibrate with."""
    for j, obstacle in enumerate(model.obstacles):
        if (constraints.free[space.obstacle_dofs(j)] >= 0).any():
            words = f"'{obstacle.name}' has no mass and may move; modes need it driven in every direction"
            raise InputError(words, where=("obstacle", j))


def _closed(model: Model, interface: Interface, end: Checkpoint | None) -> BoolArray:
    """(n,) Pairs that touch and are not tied."""
    if end is None:
        touching = interface.gap <= _TOUCHING_GAP * float(np.max(extent(model.mesh.points)))
    else:
        off = pairs_of(model, interface, end.standing.inactive)
        touching = (end.state.status != OPEN) & ~off
    return np.asarray(touching & ~interface.tied)


def _compliance(model: Model, interface: Interface, end: Checkpoint | None) -> Array:
    """(d, n) As contacts state it, without what makes paths regular in corners that contacts share; at its pressure."""
    stated = np.array([(c.normal_compliance, c.tangential_compliance) for c in model.contacts], float).reshape(-1, 2)
    own = stated[interface.contact].T / interface.area
    closure = interface.closure
    if closure is not None:
        pressure = np.zeros(len(interface)) if end is None else end.state.forces[0] / interface.area
        now = closure if end is None else closure.after(end.state.borne)
        line = now.line(_SPRINGING_SHARE * np.maximum(pressure, 0.0))
        own[0] = now.of_lines(line)[0] / interface.area
    own[:, interface.tied] = 0.0  # a tie has none
    return np.concatenate([own, *[own[1:]] * (interface.directions - 2)])


def _stretch(space: Space, K: sp.csr_array, mass: sp.csr_array) -> float:
    """The least Rayleigh quotient of uniform stretches along the axes, whatever supports hold."""
    found = []
    for axis in range(space.dimension):
        u = np.zeros((space.number_of_dofs,))
        at = space.mesh.points[:, axis]
        space.at_nodes(u)[:, axis] = np.where(space.used, at - at[space.used].mean(), 0.0)
        found.append(float(u @ (K @ u)) / float(u @ (mass @ u)))
    least = min(found)
    if not least > 0.0:
        raise InputError("nothing of the model is elastic; expected a body that is not rigid", where=("body",))
    return least
