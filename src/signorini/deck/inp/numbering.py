# SPDX-License-Identifier: BSD-3-Clause
"""From numbers of a deck, known inside an instance, to indices that count through everything."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.arrays import IntArray
from signorini.deck.inp.card import Card, Row, Scope


class Numbering:
    """Numbers of nodes or of elements, scope by scope.

    Parameters
    ----------
    what : "node" or "element", for messages
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self._sorted: dict[str, tuple[IntArray, IntArray]] = {}  # scope to numbers in order and their indices
        self._labels: list[IntArray] = []
        self._count = 0
        self._largest = 0

    def add(self, scope: str, numbers: IntArray) -> None:
        """Number what a scope holds, each number once; all of a scope at a time."""
        order = np.argsort(numbers, kind="stable")
        self._sorted[scope] = numbers[order], self._count + order
        shift = self._largest if self._labels and len(numbers) and self._clash(numbers) else 0
        self._labels.append(numbers + shift)
        self._count += len(numbers)
        self._largest = max(self._largest, int(numbers.max(initial=0)) + shift)

    def _clash(self, numbers: IntArray) -> bool:
        return bool(np.isin(numbers, np.concatenate(self._labels)).any())

    @property
    def labels(self) -> IntArray:
        """(n,) numbers for results: those of the deck; of instances that share numbers, the later ones are shifted."""
        return np.concatenate(self._labels) if self._labels else np.empty(0, np.int64)

    @property
    def shifted(self) -> bool:
        """Whether any number differs from the deck's."""
        return any(
            not np.array_equal(np.sort(a), b[0]) for a, b in zip(self._labels, self._sorted.values(), strict=True)
        )

    def find(self, scope: str, numbers: IntArray) -> tuple[IntArray, IntArray]:
        """Indices of numbers that are there, and places in ``numbers`` of those that are not."""
        known, index = self._sorted.get(scope, (np.empty(0, np.int64), np.empty(0, np.int64)))
        if not len(known):
            return np.empty(0, np.int64), np.arange(len(numbers))
        at = np.minimum(np.searchsorted(known, numbers), len(known) - 1)
        found = known[at] == numbers
        return index[at[found]], np.nonzero(~found)[0]

    def index(self, scope: Scope, numbers: IntArray, at: Card | Row | Callable[[int], Card]) -> IntArray:
        """Indices of numbers of a scope, all of which must be there; else ``at`` is blamed, or gives by place what is.

        Raises
        ------
        DeckError
            If one of them is not there.
        """
        found, missing = self.find(scope.name, numbers)
        if len(missing):
            inside = f" in instance '{scope.name}'" if scope.name else ""
            blamed = at if isinstance(at, Card | Row) else at(int(missing[0]))
            raise blamed.error(f"there is no {self.what} {numbers[missing[0]]}{inside}")
        return found
