# SPDX-License-Identifier: BSD-3-Clause
"""The interface of bodies that have moved: contacts that slide far are paired anew where their sides are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.body_frames import BodyFrames
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.first_tangents import along_first
from signorini.interface.interface import Interface, make_interface
from signorini.model.model import Model


def sliding_unknowns(space: Space, model: Model, frames: BodyFrames, transform: sp.csr_array) -> IntArray:
    """Free displacements of the nodes, and obstacles, of both sides of contacts that slide far, ascending.

    Those that tell how their bodies turn are among them.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    frames : of those that turn
    transform : (dofs, z) what dofs are in terms of free displacements
    """
    dofs: list[IntArray] = [np.empty(0, np.int64)]
    for contact in (contact for contact in model.contacts if contact.slides):
        dofs += [space.dofs(model.mesh.nodes_of(side)).ravel() for side in contact.meshed_sides(model.mesh)]
        dofs += [space.obstacle_dofs(j) for j, rigid in enumerate(model.obstacles) if rigid.name == contact.mortar]
    dofs += [frame.reading.indices for frame in frames.frames]
    return np.unique(transform[np.concatenate(dofs)].indices)


def sliding_pairs(model: Model, interface: Interface) -> BoolArray:
    """(n,) The pairs of contacts that slide far."""
    slides = np.array([contact.slides for contact in model.contacts], np.bool_)
    return slides[interface.contact] if len(slides) else np.zeros(0, np.bool_)


def facing(interface: Interface) -> BoolArray:
    """(n,) Whether a pair has anything opposite it, or on its own side, that moves."""
    return np.asarray(np.diff(interface.B.indptr)[: len(interface)] > 0)


def paired_at(
    interface: Interface,
    space: Space,
    model: Model,
    constraints: Constraints,
    frames: BodyFrames,
    displacement: Array,
) -> Interface:
    """The interface with contacts that slide far as their sides are opposite each other now; the others as they are.

    Its gaps are those of the bodies where they are: ``gap(u) = gap + B (u - displacement)`` for these contacts.
    Contacts that stay are within one frame, or between bodies that do not turn: what they see is what it was.

    Parameters
    ----------
    interface : with the law of the moment; its pairs keep their number and order
    space, model : of the bodies before they move
    constraints : what supports hold: planes of symmetry
    frames : of bodies that turn
    displacement : (dofs,) of the bodies as their frames see them, length

    Raises
    ------
    InputError
        If sides have nothing opposite each other any more, with the contact's index.
    """
    contacts = [i for i, contact in enumerate(model.contacts) if contact.slides]
    own = sliding_pairs(model, interface)
    moved = space.moved(frames.displaced(displacement))
    found = make_interface(moved, model, constraints, contacts)
    if found.directions == 3:
        found = along_first(found, spun(interface, frames, displacement).tangents[own, 0])
    if frames:
        found = replace(found, B=_seen_from_frames(found, moved, frames, displacement))
    if interface.given.any():
        found = replace(found, gap=np.where(facing(found), found.gap - found.given + interface.given[own], found.gap))
    arrays = {}
    for name in ("gap", "area", "normals", "tangents"):
        arrays[name] = getattr(interface, name).copy()
        arrays[name][own] = getattr(found, name)
    rows = interface.rows(own)
    moments = interface.moments.copy()
    moments[rows] = found.moments
    order = np.argsort(np.concatenate([np.flatnonzero(~rows), np.flatnonzero(rows)]))
    B = found.B if own.all() else sp.csr_array(sp.vstack([interface.B[~rows], found.B])[order])
    return replace(interface, B=B, moments=moments, **arrays)


def _seen_from_frames(interface: Interface, moved: Space, frames: BodyFrames, displacement: Array) -> sp.csr_array:
    """B of displacements as frames see them, for rows of derivatives by the places of nodes.

    Both sides of a pair are where the nonmortar one is: across what is between them, a gap or what facets lie beside
    the surfaces that they stand for, the mortar body goes on as its frame turns. So a rotation of all bodies together
    moves no pair, and both forces of a pair have one line of action.

    Parameters
    ----------
    interface : rows by places
    moved : the bodies where they are
    frames, displacement : as of `paired_at`
    """
    across, contact = moved.spins(interface.B), np.tile(interface.contact, interface.directions)
    result = frames.tangent(interface.B, displacement)
    for i in np.unique(interface.contact):
        mortar = interface.sides[i].mortar
        if mortar in moved.mesh.boundaries:
            spin = frames.spin_of(moved.mesh.nodes_of(mortar), displacement)
            own = sp.diags_array((contact == i).astype(np.float64))
            result = result - sp.csr_array(own @ across) @ spin
    return sp.csr_array(result)


def spun(interface: Interface, frames: BodyFrames, to: Array, of: Array | None = None) -> Interface:
    """The interface with the directions of its pairs turned as the bodies of its nonmortar sides turn.

    Parameters
    ----------
    interface : as it is at one displacement
    frames : of bodies that turn
    to, of : (dofs,) the other displacement and the one; None: that of bodies that have not moved
    """
    if not frames:
        return interface
    turn = frames.turns(to)[interface.node]
    if of is not None:
        turn = turn @ frames.turns(of)[interface.node].swapaxes(1, 2)
    normals = np.einsum("kij,kj->ki", turn, interface.normals)
    return replace(interface, normals=normals, tangents=np.einsum("kij,kaj->kai", turn, interface.tangents))
