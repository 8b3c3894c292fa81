# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue of bodies on ranks: each finds the stresses at its own places through the history, and judges them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray, distinct, stored
from signorini.distributed.kept_rows import OwnRows, RowsKept, rows_of_all, rows_together
from signorini.distributed.mesh_rows import at_hand
from signorini.distributed.ranks import ON_RANKS, Team, ranks_with, several_ranks
from signorini.distributed.shares import PartsOfModel, StrainedPart
from signorini.engine.examine import on_ranks
from signorini.engine.fatigue_judged import RubbedPairs, judged
from signorini.engine.fatigue_places import PairPlaces, RequestPlaces, request_places
from signorini.engine.prepare import Prepared
from signorini.engine.recovery import Recovery
from signorini.engine.step_parts import FollowedPart, at_nodes
from signorini.engine.stress_history import InState, Span, in_state, moments_along, together
from signorini.fem.probe import StressProbe
from signorini.fem.stress import space_of
from signorini.model.fatigue import Fatigue
from signorini.model.model import Model
from signorini.model.stage import Stage
from signorini.solution.fatigue_result import PER_PLACE
from signorini.solution.history import History
from signorini.solution.results import Instant, StepResult

Key = tuple[int, int] | None
"""Of a moment: number of the step and of the state in it, both from 0 on; None of bodies at rest."""


class PlacesShare(NamedTuple):
    """Places of a rank, with the cells that their stresses depend on.

    Attributes
    ----------
    part : these
    own : (p,) numbers of the places among all, ascending
    around : (e, 2) bodies and nodes that they depend on, counted in the part
    weights : (p, e) of these
    of_body : (p,) the body of every place, counted in the part
    node : (p,) of the mesh
    at : (p, d) where they are, length
    """

    part: StrainedPart
    own: IntArray
    around: IntArray
    weights: sp.csr_array
    of_body: IntArray
    node: IntArray
    at: Array


class PlacesOnRanks:
    """Places of a criterion, whose stresses ranks find in one state after the other.

    Parameters
    ----------
    team : the ranks
    model, request : of the bodies, and what is asked
    pairs : of all contacts
    owner : (n,) rank of every node, which has the places there
    """

    def __init__(
        self, team: Team, model: Model, request: Fatigue, pairs: Sequence[PairPlaces], owner: IntArray
    ) -> None:
        self._team, self._number, self._found, self._request = team, team.kept(self), team.kept(self), request
        self._nodes: list[IntArray] = []
        self._own: list[IntArray] = []
        self._seen: set[tuple[int, int]] = set()
        with at_hand(model.mesh):
            places = request_places(space_of(model), model, request, pairs)
            team.everywhere(_hold, self._number, pieces=self._shares(model, places, owner))

    def _shares(self, model: Model, places: RequestPlaces, owner: IntArray) -> Iterator[PlacesShare | None]:
        parts, probe, rank_of = PartsOfModel(model), places.probe, owner[places.node]
        for rank in range(self._team.size):
            own = np.flatnonzero(rank_of == rank)
            self._own.append(own)
            if not len(own):
                self._nodes.append(own)
                yield None
                continue
            weights = probe.weights[own]
            seen = distinct(weights.indices)
            around, asked = probe.nodes[seen], parts.none()
            asked[around[:, 1]] = True
            part = parts.of(parts.around(asked))
            self._nodes.append(part.nodes)
            counted = [
                np.searchsorted(known, own) for known, own in zip((part.numbers, part.nodes), around.T, strict=True)
            ]
            yield PlacesShare(
                part=part,
                own=own,
                around=np.stack(counted, axis=1),
                weights=sp.csr_array(weights[:, seen]),
                of_body=np.searchsorted(part.numbers, probe.body[own]),
                node=places.node[own],
                at=places.points[own],
            )

    def take(self, prepared: Prepared, stage: Stage, first: int, followed: FollowedPart) -> None:
        """See stresses on the way, where the criterion asks of the step and its displacements will not be kept.

        Parameters
        ----------
        prepared, stage : the model, and the step
        first : number of the first state in the step
        followed : a part of it
        """
        last = stage.number == len(prepared.model.steps)
        if stage.step.at == "events" or not (stage.title in self._request.steps if self._request.steps else last):
            return
        for i, shot in enumerate(followed.snapshots, start=first):
            state, key = shot.bodies, (stage.number - 1, i)
            self._seen.discard(key)
            if state is not None:
                self._see(key, state.point.factors, at_nodes(prepared, state.nodal[0]))
                self._seen.add(key)

    def _see(self, key: Key, factors: Mapping[str, float], u: Any) -> None:
        """Have ranks find the stresses at their places under displacements (nodes, d), here or kept by them."""
        kept = isinstance(u, RowsKept)
        parts = (None if kept else u[nodes] for nodes in self._nodes)
        self._team.everywhere(_see, self._number, key, dict(factors), u.place if kept else None, pieces=parts)

    def judged(
        self, history: History, looked_at: Sequence[Span], rubbing: RubbedPairs | None
    ) -> tuple[int, dict[str, Any]]:
        """How many moments are looked at, and arrays of a `FatigueResult` by name, kept by ranks where they are large.

        Parameters
        ----------
        history, looked_at : solved, and which parts of its steps
        rubbing : of all pairs that are asked of Ruiz's criterion; None of any other
        """
        seen = {
            shot: (k, i)
            for k, step in enumerate(history.steps)
            for i, shot in enumerate(step.instants)
            if (k, i) in self._seen
        }
        keys: list[Key] = []
        for _, state, u in moments_along(looked_at, cache(partial(Recovery.of, history)), seen):
            keys.append(None if state is None else seen.get(state) or self._told(len(keys), state, u))  # type: ignore[arg-type]
        pieces = (None if rubbing is None else rubbing.among(own) for own in self._own)
        self._team.everywhere(_judge, self._number, self._found, self._request, keys, pieces=pieces)
        kinds = {"body": f"U{max(len(body.name) for body in history.model.bodies)}", "node": "int64"}
        widths, count = {"points": (history.model.dimension,), "plane": (3,)}, sum(map(len, self._own))
        return len(keys), {
            name: rows_together(
                self._team, self._found, name, (count, *widths.get(name, ())), np.dtype(kinds.get(name, "float64"))
            )
            for name in PER_PLACE
        }

    def _told(self, number: int, state: StepResult | Instant, u: Array | None) -> Key:
        """Have ranks know a state whose displacements were kept, or are given."""
        self._see((-1, number), state.factors, stored(state, "displacement") if u is None else u)
        return -1, number


