# SPDX-License-Identifier: BSD-3-Clause
"""Where fatigue is asked for: contacts, boundaries, node sets, bodies and points, and what lies below them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, one_of
from signorini.fatigue.criteria import SWT, Ruiz, StrainLife
from signorini.fem.boundary import boundary
from signorini.fem.probe import StressProbe
from signorini.fem.space import Space
from signorini.interface.interface import Interface
from signorini.model.fatigue import Fatigue
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.solution.results import ContactResult

_LINE_POINTS = 16  # of a mean over a line: stresses are piecewise smooth over the cells that it crosses


@dataclass(frozen=True, kw_only=True, eq=False)
class NamedPlaces:
    """Nodes of bodies.

    Attributes
    ----------
    nodes : (p, 2) body and node of the mesh
    inward : (p, d) unit normals into the body; NaN where a name is no boundary
    """

    nodes: IntArray
    inward: Array


def named_places(space: Space, model: Model, names: Sequence[str]) -> NamedPlaces:
    """Nodes of contacts (both of their sides), boundaries, node sets and bodies, each once.

    Parameters
    ----------
    space, model : of the bodies
    names : all contacts if there is none

    Raises
    ------
    InputError
        For an unknown name, or if nothing is named and there is no contact.
    """
    if not names and not model.contacts:
        raise InputError("there is no contact; expected a boundary, a node set or a body", where=("where",))
    found = [part for name in names or [c.label for c in model.contacts] for part in _of_name(space, model, name)]
    nodes, inward = np.concatenate([part[0] for part in found]), np.concatenate([part[1] for part in found])
    first = np.sort(np.unique(nodes, axis=0, return_index=True)[1])
    return NamedPlaces(nodes=nodes[first], inward=inward[first])


def _of_name(space: Space, model: Model, name: str) -> Iterator[tuple[IntArray, Array]]:
    """Bodies and nodes (p, 2), and the inward normals (p, d), of what has a name."""
    mesh, owner = model.mesh, model.body_of_cells()
    for contact in model.contacts:
        if contact.label == name:
            sides = [side for side in (contact.nonmortar, contact.mortar) if isinstance(side, str)]
            for side in sides:
                if side in mesh.boundaries and not mesh.bounds_nothing(side):
                    yield from _of_boundary(space, owner, side)
            return
    if name in mesh.boundaries and not mesh.bounds_nothing(name):
        yield from _of_boundary(space, owner, name)
        return
    bodies = [body.name for body in model.bodies]
    if name not in bodies and name not in mesh.nodes:
        known = [*(contact.label for contact in model.contacts), *mesh.boundaries, *mesh.nodes, *bodies]
        raise InputError(one_of(name, known, "contact, boundary, node set or body"), where=("where",))
    asked = np.zeros(len(mesh.points), bool)
    asked[slice(None) if name in bodies else mesh.nodes_of(name)] = True
    for i, body in enumerate(bodies):
        if name not in bodies or name == body:
            own = np.zeros(len(mesh.points), bool)
            for block in space.blocks:
                own[block.cells[owner[block.first : block.first + len(block.cells)] == i]] = True
            nodes = np.flatnonzero(own & asked)
            yield np.column_stack([np.full(len(nodes), i), nodes]), np.full((len(nodes), space.dimension), np.nan)


def _of_boundary(space: Space, owner: IntArray, name: str) -> Iterator[tuple[IntArray, Array]]:
    """Bodies and nodes of a boundary, and the inward normals there."""
    side = boundary(space, name, ("where",))
    for block in side.blocks:
        pairs = np.column_stack([np.repeat(owner[block.cells], block.facets.shape[1]), block.facets.ravel()])
        pairs = np.unique(pairs, axis=0)
        yield pairs, -side.nodal_normals[np.searchsorted(side.nodes, pairs[:, 1])]


@dataclass(frozen=True, kw_only=True, eq=False)
class RequestPlaces:
    """Places that a request is about.

    Attributes
    ----------
    probe : their stresses, or those at the critical distance below them
    node : (p,) of the mesh
    points : (p, d) where they are, length
    """

    probe: StressProbe
    node: IntArray
    points: Array


class PairPlaces(NamedTuple):
    """Where the pairs of a contact are.

    Attributes
    ----------
    contact, nonmortar : names of the contact, and of the side that they belong to
    node : (n,) of the mesh
    """

    contact: str
    nonmortar: str
    node: IntArray

    @classmethod
    def of_result(cls, contact: ContactResult) -> PairPlaces:
        """Of a contact that was solved."""
        return cls(contact.name, contact.nonmortar, contact.node)

    @classmethod
    def of_model(cls, interface: Interface, model: Model) -> list[PairPlaces]:
        """Of all contacts of a model, before they are solved.

        Parameters
        ----------
        interface, model : the pairs, and whose they are
        """
        sides = enumerate(zip(model.contacts, interface.sides, strict=True))
        return [cls(law.label, side.nonmortar, interface.node[interface.contact == i]) for i, (law, side) in sides]


def request_places(
    space: Space, model: Model, request: Fatigue, pairs: Sequence[PairPlaces] | None = None
) -> RequestPlaces:
    """Places that a request is about.

    Parameters
    ----------
    space, model : of the bodies
    request : with names that the model has
    pairs : of all contacts, which Ruiz's criterion asks of

    Raises
    ------
    InputError
        Where a critical distance leaves a body, or there is no normal that it goes along.
    """
    if isinstance(request.criterion, Ruiz):
        assert pairs is not None
        nodes = _of_pairs(space, model, [own for own in pairs if request.asks(own.contact)])
        probe, node = StressProbe.at_nodes(space, model, nodes), nodes[:, 1]
        return RequestPlaces(probe=probe, node=node, points=model.mesh.points[node])
    places = named_places(space, model, request.where)
    node = places.nodes[:, 1]
    points = model.mesh.points[node]
    if request.distance:
        probe = _below(space, model, points, places.inward, places.nodes[:, 0], request)
    else:
        probe = StressProbe.at_nodes(space, model, places.nodes)
    return RequestPlaces(probe=probe, node=node, points=points)


def _of_pairs(space: Space, model: Model, pairs: Sequence[PairPlaces]) -> IntArray:
    """(p, 2) Bodies and nodes of pairs."""
    nodes = []
    for _, nonmortar, node in pairs:
        side = named_places(space, model, [nonmortar]).nodes
        own = side[np.isin(side[:, 1], node)]
        order = np.argsort(own[:, 1], kind="stable")
        nodes.append(own[order[np.searchsorted(own[order, 1], node)]])
    return np.concatenate(nodes)


def probe_of(
    space: Space, model: Model, where: Sequence[str], points: Array | None, body: int
) -> tuple[StressProbe, Array]:
    """Places by names, or points of one body; and where they are, (p, d).

    Parameters
    ----------
    space, model : of the bodies
    where : see `named_places`
    points : (p, d) undeformed coordinates, length, instead of names
    body : index of the body that they are in
    """
    if points is None:
        places = named_places(space, model, where)
        nodes, given = places.nodes, model.mesh.points[places.nodes[:, 1]]
        if not np.isnan(places.inward).any():
            with suppress(InputError):  # at the end of a side that leans over the normal there leaves the body
                return StressProbe.on_surface(space, model, nodes, places.inward), given
        return StressProbe.at_nodes(space, model, nodes), given
    return StressProbe.at_points(space, model, points[:, None], np.full(len(points), body)), points


def _below(space: Space, model: Model, points: Array, inward: Array, body: IntArray, request: Fatigue) -> StressProbe:
    """Places at the critical distance below others."""
    if np.isnan(inward).any():
        raise InputError("goes along normals; expected boundaries and contacts in 'where'", where=("distance",))
    L = request.distance
    depths = [0.5 * L] if request.average == "point" else 2.0 * L * (np.arange(_LINE_POINTS) + 0.5) / _LINE_POINTS
    lines = points[:, None] + np.asarray(depths)[:, None] * inward[:, None]
    try:
        return StressProbe.at_points(space, model, lines, body)
    except InputError as error:
        raise InputError(f"leaves the body: {error.message}; expected a shorter one", where=("distance",)) from error


def moduli(model: Model, criterion: StrainLife, body: IntArray) -> Array:
    """(p,) Moduli that the life of a criterion refers to, force per area.

    Parameters
    ----------
    model : the bodies
    criterion : with the constants of a life
    body : (p,) index of the body of every place

    Raises
    ------
    InputError
        If one of them is not isotropic.
    """
    found = np.zeros(len(model.bodies))
    for i in np.unique(body):
        material = model.bodies[i].material
        if not isinstance(material, Elastic):
            words = f"has constants of a life, and '{model.bodies[i].name}' is not isotropic; expected none"
            raise InputError(words, where=("criterion",))
        found[i] = material.E if isinstance(criterion, SWT) else material.shear_modulus
    return found[body]


def refuse_requests(space: Space, model: Model) -> None:
    """Refuse criteria before anything is solved that could not be answered afterwards.

    Parameters
    ----------
    space, model : of the bodies

    Raises
    ------
    InputError
        With the number of the criterion, and what it lacks.
    """
    for i, request in enumerate(model.fatigue):
        try:
            asked = [step for step in model.steps if step.name in request.steps] or [model.steps[-1]]
            if any(step.at != "events" for step in asked):
                refuse_unrecoverable(model)
            if not isinstance(request.criterion, Ruiz):
                body = request_places(space, model, request).probe.body
                if isinstance(request.criterion, StrainLife) and request.criterion.lives:
                    moduli(model, request.criterion, body)
        except InputError as error:
            raise error.inside("fatigue", i) from error


def refuse_unrecoverable(model: Model) -> None:
    """Refuse models whose displacements depend on more than loads and forces of the contacts.

    Raises
    ------
    InputError
        With what they depend on.
    """
    changes = any(step.release or step.hold or step.restore for step in model.steps)
    why = {
        "plastic flow": model.yields,
        "pairs that follow the bodies": model.slides,
        "bolts": bool(model.bolts),
        "supports that let go or hold again": changes,
    }
    for words, has in why.items():
        if has:
            raise InputError(
                f'displacements on the way depend on {words}; expected at = "events" in the step, which keeps them',
                where=("steps",),
            )
