# SPDX-License-Identifier: BSD-3-Clause
"""The part of a report that says what matters: the main answers by all that is given."""

from __future__ import annotations

import math

from signorini.report.markup import listed, said, table
from signorini.solution.sensitivities import Sensitivities

_MEANT = (
    "Changes of the answers at the end in per cent for one per cent of each parameter, through all events of the "
    "history; loads and supports stand for all that is multiplied. Beyond the interval another sequence of events "
    "takes the place of this one, and the answer bends."
)


def sensitivities_section(found: Sensitivities) -> str:
    """Answers, changes of them, in which changes of the parameters they hold, and what ends that.

    Parameters
    ----------
    found : per cent for per cent
    """
    numbers = [f"[{k}]" for k in range(1, len(found.outputs) + 1)]
    answers = [
        (number, words, f"{value:.6g}")
        for number, words, value in zip(numbers, found.outputs, found.values, strict=True)
    ]
    rows, ends = [], []
    for name, given, row, holds in zip(found.parameters, found.given, found.per_cent, found.holds, strict=True):
        interval = _change(holds.low), _change(holds.high)
        rows.append((name, f"{given:.6g}", *(f"{part:.4f}" for part in row), *interval))
        ends += [(name, change, words) for change, words in zip(interval, holds.ends, strict=True) if words]
    head = ("parameter", "value", *numbers, "holds from", "to")
    parts = [
        f"<p>{_MEANT}</p>",
        table([("", "answer", "value"), *answers], numbers=(2,), caption="Answers at the end"),
        table([head, *rows], numbers=range(1, len(head)), caption="Per cent of each for one per cent"),
        table([("parameter", "change", "what happens"), *ends], numbers=(1,), caption="What ends that") if ends else "",
        listed([said(words) for words in found.refused]) if found.refused else "",
    ]
    return "".join(parts)


def _change(change: float) -> str:
    return f"{change:+.3g} %" if math.isfinite(change) else "-"
