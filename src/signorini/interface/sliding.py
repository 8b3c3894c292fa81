# SPDX-License-Identifier: BSD-3-Clause
"""The interface of bodies that have moved: contacts that slide far are paired anew where their sides are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface, make_interface
from signorini.model.model import Model


def slides(model: Model) -> bool:
    """Whether the sides of some contact slide far."""
    return any(contact.slides for contact in model.contacts)


def sliding_unknowns(space: Space, model: Model, transform: sp.csr_array) -> IntArray:
    """Free displacements of the nodes, and obstacles, of both sides of contacts that slide far, ascending.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    transform : (dofs, z) what dofs are in terms of free displacements
    """
    dofs: list[IntArray] = [np.empty(0, np.int64)]
    for contact in (contact for contact in model.contacts if contact.slides):
        for side in (contact.nonmortar, contact.mortar):
            if side in model.mesh.boundaries:
                dofs.append(space.dofs(model.mesh.nodes_of(str(side))).ravel())
        dofs += [space.obstacle_dofs(j) for j, rigid in enumerate(model.obstacles) if rigid.name == contact.mortar]
    return np.unique(transform[np.concatenate(dofs)].indices)


def sliding_pairs(model: Model, interface: Interface) -> BoolArray:
    """(n,) The pairs of contacts that slide far."""
    slides = np.array([contact.slides for contact in model.contacts], np.bool_)
    return slides[interface.contact] if len(slides) else np.zeros(0, np.bool_)


def facing(interface: Interface) -> BoolArray:
    """(n,) Whether a pair has anything opposite it, or on its own side, that moves."""
    return np.asarray(np.diff(interface.B.indptr)[: len(interface)] > 0)


def paired_at(
    interface: Interface, space: Space, model: Model, constraints: Constraints, displacement: Array
) -> Interface:
    """The interface with contacts that slide far as their sides are opposite each other now; the others as they are.

    Its gaps are those of the bodies where they are: ``gap(u) = gap + B (u - displacement)`` for these contacts.

    Parameters
    ----------
    interface : with the law of the moment; its pairs keep their number and order
    space, model : of the bodies before they move
    constraints : what supports hold: planes of symmetry
    displacement : (dofs,) of the bodies, length

    Raises
    ------
    InputError
        If sides have nothing opposite each other any more, with the contact's index.
    """
    contacts = [i for i, contact in enumerate(model.contacts) if contact.slides]
    own = sliding_pairs(model, interface)
    found = make_interface(space.moved(displacement), model, constraints, contacts)
    if found.directions == 3:
        found = _along(found, interface.tangents[own, 0])
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


def _along(interface: Interface, first: Array) -> Interface:
    """The interface with its first tangents along given directions (n, 3), which a choice by axes would let jump."""
    normals, old, n = interface.normals, interface.tangents, len(interface)
    one = first - np.einsum("ki,ki->k", first, normals)[:, None] * normals
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    axes = np.stack([one, np.cross(normals, one)], axis=1)
    share = np.einsum("kai,kbi->abk", axes, old)
    turn = sp.block_array(
        [
            [sp.eye_array(n), None, None],
            [None, sp.diags_array(share[0, 0]), sp.diags_array(share[0, 1])],
            [None, sp.diags_array(share[1, 0]), sp.diags_array(share[1, 1])],
        ],
        format="csr",
    )
    return replace(interface, B=sp.csr_array(turn @ interface.B), moments=turn @ interface.moments, tangents=axes)
