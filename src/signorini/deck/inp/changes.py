# SPDX-License-Identifier: BSD-3-Clause
"""What steps change of the contacts: friction, and pairs that are switched off and on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.interactions import Interaction, read_friction
from signorini.deck.inp.pairs import Pair
from signorini.deck.inp.steps import DeckStep
from signorini.deck.inp.surfaces import Surfaces
from signorini.errors import one_of


def make_changes(
    step: DeckStep, pairs: Sequence[Pair], interactions: Mapping[str, Interaction], surfaces: Surfaces
) -> dict[str, Any]:
    """Read ``*CHANGE FRICTION`` with its ``*FRICTION``, and ``*MODEL CHANGE`` or ``*CHANGE CONTACT PAIR`` of a step.

    Returns
    -------
    Keywords of the model's step

    Raises
    ------
    DeckError
        For unknown interactions and surfaces, and changes of anything else.
    """
    friction: dict[str, Any] = {}
    switched: dict[str, bool] = {}
    changed = ""
    for item in step.placed:
        card = item.card
        if card.keyword == "CHANGE FRICTION":
            card.refuse_unknown(("INTERACTION",))
            changed = card.value("INTERACTION").upper()
            if changed not in interactions:
                known = [law.card.value("NAME") for law in interactions.values()]
                raise card.error(one_of(card.value("INTERACTION"), known, "surface interaction"))
        elif card.keyword == "FRICTION":
            if not changed:
                raise card.error("stands in a step without *CHANGE FRICTION before it")
            coefficient, compliance = read_friction(card)
            if "TAUMAX" in card.parameters or interactions[changed].shear_limit is not None:
                raise card.error("changes friction with a largest traction, which is not supported")
            if compliance != interactions[changed].tangential_compliance:
                raise card.error("changes the stick slope, which is not supported; expected that of the model")
            friction |= {pair.contact.label: coefficient for pair in pairs if pair.interaction == changed}
        elif card.keyword in ("MODEL CHANGE", "CHANGE CONTACT PAIR"):
            switched |= _switched(item, pairs, surfaces)
    found: dict[str, Any] = {"friction": friction} if friction else {}
    for key, on in (("active", True), ("inactive", False)):
        names = tuple(name for name, state in switched.items() if state is on)
        if names:
            found[key] = names
    return found


def _switched(item: Placed, pairs: Sequence[Pair], surfaces: Surfaces) -> dict[str, bool]:
    card = item.card
    card.refuse_unknown(("TYPE", "ADD", "REMOVE"))
    if card.choice("TYPE", ("CONTACT PAIR", "ELEMENT"), "CONTACT PAIR") == "ELEMENT":
        raise card.error("TYPE=ELEMENT is not supported; expected CONTACT PAIR")
    if ("ADD" in card.parameters) == ("REMOVE" in card.parameters):
        raise card.error("expected either ADD or REMOVE")
    found: dict[str, bool] = {}
    card.row("the slave and the master surface")
    for row in card.rows():
        sides = tuple(surfaces.find(row.text(i, "a surface"), item.scope, row) for i in (0, 1))
        names = [pair.contact.label for pair in pairs if (pair.contact.nonmortar, pair.contact.mortar) == sides]
        if not names:
            raise row.error(f"there is no contact pair of '{sides[0]}' and '{sides[1]}'")
        found |= dict.fromkeys(names, "ADD" in card.parameters)
    return found
