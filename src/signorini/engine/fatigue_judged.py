# SPDX-License-Identifier: BSD-3-Clause
"""What a fatigue criterion says of the stresses at places, whoever has found them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray, frozen
from signorini.engine.fatigue_places import RequestPlaces, moduli
from signorini.engine.stress_history import Span, spans
from signorini.fatigue.criteria import StrainLife
from signorini.fatigue.damage import Damage, cycles_to_failure, damage, largest_product, path_amplitudes
from signorini.model.fatigue import Fatigue
from signorini.model.model import Model
from signorini.solution.history import History
from signorini.solution.results import ContactResult


@dataclass(frozen=True, kw_only=True, eq=False)
class RubbedPairs:
    """Friction and slip of n pairs at t moments, of which Ruiz's parameters are made.

    Attributes
    ----------
    friction, slip : (n, t, d - 1) along their tangents, force per area and length
    tangents : (n, d), or in space (n, 2, 3)
    """

    friction: Array
    slip: Array
    tangents: Array

    @classmethod
    def of(cls, history: History, request: Fatigue) -> RubbedPairs:
        """Of the contacts that a request names.

        Parameters
        ----------
        history, request : solved, and what is asked
        """
        frictions, slips = [], []
        for span in spans(history, tuple(request.steps)):
            for contacts in _contacts_of(span):
                asked = _asked(contacts or span.step.contacts, request)
                moved = 0.0 if contacts is None else 1.0
                frictions.append(moved * np.concatenate([_rows(contact.traction) for contact in asked]))
                slips.append(moved * np.concatenate([_rows(contact.slip) for contact in asked]))
        friction, slip = (np.stack(parts, axis=1) for parts in (frictions, slips))
        last = _asked(history.last.contacts, request)
        return cls(friction=friction, slip=slip, tangents=np.concatenate([contact.tangents for contact in last]))

    def among(self, pairs: IntArray) -> RubbedPairs:
        """Of some of the pairs."""
        return replace(self, friction=self.friction[pairs], slip=self.slip[pairs], tangents=self.tangents[pairs])


def judged(
    request: Fatigue, places: RequestPlaces, stress: Array, strain: Array, rubbing: RubbedPairs | None
) -> dict[str, NDArray[Any]]:
    """What a criterion says at places: arrays of a `FatigueResult`, by name.

    Parameters
    ----------
    request, places : what is asked, and where
    stress, strain : (p, t, 6) there, see `StressHistory`
    rubbing : of the p pairs that are asked of Ruiz's criterion; None of any other
    """
    model, body = places.probe.model, places.probe.body
    found = damage(request.criterion, stress, strain) if rubbing is None else _ruiz(rubbing, stress)
    return {
        "body": np.array([model.bodies[i].name for i in body]),
        "node": frozen(places.node, np.int64),
        "points": frozen(places.points),
        "parameter": frozen(found.parameter),
        "amplitude": frozen(found.amplitude),
        "stress": frozen(found.stress),
        "plane": frozen(found.plane),
        "life": frozen(_lives(model, request, found.parameter, body)),
    }


def _ruiz(rubbing: RubbedPairs, stress: Array) -> Damage:
    """F1 and F2 on the nonmortar sides of contacts."""
    friction, along = rubbing.friction, _along_surface(stress, rubbing.tangents)
    size = friction[..., 0] if friction.shape[-1] == 1 else np.linalg.norm(friction, axis=2)
    reach = path_amplitudes(rubbing.slip)
    return Damage(
        parameter=reach * largest_product(size, along),
        amplitude=reach * np.abs(size).max(axis=1),
        stress=along.max(axis=1),
        plane=np.full((len(reach), 3), np.nan),
    )


def _asked(contacts: Sequence[ContactResult], request: Fatigue) -> list[ContactResult]:
    """Contacts that a request is about."""
    return [contact for contact in contacts if request.asks(contact.name)]


def _contacts_of(span: Span) -> list[tuple[ContactResult, ...] | None]:
    """The contacts at every moment of a step, its beginning among them; None of bodies at rest."""
    rest: list[tuple[ContactResult, ...] | None] = [None] if span.at_rest else []
    before = [] if span.before is None else [span.before.contacts]
    return [*rest, *before, *(moment.contacts for moment in span.moments)]


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
