# SPDX-License-Identifier: BSD-3-Clause
"""``*FREQUENCY``: natural modes about the end of the static steps before it, or of the bodies as they are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from signorini.deck.inp.card import Card
from signorini.deck.inp.keywords import HARMLESS, MODES_WORDS, PRINTED, unsupported
from signorini.deck.inp.refusals import Refusals
from signorini.deck.inp.steps import IGNORED
from signorini.errors import InputError
from signorini.model.modes import ModesRequest

_OPTIONS = ("SOLVER", "STORAGE", "EIGENSOLVER", "NORMALIZATION")  # how others find modes, and how long these are
_OF_SETS = ("NSET", "ELSET", "AMPLITUDE")  # which act on nothing by themselves

_WAVES = "SELECT CYCLIC SYMMETRY MODES"

_STRESS_NOTE = (
    "*FREQUENCY: modes are about the end of the steps before; how their stresses stiffen bodies, which CalculiX adds "
    "with PERTURBATION, is not in them"
)
_FILES_NOTE = (
    "*FREQUENCY: 'signorini modes' computes the modes and writes them to modes.csv and modes.vtu, whatever prints the "
    "step has"
)
_LIMIT_NOTE = "*FREQUENCY: the lowest modes are computed, those below its limit and rigid motions among them"


@dataclass(frozen=True, kw_only=True, eq=False)
class FrequencyStep:
    """What the last step of a deck asks for of modes.

    Attributes
    ----------
    request : the modes
    notes : how they differ from what the deck asks for
    """

    request: ModesRequest
    notes: tuple[str, ...]


def take_modes(cards: list[Card], refusals: Refusals) -> tuple[list[Card], FrequencyStep | None]:
    """The cards without a ``*FREQUENCY`` step, and what that asks for.

    Where no static step is before it, an empty one takes its place, with its boundary conditions: the modes are then
    those of the bodies as they are drawn.

    Parameters
    ----------
    cards : of the deck
    refusals : gathers what is wrong with the step
    """
    starts = [i for i, card in enumerate(cards) if card.keyword == "STEP"]
    ends = [i for i, card in enumerate(cards) if card.keyword == "END STEP"]
    asking = next((i for i, card in enumerate(cards) if card.keyword in MODES_WORDS), None)
    if asking is None or len(starts) != len(ends) or not starts or asking < starts[0]:
        return cards, None
    number = max(k for k, start in enumerate(starts) if start < asking)
    start, end = starts[number], ends[number]
    members, alone = cards[start + 1 : end], number == 0
    found = None
    with refusals.gather():
        if number < len(starts) - 1:
            raise cards[starts[number + 1]].error("follows a *FREQUENCY step; expected that to be the last step")
        found = _read(cards[start], cards[asking], members, alone)
    if not alone:
        return [*cards[:start], *cards[end + 1 :]], found
    static = replace(cards[asking], keyword="STATIC", parameters={}, chunks=[])
    kept = [card for card in members if card.keyword in ("BOUNDARY", *_OF_SETS)]
    return [*cards[:start], cards[start], static, *kept, *cards[end:]], found


def _read(step: Card, asking: Card, members: Sequence[Card], alone: bool) -> FrequencyStep:
    """The request of a step with its members; ``alone``: no step is before it.

    Raises
    ------
    DeckError
        For what would change the modes and is not read.
    """
    step.refuse_unknown((), (*IGNORED, "PERTURBATION", "NLGEOM"))
    asking.refuse_unknown((), _OPTIONS)
    row = asking.row("the number of modes")
    if any(row.fields[2:]):
        raise row.error("has an upper limit or more; expected the number of modes, and a lower limit")
    for card in members:
        if card.keyword == "BOUNDARY" and not alone:
            raise card.error("stands in a *FREQUENCY step behind others; expected it in a static step")
        if card.keyword not in (*MODES_WORDS, _WAVES, "BOUNDARY", *_OF_SETS, *PRINTED, *HARMLESS):
            raise card.error(unsupported(card.keyword, "inside a *FREQUENCY step"))
    try:
        number = row.whole(0, "the number of modes")
        request = ModesRequest(number=number, preload=not alone, nodal_diameters=_diameters(members))
    except InputError as error:
        raise row.error(error.message) from error
    limit = [_LIMIT_NOTE] if row.number(1, "a frequency", 0.0) > 0.0 else []
    stress = [] if alone else [_STRESS_NOTE]
    return FrequencyStep(request=request, notes=(_FILES_NOTE, *limit, *stress))


def _diameters(members: Sequence[Card]) -> int:
    """Nodal diameters that a step selects, 0 where it selects none.

    Raises
    ------
    DeckError
        For more than one number of them.
    """
    found = [card for card in members if card.keyword == _WAVES]
    if not found:
        return 0
    card = found[-1]
    card.refuse_unknown(("NMIN", "NMAX"))
    least, most = (card.get(key) or "0" for key in ("NMIN", "NMAX"))
    if least != most or not least.isdigit():
        raise card.error(f"has NMIN={least} and NMAX={most}; expected one whole number as both, and a run for each")
    return int(least)
