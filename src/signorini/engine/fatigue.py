# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue along a history: from what is asked for to parameters, planes and lives at places of the bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial

from signorini.arrays import replaced
from signorini.engine.fatigue_judged import RubbedPairs, judged
from signorini.engine.fatigue_on_ranks import PlacesOnRanks, places_on_ranks
from signorini.engine.fatigue_places import PairPlaces, request_places
from signorini.engine.stress_history import is_exact, spans, stress_history
from signorini.errors import InputError
from signorini.fatigue.criteria import Ruiz
from signorini.fem.space import Space
from signorini.fem.stress import space_of
from signorini.model.fatigue import Fatigue
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History


def with_fatigue(history: History, seen: Sequence[PlacesOnRanks] = ()) -> History:
    """A history with what the criteria say that its model asks for; a note where one cannot be answered.

    Parameters
    ----------
    history : solved
    seen : of every criterion what ranks have seen on the way; empty where there are none
    """
    model = history.model
    space = cache(partial(space_of, model))
    found, notes = [], []
    for i, request in enumerate(model.fatigue):
        try:
            found.append(assess_fatigue(history, request, space, seen[i] if seen else None))
        except InputError as error:  # what was solved is worth more than what is not known of it
            notes.append(str(error.inside("fatigue", i)))
    last = replaced(history.last, notes=(*history.last.notes, *notes))
    return replaced(history, steps=(*history.steps[:-1], last), fatigue_results=tuple(found))


def assess_fatigue(
    history: History, request: Fatigue, space: Callable[[], Space], seen: PlacesOnRanks | None = None
) -> FatigueResult:
    """What a criterion says along steps of a history.

    Parameters
    ----------
    history : solved
    request : the criterion, where and over which steps
    space : gives that of its mesh
    seen : what ranks have seen of it on the way

    Raises
    ------
    InputError
        For unknown names, and where displacements on the way were not kept and do not follow from what was.
    """
    steps, pairs = tuple(request.steps), [PairPlaces.of_result(contact) for contact in history.last.contacts]
    looked_at = spans(history, steps)
    rubbing = RubbedPairs.of(history, request) if isinstance(request.criterion, Ruiz) else None
    ranks = seen or places_on_ranks(history, request, pairs)
    if ranks is not None:
        moments, found = ranks.judged(history, looked_at, rubbing)
    else:
        places = request_places(space(), history.model, request, pairs)
        along = stress_history(history, places.probe, places.points, steps=steps)
        moments, found = len(along.load_factor), judged(request, places, along.stress, along.strain, rubbing)
    return FatigueResult(
        request=request,
        steps=tuple(span.step.name for span in looked_at),
        moments=moments,
        exact=is_exact(history.model, looked_at),
        **found,
    )