def places_on_ranks(history: History, request: Fatigue, pairs: Sequence[PairPlaces]) -> PlacesOnRanks | None:
    """Places of a criterion on the ranks that have solved a history; None where one process has.

    Parameters
    ----------
    history, request : solved, and what is asked
    pairs : of all contacts
    """
    ranks = ranks_with(history.model.mesh) if history.backend in ON_RANKS else None
    return None if ranks is None else PlacesOnRanks(ranks[0], history.model, request, pairs, ranks[1])


def places_to_see(prepared: Prepared) -> list[PlacesOnRanks]:
    """Of every criterion the places that several ranks look at on the way; empty where one process recovers.

    Parameters
    ----------
    prepared : the model
    """
    team, model = several_ranks(), prepared.model
    if team is None or not on_ranks(prepared.K):
        return []
    pairs = PairPlaces.of_model(prepared.interface, model)
    return [PlacesOnRanks(team, model, request, pairs, prepared.K.owner) for request in model.fatigue]


@dataclass
class _OwnPlaces:
    """Places of a rank.

    Attributes
    ----------
    places, own : where they are, and (p,) their numbers among all
    nodes : (m,) of the part of the mesh around them
    states : what is known of them in states, by key
    """

    places: RequestPlaces
    own: IntArray
    nodes: IntArray
    states: dict[Key, InState] = field(default_factory=dict)


def _hold(team: Team, share: PlacesShare | None, number: int) -> None:
    """Keep the places of this rank, if it has any."""
    if share is None:
        return
    model = share.part.strained()
    probe = StressProbe.of(space_of(model), model, share.around, share.weights, share.of_body)
    places = RequestPlaces(probe=probe, node=share.node, points=share.at)
    team.held[number] = _OwnPlaces(places=places, own=share.own, nodes=share.part.nodes)


def _see(
    team: Team,
    u: Array | None,
    number: int,
    key: Key,
    factors: Mapping[str, float],
    kept: tuple[int, IntArray] | None,
) -> None:
    """Find stresses in a state; where ranks keep its displacements ``kept`` says where, see `rows_of_all`."""
    own: _OwnPlaces | None = team.held.get(number)
    nodes = np.zeros(0, dtype=np.int64) if own is None else own.nodes
    u = u if kept is None else rows_of_all(team, *kept, nodes)
    if own is not None:
        state = Instant(load_factor=0.0, what="share", contacts=(), work=np.nan, displacement=None, factors=factors)
        own.states[key] = in_state(own.places.probe, state, u)


def _judge(
    team: Team, rubbing: RubbedPairs | None, number: int, found: int, request: Fatigue, keys: Sequence[Key]
) -> None:
    """Judge own places, and keep what is found."""
    own: _OwnPlaces | None = team.held.get(number)
    if own is not None:
        probe = own.places.probe
        states = [own.states[key] if key is not None else in_state(probe, None, None) for key in keys]
        stress, strain, _ = together(probe, states)
        team.held[found] = OwnRows(own.own, judged(request, own.places, stress, strain, rubbing))
