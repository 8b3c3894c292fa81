# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue along a history: from what is asked for to parameters, planes and lives at places of the bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.engine.places_of_names import named_places
from signorini.engine.stress_history import Span, spans, stress_history
from signorini.errors import InputError
from signorini.fatigue.criteria import SWT, Ruiz, StrainLife
from signorini.fatigue.damage import Damage, cycles_to_failure, damage, path_amplitudes
from signorini.fem.probe import StressProbe
from signorini.fem.space import Space, make_space
from signorini.model.fatigue import Fatigue
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History
from signorini.solution.results import ContactResult
from signorini.solution.stress_history import StressHistory

_LINE_POINTS = 16  # of a mean over a line: stresses are piecewise smooth over the cells that it crosses


def asked_fatigue(history: History) -> tuple[FatigueResult, ...]:
    """What the criteria say that a model asks for.

    Raises
    ------
    InputError
        As `assess_fatigue`, with the number of the criterion.
    """
    model = history.model
    space = make_space(model.mesh, axisymmetric=model.axisymmetric)
    found = []
    for i, request in enumerate(model.fatigue):
        try:
            found.append(assess_fatigue(history, request, space))
        except InputError as error:
            raise error.inside("fatigue", i) from error
    return tuple(found)


def assess_fatigue(history: History, request: Fatigue, space: Space | None = None) -> FatigueResult:
    """What a criterion says along steps of a history.

    Parameters
    ----------
    history : solved
    request : the criterion, where and over which steps
    space : of its mesh, where it is known

    Raises
    ------
    InputError
        For unknown names, and where displacements on the way were not kept and do not follow from what was.
    """
    model = history.model
    space = space or make_space(model.mesh, axisymmetric=model.axisymmetric)
    steps = tuple(request.steps)
    if isinstance(request.criterion, Ruiz):
        probe, points, tangents = _on_contacts(space, model, request, history)
        along = stress_history(history, probe, points, steps=steps)
        found = _ruiz(history, request, along, tangents)
    else:
        places = named_places(space, model, request.where)
        points = model.mesh.points[places.nodes[:, 1]]
        probe = StressProbe.at_nodes(space, model, places.nodes)
        if request.distance:
            probe = _below(space, model, points, places.inward, probe.body, request)
        along = stress_history(history, probe, points, steps=steps)
        found = damage(request.criterion, along.stress, along.strain)
    looked_at = spans(history, steps)
    return FatigueResult(
        request=request,
        steps=tuple(span.step.name for span in looked_at),
        moments=len(along.load_factor),
        exact=along.exact,
        body=np.array(along.bodies),
        node=frozen(along.node if not request.distance else places.nodes[:, 1], np.int64),
        points=frozen(points),
        parameter=frozen(found.parameter),
        amplitude=frozen(found.amplitude),
        stress=frozen(found.stress),
        plane=frozen(found.plane),
        life=frozen(_lives(model, request, found.parameter, probe.body)),
    )


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
        nodes = named_places(space, model, where).nodes
        return StressProbe.at_nodes(space, model, nodes), model.mesh.points[nodes[:, 1]]
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


def _on_contacts(
    space: Space, model: Model, request: Fatigue, history: History
) -> tuple[StressProbe, Array, list[Array]]:
    """Nodes of the pairs of contacts, where they are, and their tangents, (n, d) or in space (n, 2, 3) of each."""
    contacts = _asked(history.last.contacts, request)
    nodes = []
    for contact in contacts:
        side = named_places(space, model, [contact.nonmortar]).nodes
        own = side[np.isin(side[:, 1], contact.node)]
        order = np.argsort(own[:, 1], kind="stable")
        nodes.append(own[order[np.searchsorted(own[order, 1], contact.node)]])
    every = np.concatenate(nodes)
    return StressProbe.at_nodes(space, model, every), model.mesh.points[every[:, 1]], [c.tangents for c in contacts]


def _asked(contacts: Sequence[ContactResult], request: Fatigue) -> list[ContactResult]:
    """Contacts that a request names; all if it names none."""
    return [contact for contact in contacts if not request.where or contact.name in request.where]


def _ruiz(history: History, request: Fatigue, along: StressHistory, tangents: Sequence[Array]) -> Damage:
    """F1 and F2 on the nonmortar sides of contacts."""
    frictions, slips = [], []
    for span in spans(history, tuple(request.steps)):
        for contacts in _contacts_of(span):
            asked = _asked(contacts or span.step.contacts, request)
            moved = 0.0 if contacts is None else 1.0
            frictions.append(moved * np.concatenate([_rows(contact.traction) for contact in asked]))
            slips.append(moved * np.concatenate([_rows(contact.slip) for contact in asked]))
    friction = np.linalg.norm(np.stack(frictions, axis=1), axis=2).max(axis=1)
    work = friction * path_amplitudes(np.stack(slips, axis=1))
    stress = np.concatenate(
        [_along_surface(own, t) for own, t in zip(np.split(along.stress, _ends(tangents)), tangents, strict=True)]
    )
    plane = np.full((len(work), 3), np.nan)
    return Damage(parameter=work * np.maximum(stress, 0.0), amplitude=work, stress=stress, plane=plane)


def _contacts_of(span: Span) -> list[tuple[ContactResult, ...] | None]:
    """The contacts at every moment of a step, its beginning among them; None of bodies at rest."""
    rest: list[tuple[ContactResult, ...] | None] = [None] if span.at_rest else []
    before = [] if span.before is None else [span.before.contacts]
    return [*rest, *before, *(moment.contacts for moment in span.moments)]


def _ends(parts: Sequence[Array]) -> list[int]:
    """Where parts end that lie one after the other, but the last."""
    return np.cumsum([len(part) for part in parts])[:-1].tolist()


def _rows(values: Array) -> Array:
    """Values along tangents, (n, 1) or (n, 2)."""
    return values.reshape(len(values), -1)


def _along_surface(stress: Array, tangents: Array) -> Array:
    """(n,) The largest normal stress along tangents of a surface over the history."""
    d = tangents.shape[-1]
    tensors = stress[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]][..., :d, :d]
    axes = tangents.reshape(len(tangents), -1, d)
    within = np.einsum("nai,ntij,nbj->ntab", axes, tensors, axes)
    largest: Array = np.linalg.eigvalsh(within)[..., -1].max(axis=1)
    return largest


def _lives(model: Model, request: Fatigue, parameter: Array, body: IntArray) -> Array:
    """Lives in cycles; NaN where the criterion has no constants."""
    criterion = request.criterion
    if not isinstance(criterion, StrainLife) or not criterion.lives:
        return np.full(len(parameter), np.nan)
    moduli = np.zeros(len(model.bodies))
    for i in np.unique(body):
        material = model.bodies[i].material
        if not isinstance(material, Elastic):
            words = f"has constants of a life, and '{model.bodies[i].name}' is not isotropic; expected none"
            raise InputError(words, where=("criterion",))
        moduli[i] = material.E if isinstance(criterion, SWT) else material.shear_modulus
    return cycles_to_failure(criterion, parameter, moduli[body])
