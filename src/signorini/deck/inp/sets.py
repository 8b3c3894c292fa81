# SPDX-License-Identifier: BSD-3-Clause
"""Node sets and element sets by name, and names that nothing else has."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.card import NUMBER_LIMIT, Card, Row, Scope, to_number
from signorini.deck.inp.grid import DeckGrid, nodes_of
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.numbers import Numbering, number_table, whole_numbers
from signorini.errors import one_of

_MAX_GENERATED = 10_000_000  # members of a range: more than any mesh here has


class Sets:
    """Named sets of nodes or of elements; names in any case, a set may be defined in pieces.

    Parameters
    ----------
    numbering : of what the sets hold
    """

    def __init__(self, numbering: Numbering) -> None:
        self.numbering = numbering
        self._pieces: dict[str, list[IntArray]] = defaultdict(list)
        self._spelled: dict[str, str] = {}

    def add(self, name: str, members: IntArray) -> None:
        """Add members to a set; the first spelling of its name stays."""
        self._spelled.setdefault(name.upper(), name)
        self._pieces[name.upper()].append(members)

    def __contains__(self, name: str) -> bool:
        return name.upper() in self._pieces

    def __getitem__(self, name: str) -> IntArray:
        """Sorted members."""
        key = name.upper()
        if len(self._pieces[key]) > 1 or not _ascending(self._pieces[key][0]):
            self._pieces[key] = [distinct(np.concatenate(self._pieces[key]))]
        return self._pieces[key][0]

    def spelled(self, name: str) -> str:
        """The name as the deck first spells it."""
        return self._spelled[name.upper()]

    @property
    def names(self) -> list[str]:
        """All names as first spelled."""
        return list(self._spelled.values())

    def key(self, word: str, scope: Scope) -> str | None:
        """The name by which the whole deck knows a set that is called ``word`` in a scope, if there is one."""
        inner = scope.prefixed(word)
        return next((name for name in (inner, word) if name in self), None)

    def find(self, word: str, at: Card | Row) -> tuple[str, IntArray]:
        """Label and members of a set or a single number that a card names; instances go before a dot: ``PART-1.7``."""
        name = self.key(word, at.scope)
        if name is not None:
            return self.spelled(name), self[name]
        outer, dot, inner = word.rpartition(".")
        number = to_number(inner if dot and outer and not outer.isdigit() else word)
        if number is None or number != int(number) or abs(number) >= NUMBER_LIMIT:
            raise at.error(one_of(word, self.names, f"{self.numbering.what} set"))
        place = Scope(name=outer.upper()) if dot and outer and not outer.isdigit() else at.scope
        members = self.numbering.index(place, np.array([int(number)]), at)
        return f"{self.numbering.what} {word}", members


def unique_label(label: str, taken: Container[str]) -> str:
    """The label, or with a number behind it if another bears it.

    >>> unique_label("top", {"top"})
    'top (2)'
    """
    number, name = 1, label
    while name in taken:
        number += 1
        name = f"{label} ({number})"
    return name


def _ascending(members: IntArray) -> bool:
    return bool((np.diff(members) > 0).all())


def make_sets(cards: Sequence[Card], grid: DeckGrid) -> tuple[Sets, Sets]:
    """Node sets and element sets of a deck, in the order of their definitions."""
    nodes, elements = Sets(grid.nodes), Sets(grid.elements)
    for group in grid.all_groups:
        if group.card.parameters.get("ELSET"):
            elements.add(group.card.scope.prefixed(group.card.parameters["ELSET"]), group.index)
    for card in of_keyword(cards, "NODE"):
        if card.parameters.get("NSET"):
            numbers = _numbers_of_nodes(card)
            nodes.add(card.scope.prefixed(card.parameters["NSET"]), grid.nodes.index(card.scope, numbers, card))
    for card in cards:
        if card.keyword in ("NSET", "ELSET"):
            _define(card, nodes if card.keyword == "NSET" else elements, elements, grid)
    return nodes, elements


def _numbers_of_nodes(card: Card) -> IntArray:
    return number_table(card, "a number and up to 3 coordinates", least=1, most=7)[:, 0].astype(np.int64)


def _define(card: Card, sets: Sets, elements: Sets, grid: DeckGrid) -> None:
    key = card.keyword
    card.refuse_unknown((key, "GENERATE", "INSTANCE", "ELSET", "INPUT"), ("INTERNAL", "UNSORTED", "FREQUENCY"))
    name = card.scope.prefixed(card.value(key))
    if card.parameters.get("INSTANCE"):
        card = replace(card, scope=Scope(name=card.parameters["INSTANCE"].upper()))
    if key == "NSET" and card.parameters.get("ELSET"):
        sets.add(name, nodes_of(grid, elements.find(card.parameters["ELSET"], card)[1]))
        return
    if "GENERATE" in card.parameters:
        sets.add(name, _generated(card, sets.numbering))
        return
    numbers = whole_numbers(card)
    if numbers is not None:
        sets.add(name, sets.numbering.index(card.scope, numbers, lambda field: card.at(card.row_with(field))))
        return
    sets.add(name, np.empty(0, np.int64))
    for row in card.rows():
        for word in row.fields:
            if word:
                sets.add(name, sets.find(word, row)[1])


def _generated(card: Card, numbering: Numbering) -> IntArray:
    """Members from first to last by steps; numbers in between that nothing has are left out, as CalculiX does."""
    pieces: list[IntArray] = [np.empty(0, np.int64)]
    for row in card.rows():
        first, last = row.whole(0, "the first number"), row.whole(1, "the last number", row.whole(0, "a number"))
        step = row.whole(2, "the step", 1)
        if step < 1 or last < first or (last - first) // step > _MAX_GENERATED:
            raise row.error(f"*{card.keyword}: goes from {first} to {last} by {step}; expected an ascending range")
        pieces.append(numbering.find(card.scope.name, np.arange(first, last + 1, step))[0])
    return np.concatenate(pieces)
