# SPDX-License-Identifier: BSD-3-Clause
"""Two histories side by side: how far apart their results are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import IntArray
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History
from signorini.solution.results import ContactResult, PlasticResult, StepResult

_Labels = tuple[IntArray, IntArray]
_ENERGIES = ("strain_energy", "interface_energy", "work", "dissipation")
_STRESSES, _LENGTHS = ("pressure", "traction"), ("gap", "slip")
_RESULTANTS = ("normal_force", "tangential_force")


@dataclass(frozen=True, kw_only=True)
class Difference:
    """The difference of one quantity between two histories.

    Attributes
    ----------
    step : name of the step
    quantity : as ``"displacement"`` or ``"arc: pressure"``
    kind : what it is compared with: "length", "force", "stress", "strain" or "energy"; of fatigue itself
    largest : largest absolute difference
    size : largest absolute value of its kind in the step, gaps not counted
    where : the node with the largest difference, None for what has no nodes
    """

    step: str
    quantity: str
    kind: str
    largest: float
    size: float
    where: int | None = None

    @property
    def relative(self) -> float:
        """Largest difference over the size; 0 where nothing differs."""
        return self.largest / self.size if self.size else float(self.largest > 0.0)


def compare(first: History, second: History) -> tuple[list[Difference], list[str]]:
    """Compare step by step what both have: nodes by their numbers, supports and contacts by their names.

    Returns
    -------
    Differences, and words for what only one has
    """
    differences: list[Difference] = []
    words: list[str] = []
    for what, a, b in (
        ("status", first.status, second.status),
        ("kind", first.model.kind, second.model.kind),
        ("steps", len(first.steps), len(second.steps)),
        ("nodes", len(first.model.mesh.points), len(second.model.mesh.points)),
    ):
        if a != b:
            words.append(f"{what}: {a} and {b}")
    labels = first.model.mesh.labels, second.model.mesh.labels
    for mine, theirs in zip(first.steps, second.steps, strict=False):
        words += _alone(mine, theirs)
        found = list(_step(mine, theirs, labels))
        sizes: dict[str, float] = {}
        for d in found:
            if not d.quantity.endswith("gap"):  # a gap that is wide says nothing of the size of motions
                sizes[d.kind] = max(sizes.get(d.kind, 0.0), d.size)
        differences += [replace(d, size=sizes[d.kind]) for d in found]
    count = len(first.fatigue_results), len(second.fatigue_results)
    if count[0] != count[1]:
        words.append(f"fatigue criteria: {count[0]} and {count[1]}")
    for number, (one, two) in enumerate(zip(first.fatigue_results, second.fatigue_results, strict=False), start=1):
        if one.name != two.name:
            words.append(f"fatigue criterion {number}: {one.name} and {two.name}")
        else:
            differences += _fatigue(number, one, two, labels)
    return differences, list(dict.fromkeys(words))


def _fatigue(number: int, mine: FatigueResult, theirs: FatigueResult, labels: _Labels) -> Iterator[Difference]:
    """Between what a criterion says at places that both have, by body and node: each quantity by its own size."""
    places = []
    for result, own in zip((mine, theirs), labels, strict=True):
        places.append(
            {(body, own[node]): k for k, (body, node) in enumerate(zip(result.body, result.node, strict=True))}
        )
    common = [place for place in places[0] if place in places[1]]
    i, j = (np.array([own[place] for place in common], int) for own in places)
    for key in ["parameter", "amplitude", "stress", *(["life"] if mine.lives and theirs.lives else [])]:
        one, two = getattr(mine, key)[i], getattr(theirs, key)[j]
        other = one != two  # lives without end are alike
        apart = np.zeros(len(one))
        apart[other] = np.abs(one[other] - two[other])
        known = np.abs(np.concatenate([one, two]))
        yield Difference(
            step=mine.steps[-1],
            quantity=f"fatigue {number} {mine.name}: {key}",
            kind=f"fatigue {key}",
            largest=float(apart.max()) if common else np.inf,
            size=float(known[np.isfinite(known)].max(initial=0.0)),
            where=int(common[int(apart.argmax())][1]) if common else None,
        )


def _alone(mine: StepResult, theirs: StepResult) -> Iterator[str]:
    if (mine.plastic is None) != (theirs.plastic is None):
        yield f"bodies yield only in the {'second' if mine.plastic is None else 'first'}"
    contacts = ([contact.name for contact in step.contacts] for step in (mine, theirs))
    for what, names in (("support", (list(mine.reactions), list(theirs.reactions))), ("contact", tuple(contacts))):
        for name in dict.fromkeys([*names[0], *names[1]]):
            if name not in names[0] or name not in names[1]:
                yield f"{what} '{name}' is only in the {'first' if name in names[0] else 'second'}"


def _step(mine: StepResult, theirs: StepResult, labels: _Labels) -> Iterator[Difference]:
    step = mine.name
    yield _difference(step, "displacement", "length", (mine.displacement, theirs.displacement), labels)
    for key in _ENERGIES:
        yield _difference(step, key.replace("_", " "), "energy", (getattr(mine, key), getattr(theirs, key)))
    if mine.plastic is not None and theirs.plastic is not None:
        yield from _flow(step, mine.plastic, theirs.plastic)
    for name in mine.reactions:
        if name in theirs.reactions:
            yield _difference(step, f"reaction {name}", "force", (mine.reactions[name], theirs.reactions[name]))
    others = {contact.name: contact for contact in theirs.contacts}
    for contact in mine.contacts:
        if contact.name in others:
            yield from _contact(step, contact, others[contact.name], labels)


def _flow(step: str, mine: PlasticResult, theirs: PlasticResult) -> Iterator[Difference]:
    """Between what bodies that yield have at the points of their cells, which are those of one mesh."""
    one, two = mine.state, theirs.state
    compared: tuple[tuple[str, str, tuple[ArrayLike, ArrayLike]], ...] = (
        ("energy", "plastic dissipation", (mine.dissipation, theirs.dissipation)),
        ("energy", "back stress energy", (mine.stored, theirs.stored)),
        ("strain", "equivalent plastic strain", (one.equivalent, two.equivalent)),
        ("strain", "plastic strain", (one.strain, two.strain)),
        ("stress", "back stress", (one.back.sum(axis=1), two.back.sum(axis=1))),
    )
    for kind, quantity, values in compared:
        yield _difference(step, quantity, kind, values)


def _contact(step: str, mine: ContactResult, theirs: ContactResult, labels: _Labels) -> Iterator[Difference]:
    nodes = labels[0][mine.node], labels[1][theirs.node]
    for kind, keys, at in (("stress", _STRESSES, nodes), ("length", _LENGTHS, nodes), ("force", _RESULTANTS, None)):
        for key in keys:
            words = f"{mine.name}: {key.replace('_', ' ')}"
            yield _difference(step, words, kind, (getattr(mine, key), getattr(theirs, key)), at)


def _difference(
    step: str, quantity: str, kind: str, values: tuple[ArrayLike, ArrayLike], nodes: _Labels | None = None
) -> Difference:
    """Between two values, of fields over the nodes that both have."""
    mine, theirs = (np.atleast_1d(each) for each in values)
    common = None
    if nodes is not None:
        common, i, j = np.intersect1d(nodes[0], nodes[1], return_indices=True)
        mine, theirs = mine[i], theirs[j]
    if mine.shape != theirs.shape or not mine.size:
        return Difference(step=step, quantity=quantity, kind=kind, largest=np.inf, size=0.0)
    apart = np.abs(mine - theirs).reshape(len(mine), -1).max(axis=1)
    worst = int(apart.argmax())
    return Difference(
        step=step,
        quantity=quantity,
        kind=kind,
        largest=float(apart[worst]),
        size=float(max(np.abs(mine).max(), np.abs(theirs).max())),
        where=None if common is None else int(common[worst]),
    )
