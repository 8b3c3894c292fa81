# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue along a history: from what is asked for to parameters, planes and lives at places of the bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.engine.fatigue_places import moduli, named_places, request_places
from signorini.engine.stress_history import Span, spans, stress_history
from signorini.errors import InputError
from signorini.fatigue.criteria import Ruiz, StrainLife
from signorini.fatigue.damage import Damage, cycles_to_failure, damage, largest_product, path_amplitudes
from signorini.fem.probe import StressProbe
from signorini.fem.space import Space
from signorini.fem.stress import space_of
from signorini.model.fatigue import Fatigue
from signorini.model.model import Model
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History
from signorini.solution.results import ContactResult
from signorini.solution.stress_history import StressHistory


def with_fatigue(history: History) -> History:
    """A history with what the criteria say that its model asks for; a note where one cannot be answered."""
    model = history.model
    space = space_of(model)
    found, notes = [], []
    for i, request in enumerate(model.fatigue):
        try:
            found.append(assess_fatigue(history, request, space))
        except InputError as error:  # what was solved is worth more than what is not known of it
            notes.append(str(error.inside("fatigue", i)))
    last = replace(history.last, notes=(*history.last.notes, *notes))
    return replace(history, steps=(*history.steps[:-1], last), fatigue_results=tuple(found))


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
    space = space or space_of(model)
    steps = tuple(request.steps)
    if isinstance(request.criterion, Ruiz):
        probe, points, tangents = _on_contacts(space, model, request, history)
        along = stress_history(history, probe, points, steps=steps)
        node = along.node
        found = _ruiz(history, request, along, tangents)
    else:
        places = request_places(space, model, request)
        probe, points, node = places.probe, places.points, places.node
        along = stress_history(history, probe, points, steps=steps)
        found = damage(request.criterion, along.stress, along.strain)
    looked_at = spans(history, steps)
    return FatigueResult(
        request=request,
        steps=tuple(span.step.name for span in looked_at),
        moments=len(along.load_factor),
        exact=along.exact,
        body=np.array(along.bodies),
        node=frozen(node, np.int64),
        points=frozen(points),
        parameter=frozen(found.parameter),
        amplitude=frozen(found.amplitude),
        stress=frozen(found.stress),
        plane=frozen(found.plane),
        life=frozen(_lives(model, request, found.parameter, probe.body)),
    )


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
    friction, slip = (np.stack(parts, axis=1) for parts in (frictions, slips))
    size = friction[..., 0] if friction.shape[-1] == 1 else np.linalg.norm(friction, axis=2)
    stress = np.concatenate(
        [_along_surface(own, t) for own, t in zip(np.split(along.stress, _ends(tangents)), tangents, strict=True)]
    )
    reach = path_amplitudes(slip)
    return Damage(
        parameter=reach * largest_product(size, stress),
        amplitude=reach * np.abs(size).max(axis=1),
        stress=stress.max(axis=1),
        plane=np.full((len(reach), 3), np.nan),
    )


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
    """(n, m) The largest normal stress along tangents of a surface at every moment."""
    d = tangents.shape[-1]
    tensors = stress[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]][..., :d, :d]
    axes = tangents.reshape(len(tangents), -1, d)
    within = np.einsum("nai,ntij,nbj->ntab", axes, tensors, axes)
    largest: Array = np.linalg.eigvalsh(within)[..., -1]
    return largest


def _lives(model: Model, request: Fatigue, parameter: Array, body: IntArray) -> Array:
    """Lives in cycles; NaN where the criterion has no constants."""
    criterion = request.criterion
    if not isinstance(criterion, StrainLife) or not criterion.lives:
        return np.full(len(parameter), np.nan)
    return cycles_to_failure(criterion, parameter, moduli(model, criterion, body))
