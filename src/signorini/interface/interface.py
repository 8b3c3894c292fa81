# SPDX-License-Identifier: BSD-3-Clause
"""The contact interface of a model: one list of pairs for all contacts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.fem.rigid_motions import RigidMotions
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.frames import LEAST_SINE, along_tangents, tangents
from signorini.interface.hoop import with_hoop
from signorini.interface.pairing import Pairs, Sides, make_pairs
from signorini.interface.relative_rows import moments_of_rows, relative_rows
from signorini.law.bound import Bound
from signorini.law.closure import Borne, PairClosure
from signorini.law.cohesion import Bonds, PairCohesion, bonded
from signorini.law.friction import FrictionLaw, PairFriction
from signorini.law.section import FrictionSection
from signorini.model.model import Model
from signorini.sparse_rows import chosen_rows, transposed

_SHARED_COMPLIANCE = 1e-8  # of the size of the model over the softest modulus
_AXIS_TOL = 1e-6  # component of a unit vector


@dataclass(frozen=True, kw_only=True, eq=False)
class Interface:
    """Pairs that may touch: ``u_c = B u`` is the relative displacement, the gap is ``g + B_n u``.

    A pair is a nonmortar node and what lies opposite: a node, a weighted mean of nodes, or a rigid obstacle.

    The normal n points from the mortar side into the nonmortar body, the tangent is ``t = (n_y, -n_x)``; in space there
    are two, ``t1 x t2 = n``, with twist the second one goes along the hoop. Forces of the interface on the bodies are
    ``B^T r``, r the normal (pressing > 0) and tangential forces on the nonmortar body.

    Attributes
    ----------
    B : (d n, dofs) sparse; n normal rows, then n rows of every tangent
    gap : (n,) initial gaps g, length, negative where the bodies overlap
    given : (n,) of it what is given, not of the geometry: nodes of the nonmortar side carry it along
    area : (n,) tributary area, see :class:`signorini.interface.coupling.Coupling`
    normals : (n, d) unit vectors
    tangents : (n, d - 1, d) unit vectors
    node : (n,) nodes on the nonmortar side
    moments : (d n, 1 or 3) moments about the origin of unit forces of every row of B on the nonmortar side, length
    contact : (n,) index of the contact that a pair belongs to
    friction : laws with their parameters, along the direction of the largest friction
    anisotropy : (n, d - 1) friction along every tangent over the largest
    facets : (n,) corners of the section of the friction cone, 0 for the exact one
    normal_compliance, tangential_compliance : (n,) length per pressure
    tied : (n,) whether the pair neither slips nor opens
    sides : how every contact was paired
    closure : of the pairs, by their lines; None where they have one compliance each. Where it is there the normal
        compliance of its pairs is the mean one up to the last point
    cohesion : the bonds of the pairs; None where no contact has any
    """

    B: sp.csr_array
    gap: Array
    given: Array
    area: Array
    normals: Array
    tangents: Array
    node: IntArray
    moments: Array
    contact: IntArray
    friction: PairFriction
    anisotropy: Array
    facets: IntArray
    normal_compliance: Array
    tangential_compliance: Array
    tied: BoolArray
    sides: tuple[Sides, ...]
    closure: PairClosure | None = None
    cohesion: PairCohesion | None = None

    def __len__(self) -> int:
        return len(self.gap)

    @property
    def directions(self) -> int:
        """Rows of B a pair, d."""
        return int(self.normals.shape[1])

    def rows(self, pairs: BoolArray) -> BoolArray:
        """(d n,) the rows of B that belong to some pairs (n,)."""
        return np.concatenate([pairs] * self.directions)

    def among(self, kept: BoolArray) -> Interface:
        """Some of the pairs (n,)."""
        parts: dict[str, Any] = {
            field.name: value[kept]
            for field in fields(self)
            if isinstance(value := getattr(self, field.name), np.ndarray) and len(value) == len(kept)
        }
        if self.closure is not None:
            parts["closure"] = self.closure.among(kept)
        if self.cohesion is not None:
            parts["cohesion"] = self.cohesion.among(kept)
        return replace(self, B=chosen_rows(self.B, self.rows(kept)), friction=self.friction.among(kept), **parts)

    def motion(self, displacement: Array) -> Array:
        """(d, n) Motions of the pairs, ``B u``, that displacements (dofs,) are, length."""
        if not isinstance(displacement, np.ndarray):  # it is on ranks, and only what pairs see is asked for
            seen, B = self._of_seen
            displacement = displacement[seen]
            return np.asarray(B @ displacement).reshape(self.directions, len(self))
        moved: Array = self.B @ displacement
        return moved.reshape(self.directions, len(self))

    def pushes(self, forces: Array) -> tuple[IntArray, Array]:
        """Dofs that pairs see (k,), each once, and the nodal forces of the forces (d, n) of the pairs there (k,)."""
        seen, B = self._of_seen
        return seen, B.T @ forces.ravel()

    @cached_property
    def _of_seen(self) -> tuple[IntArray, sp.csr_array]:
        """Dofs that pairs see (k,), ascending, and B (d n, k) of those alone."""
        seen, place = np.unique(self.B.indices, return_inverse=True)
        entries = self.B.data.copy(), place, self.B.indptr.copy()  # B may be sorted in its place later
        return seen, sp.csr_array(entries, shape=(self.B.shape[0], len(seen)))

    def on_bodies(self, forces: Array) -> Array:
        """(dofs,) Nodal forces ``B^T r`` of the forces (d, n) of the pairs on the bodies."""
        nodal: Array = self._transposed @ forces.ravel()
        return nodal

    @cached_property
    def _transposed(self) -> sp.csc_array:
        """B^T, asked for in every round of small models."""
        return transposed(self.B)

    def felt(self, rigid: RigidMotions) -> sp.csr_array:
        """(d n, k) What the pairs see of k rigid motions X, ``B X``; the last ones are not asked twice."""
        known = self.__dict__.get("_felt")
        if known is None or known[0] is not rigid:
            known = self.__dict__["_felt"] = rigid, sp.csr_array(self.B @ rigid.seen_by(self.B.indices))
        return known[1]

    @property
    def compliance(self) -> Array:
        """(d, n) of the pairs, length per force."""
        tangential = [self.tangential_compliance] * (self.directions - 1)
        return np.stack([self.normal_compliance, *tangential]) / self.area

    @property
    def remembers(self) -> bool:
        """Whether what lies between any sides does not spring back along its lines, so that the way there counts."""
        return self.closure is not None and self.closure.springs is not None

    def give(self, forces: Array, borne: Borne | None = None) -> Array:
        """(d, n) How far forces (d, n) move the sides of the pairs on what lies between them and has borne, length."""
        given = self.compliance * forces
        if self.closure is not None:
            given[0] = self.closure.after(borne).at(np.maximum(forces[0], 0.0) / self.area) + np.minimum(given[0], 0.0)
        return given

    def borne_after(self, before: Borne | None, forces: Array) -> Borne | None:
        """What closures remember after forces (d, n), too; None where they need no past."""
        if self.closure is None:
            return None
        return self.closure.borne(before, np.maximum(forces[0], 0.0) / self.area, self.area)

    def bonds_after(self, before: Bonds | None, gap: Array) -> Bonds | None:
        """What bonds remember after gaps (n,) of the contact law, too; None where there are none."""
        return None if self.cohesion is None or before is None else self.cohesion.after(before, gap)

    @property
    def bound(self) -> Bound:
        """Of the friction forces."""
        return self.friction.bound(self.area)

    def most(self, normal: Array) -> Array:
        """(n,) Largest friction forces under normal forces (n,); infinite where a pair sticks that is pressed."""
        return np.where(self.friction.sticks & (normal > 0), np.inf, self.bound.at(np.maximum(normal, 0.0)))

    @property
    def section(self) -> FrictionSection:
        """Of the friction cone of every pair, for a largest coefficient of 1."""
        return FrictionSection(axes=self.anisotropy.T, sides=self.facets)

    def effort(self, tangential: Array) -> Array:
        """(n,) size of tangential forces (d - 1, n) as friction feels it, see `law.section`."""
        return self.section.effort(tangential)


def make_interface(
    space: Space, model: Model, constraints: Constraints, contacts: Sequence[int] | None = None
) -> Interface:
    """Pair the surfaces of all contacts.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    constraints : what supports hold: planes of symmetry
    contacts : numbers of those to pair, ascending; None: all

    Raises
    ------
    InputError
        If surfaces do not face each other or their obstacle, or cannot be paired as asked, with the contact's index.
    """
    chosen = range(len(model.contacts)) if contacts is None else contacts
    parts = [make_pairs(space, model, constraints, i) for i in chosen]
    index = np.repeat(np.array(chosen, int), [len(part.gap) for part in parts]).astype(int)
    normals = _joined([part.coupling.normals for part in parts], (0, space.dimension))
    area = _joined([part.coupling.area for part in parts], (0,))
    node: IntArray = np.concatenate([np.empty(0, int), *(part.coupling.nodes for part in parts)])
    mirrored: BoolArray = np.concatenate([np.empty((0, space.dimension), bool), *(part.mirrored for part in parts)])

    def data(key: str) -> Array:
        return np.array([getattr(contact, key) for contact in model.contacts], float)[index]

    fibres = np.array([contact.friction_axis or (0.0,) * 3 for contact in model.contacts]).reshape(-1, 3)[index]
    axes, still = tangents(normals, mirrored, fibres)
    friction = PairFriction.of(
        [model.contacts[i].law for i in chosen], [space.mesh.points[part.coupling.nodes] for part in parts]
    )
    facets = np.array([contact.facets for contact in model.contacts], np.int64)[index]
    gap, closure = _joined([part.gap for part in parts], (0,)), _closure(model, chosen, parts)
    cohesion = None
    if any(model.contacts[i].cohesion for i in chosen):
        bonds = [contact.cohesion for contact in model.contacts]
        gap, cohesion = bonded(bonds, index, gap, area, float(space.mesh.extent.max()))
    B = relative_rows(space, model, parts, normals, axes, still)
    if model.twists:
        normals, axes = with_hoop(normals, axes)
        mirrored = np.pad(mirrored, ((0, 0), (0, 1)))
    _refuse_no_fibre(space, model, node, index, normals, mirrored)
    own = [part.own for part in parts]
    return Interface(
        B=B,
        gap=gap if closure is None else gap - closure.clearance,
        given=_joined([part.given for part in parts], (0,)),
        area=area,
        normals=normals,
        tangents=axes,
        node=node,
        moments=moments_of_rows(B, space, own, np.tile(np.searchsorted(chosen, index), space.components)),
        contact=index,
        friction=friction,
        anisotropy=_anisotropy(model, [contact.law for contact in model.contacts], axes, index),
        facets=np.where(friction.sticks, 0, facets),
        normal_compliance=data("mean_compliance"),
        tangential_compliance=np.maximum(
            data("tangential_compliance"), _of_shared_nodes(space, model, node, friction.rubs)
        ),
        tied=data("tied").astype(bool),
        sides=tuple(part.sides for part in parts),
        closure=closure,
        cohesion=cohesion,
    )


def _closure(model: Model, chosen: Sequence[int], parts: Sequence[Pairs]) -> PairClosure | None:
    """The closures of the pairs of contacts, by their numbers; None where none has any."""
    contacts = [model.contacts[i] for i in chosen]
    if all(contact.closure is None for contact in contacts):
        return None
    compliances = [contact.normal_compliance for contact in contacts]
    return PairClosure.of([contact.closure for contact in contacts], compliances, [len(part.gap) for part in parts])


def _joined(parts: Sequence[Array], none: tuple[int, ...]) -> Array:
    return np.concatenate(parts) if parts else np.empty(none)


def _refuse_no_fibre(
    space: Space, model: Model, node: IntArray, contact: IntArray, normals: Array, mirrored: BoolArray
) -> None:
    """A direction of friction has a part along every surface, and planes of symmetry see it as their mirror image."""
    for i, data in enumerate(model.contacts):
        if data.friction_axis is None:
            continue
        axis = np.array(data.friction_axis) / np.linalg.norm(data.friction_axis)
        own = contact == i
        off = np.linalg.norm(axis - (normals[own] @ axis)[:, None] * normals[own], axis=1)
        lost = np.flatnonzero(off < LEAST_SINE)
        if len(lost):
            number = space.mesh.labels[node[own][lost[0]]]
            raise InputError(
                f"runs along the normal of node {number}; expected a direction along the surface",
                where=("contact", i, "friction_axis"),
            )
        on = mirrored[own].any(axis=0)
        oblique = on & (np.abs(axis) > _AXIS_TOL) & (np.abs(axis) < 1.0 - _AXIS_TOL)
        if oblique.any():
            raise InputError(
                f"is oblique to the plane of symmetry across {model.axes[int(np.argmax(oblique))]}, which would see "
                "its mirror image; expected it in the plane or across it",
                where=("contact", i, "friction_axis"),
            )


def _of_shared_nodes(space: Space, model: Model, node: IntArray, rubs: BoolArray) -> Array:
    """Tangential compliance of pairs with friction at plane nodes that several contacts share, (n,), otherwise 0.

    In a corner the normal force of one contact and the friction of the other act along one line, and only their sum is
    determined, which no path of states can follow. With so little compliance that displacements do not feel it they
    share it in one way.
    """
    if space.dimension == 3 or not len(node):
        return np.zeros(len(node))
    shared = np.bincount(node)[node] > 1
    if not shared.any():
        return np.zeros(len(node))
    size = float(space.mesh.extent.max())
    softest = min(body.material.smallest_modulus for body in model.bodies)
    return np.where(shared & rubs, _SHARED_COMPLIANCE * size / softest, 0.0)


def _anisotropy(model: Model, laws: Sequence[FrictionLaw], axes: Array, contact: IntArray) -> Array:
    """(n, d - 1) Friction along every tangent, axes (n, d - 1, d), over the largest; laws of every contact."""
    found = np.ones(axes.shape[:2])
    for i, (data, law) in enumerate(zip(model.contacts, laws, strict=True)):
        if law.ratios != (1.0, 1.0):
            own = contact == i
            found[own] = along_tangents(law.ratios, data.friction_axis, axes[own])
    return found


def under_laws(interface: Interface, model: Model, laws: Sequence[FrictionLaw]) -> Interface:
    """The interface with other laws of friction.

    Parameters
    ----------
    interface, model : pairs and contacts
    laws : of every contact

    Raises
    ------
    InputError
        If a function that gives the friction gives something else, with the contact's index.
    """
    nodes = [interface.node[interface.contact == i] for i in range(len(laws))]
    return replace(
        interface,
        friction=PairFriction.of(laws, [model.mesh.points[own] for own in nodes]),
        anisotropy=_anisotropy(model, laws, interface.tangents, interface.contact),
    )


def pairs_of(model: Model, interface: Interface, labels: Collection[str]) -> BoolArray:
    """(n,) The pairs of some contacts.

    Parameters
    ----------
    model, interface : of the contacts and their pairs
    labels : of the contacts that are asked for
    """
    own = [i for i, contact in enumerate(model.contacts) if contact.label in labels]
    return np.asarray(np.isin(interface.contact, own), dtype=np.bool_)
