# SPDX-License-Identifier: BSD-3-Clause
"""Outputs by the words that they print, as decks and the command line name them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from signorini.errors import InputError
from signorini.model.outputs import (
    Output,
    displacement,
    dissipation,
    force,
    gap,
    halfwidth,
    motion,
    pressure,
    stress,
    traction,
)
from signorini.model.outputs import moment as moment_about

_NUMBER = r"[-+.0-9e]+"
_CONTACT = r"(?: (?:of|on) '(?P<contact>[^']+)')?"
_VECTOR = rf"\((?P<vector>{_NUMBER}(?:, *{_NUMBER})+)\)"
_NODE = r"(?P<node>\d+)"
_FIELDS: dict[str, Callable[[str], Any]] = {"pressure": pressure, "traction": traction, "gap": gap, "motion": motion}
_KNOWN: tuple[tuple[str, Callable[[dict[str, Any]], Output]], ...] = (
    (rf"peak pressure{_CONTACT}", lambda own: pressure(own["contact"]).peak),
    (rf"mean pressure{_CONTACT}", lambda own: pressure(own["contact"]).mean()),
    (rf"half-width{_CONTACT}(?: about {_VECTOR})?", lambda own: halfwidth(own["contact"], about=own["vector"])),
    (rf"dissipation{_CONTACT}", lambda own: dissipation(own["contact"])),
    (
        rf"force(?: of the (?P<part>pressure|friction))?{_CONTACT} along {_VECTOR}",
        lambda own: force(own["contact"], along=own["vector"], of=own["part"] or "all"),
    ),
    (rf"moment{_CONTACT} about {_VECTOR}", lambda own: moment_about(own["contact"], about=own["vector"])),
    (rf"displacement of node {_NODE} along {_VECTOR}", lambda own: displacement(own["node"], along=own["vector"])),
    (
        rf"stress (?P<part>xx|yy|zz|xy|yz|xz) of '(?P<body>[^']+)' at node {_NODE}",
        lambda own: stress(own["body"], own["node"], own["part"]),
    ),
    (
        rf"(?P<field>pressure|traction|gap|motion){_CONTACT} at node {_NODE}",
        lambda own: _FIELDS[own["field"]](own["contact"])[own["node"]],
    ),
)
EXAMPLES = ("peak pressure", "half-width", "dissipation", "force along (0, 1)")
"""Words that name outputs of the only contact, for messages."""


def output_of(words: str) -> Output:
    """The output that prints some words; its contact may be left out where there is one.

    Parameters
    ----------
    words : as an output prints them, and ``signorini sensitivities``

    Raises
    ------
    InputError
        If no output prints them.

    Examples
    --------
    >>> output_of("peak pressure of 'hertz'"), output_of("force along (0, 1) at load factor 2").load_factor
    (peak pressure of 'hertz', 2.0)
    """
    told, _, factor = words.strip().partition(" at load factor ")
    for pattern, made in _KNOWN:
        found = re.fullmatch(pattern, told)
        if found is None:
            continue
        own: dict[str, Any] = {"contact": "", "vector": (), "part": ""}
        own |= {key: part for key, part in found.groupdict().items() if part}
        try:
            if own["vector"]:
                own["vector"] = tuple(float(part) for part in own["vector"].split(","))
            own["node"] = int(own.get("node", 0))
            output = made(own)
            return output.after(float(factor)) if factor else output
        except ValueError:
            break
    raise InputError(f"unknown output '{words}'; expected words such as {', '.join(repr(one) for one in EXAMPLES)}")
