# SPDX-License-Identifier: BSD-3-Clause
"""Factors over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, frozen
from signorini.deck.inp.card import Card
from signorini.deck.inp.keywords import look_up, of_keyword

_BEND_TOL = 1e-9  # of the largest factor: times and factors are written with ten digits


@dataclass(frozen=True, kw_only=True, eq=False)
class Amplitude:
    """A factor that is linear between its times, constant before and after them.

    Attributes
    ----------
    name : as in the deck
    times, values : (n,)
    total : times count from the first step, not from each
    """

    name: str
    times: Array
    values: Array
    total: bool

    def at(self, time: float) -> float:
        """The factor at a time."""
        return float(np.interp(time, self.times, self.values))

    def breaks(self, start: float, end: float) -> Array:
        """Times in between at which the factor turns away from the straight line from start to end."""
        inside = (self.times > start) & (self.times < end)
        line = np.interp(self.times, [start, end], [self.at(start), self.at(end)])
        bent = np.abs(self.values - line) > _BEND_TOL * max(np.abs(self.values).max(), 1e-300)
        times: Array = self.times[inside] if (bent & inside).any() else np.empty(0)
        return times


def make_amplitudes(cards: Sequence[Card]) -> Mapping[str, Amplitude]:
    """Read all ``*AMPLITUDE`` keywords, by name in capitals."""
    amplitudes = {}
    for card in of_keyword(cards, "AMPLITUDE"):
        card.refuse_unknown(("NAME", "TIME", "DEFINITION", "VALUE", "INPUT"))
        card.choice("DEFINITION", ("TABULAR",), "TABULAR")
        card.choice("VALUE", ("RELATIVE",), "RELATIVE")  # ABSOLUTE would take the place of the load's own value
        total = card.choice("TIME", ("STEP TIME", "TOTAL TIME", "TOTALTIME"), "STEP TIME") != "STEP TIME"
        flat = [row.number(i, "a time or a factor") for row in card.rows() for i in range(len(row.fields))]
        if not flat or len(flat) % 2:
            raise card.error(f"has {len(flat)} numbers; expected pairs of a time and a factor")
        times, values = frozen(flat[::2]), frozen(flat[1::2])
        if (np.diff(times) < 0).any():
            late = int(np.argmax(np.diff(times) < 0)) + 1
            words = f"has the time {times[late]:g} after {times[late - 1]:g}; expected times that ascend"
            raise card.at(card.row_with(2 * late)).error(words)
        name = card.value("NAME")
        if name.upper() in amplitudes:
            raise card.error(f"there is another amplitude '{name}'")
        amplitudes[name.upper()] = Amplitude(name=name, times=times, values=values, total=total)
    return amplitudes


def find_amplitude(card: Card, amplitudes: Mapping[str, Amplitude]) -> Amplitude | None:
    """The amplitude that a keyword names, if any."""
    return look_up(card, "AMPLITUDE", amplitudes, "amplitude") if "AMPLITUDE" in card.parameters else None
