# SPDX-License-Identifier: BSD-3-Clause
"""Two histories side by side: how far apart their results are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.solution.history import History
from signorini.solution.results import ContactResult, StepResult

_CONTACT = ("gap", "pressure", "traction", "slip")


@dataclass(frozen=True, kw_only=True)
class Difference:
    """How far one quantity is apart.

    Attributes
    ----------
    step : name of the step
    quantity : as ``"displacement"`` or ``"arc: pressure"``
    largest : largest absolute difference
    size : largest absolute value of both
    where : the node with the largest difference, None for what has no nodes
    """

    step: str
    quantity: str
    largest: float
    size: float
    where: int | None = None

    @property
    def relative(self) -> float:
        """Largest difference over the size; 0 where both are zero."""
        return self.largest / self.size if self.size else 0.0


def compare(first: History, second: History) -> tuple[list[Difference], list[str]]:
    """Compare step by step what both have: nodes by their numbers, supports, contacts and steps by their names.

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
        differences += _steps(mine, theirs, labels, words)
    return differences, list(dict.fromkeys(words))


def _steps(mine: StepResult, theirs: StepResult, labels: tuple[Array, Array], words: list[str]) -> list[Difference]:
    found = [_field(mine.name, "displacement", labels, (mine.displacement, theirs.displacement))]
    found += [
        _values(mine.name, key.replace("_", " "), np.array([getattr(mine, key)]), np.array([getattr(theirs, key)]))
        for key in ("strain_energy", "interface_energy", "work", "dissipation")
    ]
    for name in dict.fromkeys([*mine.reactions, *theirs.reactions]):
        if name in mine.reactions and name in theirs.reactions:
            found.append(_values(mine.name, f"reaction {name}", mine.reactions[name], theirs.reactions[name]))
        else:
            words.append(f"support '{name}' is only in one")
    others = {contact.name: contact for contact in theirs.contacts}
    for contact in mine.contacts:
        if contact.name in others:
            found += _contact(mine.name, contact, others[contact.name], labels)
        else:
            words.append(f"contact '{contact.name}' is only in the first")
    return found


def _contact(step: str, mine: ContactResult, theirs: ContactResult, labels: tuple[Array, Array]) -> list[Difference]:
    nodes = labels[0][mine.node], labels[1][theirs.node]
    found = [
        _field(step, f"{mine.name}: {key}", nodes, (getattr(mine, key), getattr(theirs, key))) for key in _CONTACT
    ]
    for key in ("normal_force", "tangential_force"):
        words = f"{mine.name}: {key.replace('_', ' ')}"
        found.append(_values(step, words, getattr(mine, key), getattr(theirs, key)))
    return found


def _field(step: str, quantity: str, nodes: tuple[Array, Array], values: tuple[Array, Array]) -> Difference:
    """Over the nodes that both have."""
    common, i, j = np.intersect1d(nodes[0], nodes[1], return_indices=True)
    if not len(common) or values[0].shape[1:] != values[1].shape[1:]:
        return Difference(step=step, quantity=quantity, largest=np.inf, size=1.0)
    a, b = values[0][i].reshape(len(common), -1), values[1][j].reshape(len(common), -1)
    apart = np.abs(a - b).max(axis=1)
    worst = int(apart.argmax())
    size = float(max(np.abs(a).max(), np.abs(b).max()))
    return Difference(step=step, quantity=quantity, largest=float(apart[worst]), size=size, where=int(common[worst]))


def _values(step: str, quantity: str, a: Array, b: Array) -> Difference:
    if a.shape != b.shape:
        return Difference(step=step, quantity=quantity, largest=np.inf, size=1.0)
    size = float(max(np.abs(a).max(initial=0.0), np.abs(b).max(initial=0.0)))
    return Difference(step=step, quantity=quantity, largest=float(np.abs(a - b).max(initial=0.0)), size=size)
