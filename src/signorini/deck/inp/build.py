# SPDX-License-Identifier: BSD-3-Clause
"""From an Abaqus or CalculiX deck to a model."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from signorini.arrays import Array
from signorini.deck.deck import Deck
from signorini.deck.error import DeckError
from signorini.deck.inp.bonds import bonds_apart
from signorini.deck.inp.card import Card
from signorini.deck.inp.conditions import Conditions, make_conditions
from signorini.deck.inp.cyclic import make_cyclic
from signorini.deck.inp.frequency import take_modes
from signorini.deck.inp.grid import DeckGrid, element_type, make_grid
from signorini.deck.inp.keywords import MODEL_WORDS, STEP_WORDS, of_keyword, refuse_unsupported
from signorini.deck.inp.known import Known, make_known
from signorini.deck.inp.links import make_deck_links
from signorini.deck.inp.loading import follow_steps, initial_temperatures
from signorini.deck.inp.materials import Section
from signorini.deck.inp.pairs import Pair, make_changes, make_contacts
from signorini.deck.inp.plasticity import above_initial
from signorini.deck.inp.pretension import cut_along, make_pretensions, pretension_equations
from signorini.deck.inp.prints import make_prints
from signorini.deck.inp.refusals import Refusals
from signorini.deck.inp.steps import DeckStep, split_steps
from signorini.deck.inp.syntax import flatten, read_cards
from signorini.deck.tables import FIELDS
from signorini.errors import InputError, Where
from signorini.model.body import Body
from signorini.model.kind import WITHOUT_THICKNESS, Kind
from signorini.model.material import Orthotropic
from signorini.model.mesh import NODES_PER_CELL, Mesh
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.sources import Reach

_SMALL_SLIDING = "contact is treated as small sliding: pairs are found on the undeformed bodies"
_FOLLOWING_PAIRS = "NLGEOM: contact pairs follow the bodies, which may turn by any angle; strains are small about that"
_OWN_INCREMENTS = (
    "increments of the deck are not used: {} follow the package's rule (exact path where there is friction, otherwise "
    "one increment); --increments deck takes them over"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class KeywordDeck(Deck):
    """A deck of keywords.

    Attributes
    ----------
    places : keyword of every part of the model, by its path
    reach : files that it may include
    """

    places: Mapping[Where, Card]
    reach: Reach

    def locate(self, error: InputError) -> DeckError:
        """An error that is found after reading with file and line of the keyword that caused it."""
        return _located_error(error, self.places, self.path, self._card_of_cell)

    def _card_of_cell(self, cell: int) -> Card:
        """The ``*ELEMENT`` keyword, at its line, of the element that a cell is; reads the deck once more."""
        return make_grid(split_steps(flatten(read_cards(self.path, self.reach)), Refusals())[0]).card_of_cell(cell)


def read_deck(path: Path, reach: Reach, *, small_strain: bool, deck_increments: bool) -> KeywordDeck:
    """Read a deck of keywords: cards, then what has a number or a name, then parts, then what acts on them.

    Parameters
    ----------
    path : of the deck
    reach : files that it may include
    small_strain : solve with small displacements what asks for large ones (NLGEOM)
    deck_increments : follow the deck's increments instead of the package's rule
    """
    refusals = Refusals()
    cards, frequency = take_modes(flatten(read_cards(path, reach)), refusals)
    outside, steps = split_steps(cards, refusals)
    ignored = _left_out(outside, steps, refusals)
    refusals.stop()
    _refuse_incomplete(outside, steps, path)

    known = make_known(cards, outside, refusals)
    with refusals.gather():
        contacts = make_contacts(outside, known, large=not small_strain and any(step.nlgeom for step in steps))
        _refuse_large(steps, contacts, small_strain)
    with refusals.gather():
        rigid, equations = make_deck_links(outside, known)
        conditions = make_conditions(follow_steps(outside, steps, known, rigid), known)
    with refusals.gather():
        pretensions, sectors = make_pretensions(outside, known), make_cyclic(outside, known)
    refusals.stop()
    mesh = cut_along(_mesh(known), pretensions)
    changes = [make_changes(step.cards, known, contacts) for step in steps]
    initial = initial_temperatures(outside, known)
    kind, thickness = known.grid.kind, _thickness(known.sections[0], known.grid.kind)
    made: dict[str, list[tuple[Any, Card]]] = {
        "body": [(_body(section, known.grid, thickness, initial), section.card) for section in known.sections],
        "support": [(support, conditions.cards[support.label]) for support in conditions.supports],
        "load": [(load, conditions.cards[load.label]) for load in conditions.loads],
        "contact": [(pair.contact, pair.card) for pair in contacts],
        "rigid_body": [(item.body, item.card) for item in rigid],
        "equation": [
            *((item.equation, item.card) for item in [*equations, *conditions.equations]),
            *pretension_equations(mesh, pretensions),
        ],
        "cyclic_symmetry": sectors,
        "step": [(_step(k, steps, conditions, changes[k], deck_increments), steps[k].card) for k in range(len(steps))],
    }
    places: dict[Where, Card] = {(key, i): card for key, found in made.items() for i, (_, card) in enumerate(found)}
    parts: dict[str, Any] = {FIELDS[key]: [part for part, _ in found] for key, found in made.items()}
    try:
        model = Model(mesh, kind=kind, thickness=thickness, title=_title(outside), **parts)
    except InputError as error:
        raise _located_error(error, places, path, known.grid.card_of_cell) from error
    notes = [
        *_notes(known.grid, steps, contacts, small_strain, deck_increments),
        *_flow_notes(known.sections, model.bodies),
        *dict.fromkeys(law.note for law in known.interactions.values() if law.note),
        *_overlap_notes(outside, known),
        *(() if frequency is None else frequency.notes),
    ]
    return KeywordDeck(
        model=model,
        path=path,
        lines={},
        places=places,
        reach=reach,
        notes=(*conditions.notes, *notes, *_ignored(ignored)),
        prints=make_prints(steps, known, contacts, rigid, model.mesh),
        unused_materials=known.unused_materials,
        modes=None if frequency is None else frequency.request,
    )


def _located_error(
    error: InputError, places: Mapping[Where, Card], path: Path, card_of_cell: Callable[[int], Card]
) -> DeckError:
    """The error with the line of the keyword that its place in the model comes from, or of the element of its cell."""
    if isinstance(error, DeckError):
        return error
    if error.cell is not None:
        return card_of_cell(error.cell).error(error.message)
    for end in range(len(error.where), 0, -1):
        card = places.get(error.where[:end])
        if card is not None:
            return card.error(error.message)
    return DeckError(error.message, path=path, where=error.where)


def _left_out(outside: Sequence[Card], steps: Sequence[DeckStep], refusals: Refusals) -> dict[str, int]:
    """Keywords without effect on the answer, each with its first line; others that are not read are refused."""
    for card in of_keyword(outside, "ELEMENT"):
        with refusals.gather():
            element_type(card)
    ignored = refuse_unsupported(bonds_apart(outside)[0], MODEL_WORDS, "outside a step", refusals)
    for step in steps:
        ignored = refuse_unsupported(step.cards, STEP_WORDS, "inside a step", refusals) | ignored
    return ignored


def _refuse_incomplete(outside: Sequence[Card], steps: Sequence[DeckStep], path: Path) -> None:
    for needed in ("NODE", "ELEMENT", "SOLID SECTION"):
        if not any(of_keyword(outside, needed)):
            raise DeckError(f"has no *{needed}; expected one", path=path)
    if not steps:
        raise DeckError("has no *STEP; expected at least one", path=path)


def _refuse_large(steps: Sequence[DeckStep], contacts: Sequence[Pair], small_strain: bool) -> None:
    """Large displacements are those of bodies that slide, roll and turn as wholes."""
    moving = bool(contacts) and all(pair.contact.slides or pair.contact.tied for pair in contacts)
    for step in steps:
        if step.nlgeom and not small_strain and not (moving and any(pair.contact.slides for pair in contacts)):
            why = "here there is no contact" if not contacts else "here pairs stay (SMALL SLIDING, bonds, gaskets)"
            raise step.card.error(
                "NLGEOM asks for large displacements, which bodies have whose contact pairs follow them, not by large "
                f"strains; {why}; --small-strain solves with small ones"
            )


def _mesh(known: Known) -> Mesh:
    """Cells family by family; their numbers and the bodies follow."""
    grid = known.grid
    families = {group.type.family for group in grid.groups}
    cells = {
        family: np.vstack([group.nodes for group in grid.groups if group.type.family == family])
        for family in NODES_PER_CELL
        if family in families
    }
    element = grid.elements_of_cells
    cell_of = np.empty(len(grid.elements.labels), np.int64)
    cell_of[element] = np.arange(len(element))
    return Mesh(
        points=grid.points[:, : grid.dimension],
        cells=cells,
        bodies={section.name: np.sort(cell_of[section.elements]) for section in known.sections},
        boundaries=known.places.boundaries,
        nodes=known.places.nodes,
        node_numbers=grid.nodes.labels,
        cell_numbers=grid.elements.labels[element],
        cell_word="element",
    )


def _thickness(section: Section, kind: Kind) -> float:
    return 1.0 if kind in WITHOUT_THICKNESS else section.thickness  # CalculiX: the angle that it cuts out


def _body(section: Section, grid: DeckGrid, usual: float, initial: Array) -> Body:
    """The body of a section, with a thickness of its own where that is not the usual one."""
    substance, thickness = section.substance, _thickness(section, grid.kind)
    elastic, alpha = substance.elastic, substance.expansion or 0.0
    assert elastic is not None
    given: dict[str, Any] = {"density": substance.density or 0.0}
    if isinstance(elastic, Orthotropic):
        given |= {"angle": section.angle, "expansion1": alpha, "expansion2": alpha, "expansion3": alpha}
    else:
        given |= {"expansion": alpha}
        if substance.flow is not None:
            law = above_initial(substance.flow.law, substance.flow.card, initial[section.nodes])
            given |= {"plastic": law}
    try:
        return Body(
            section.name,
            replace(elastic, **given),
            formulation=_formulation(section, grid),
            thickness=None if thickness == usual else thickness,
        )
    except InputError as error:
        raise substance.card.error(str(error)) from error


def _formulation(section: Section, grid: DeckGrid) -> Literal["standard", "incompatible"] | None:
    """As elements have it; of those that yield without modes the body's own, which quadratic wedges do not need."""
    if section.incompatible:
        return "incompatible"
    if section.substance.flow is None:
        return "standard"
    wedges = [group.index for group in grid.groups if group.type.family == "wedge15"]
    return "standard" if any(np.isin(index, section.elements).any() for index in wedges) else None


def _step(
    k: int, steps: Sequence[DeckStep], conditions: Conditions, changes: Mapping[str, Any], deck_increments: bool
) -> Step:
    scale = conditions.scale(k, steps)
    segments = max((len(value) for value in scale.values() if isinstance(value, tuple)), default=1)
    increments = max(1, math.ceil(steps[k].increments / segments)) if deck_increments else None
    return Step(name=steps[k].name, scale=scale, increments=increments, **changes, **conditions.switched(k))


def _title(outside: Sequence[Card]) -> str:
    for card in of_keyword(outside, "HEADING"):
        return " ".join(", ".join(row.fields) for row in card.rows())[:200]
    return ""


def _notes(
    grid: DeckGrid,
    steps: Sequence[DeckStep],
    contacts: Sequence[Pair],
    small_strain: bool,
    deck_increments: bool,
) -> list[str]:
    """How the model differs from the deck."""
    notes = list(dict.fromkeys(group.type.note for group in grid.groups if group.type.note))
    if grid.skins:
        types = ", ".join(dict.fromkeys(group.type.name for group in grid.skins))
        notes.append(f"{types}: faces and lines of the bodies, for sets and surfaces; they carry nothing")
    if any(not pair.contact.tied and not pair.contact.slides for pair in contacts):
        notes.append(_SMALL_SLIDING)
    if any(pair.contact.slides for pair in contacts):
        notes.append(_FOLLOWING_PAIRS)
    if any(pair.contact.tied and pair.card.keyword == "CONTACT PAIR" for pair in contacts):
        notes.append("surfaces of a TIED contact pair are tied exactly: a stiffness given with it is not used")
    if grid.gaskets:
        from signorini.deck.inp.gaskets import GASKET_NOTE

        notes.append(GASKET_NOTE)
    general = [pair.contact for pair in contacts if pair.card.keyword == "CONTACT"]
    if general:
        pairs = ", ".join(f"{contact.nonmortar} on {contact.mortar}" for contact in general)
        notes.append(f"*CONTACT: pairs are found by closeness ({pairs}); no part touches itself")
        if not any(contact.slides for contact in general):
            notes.append("*CONTACT: initial overlaps are removed without strain, as Abaqus does; gaps stay")
    if any(card.keyword == "VISCO" for step in steps for card in step.cards):
        notes.append("*VISCO is taken as *STATIC: no material of the deck creeps")
    if small_strain and any(step.nlgeom for step in steps):
        notes.append("NLGEOM is ignored: displacements and strains are taken as small")
    if not deck_increments and any(step.increments > 1 for step in steps):
        notes.append(_OWN_INCREMENTS.format(", ".join(step.name for step in steps if step.increments > 1)))
    if grid.nodes.shifted:
        notes.append("instances share node numbers: those of later instances are raised to be unique")
    return notes


def _overlap_notes(outside: Sequence[Card], known: Known) -> Iterator[str]:
    """A note on elements in several sections."""
    found = [known.elements.find(card.value("ELSET"), card)[1] for card in of_keyword(outside, "SOLID SECTION")]
    if len(np.unique(np.concatenate(found))) < sum(len(np.unique(members)) for members in found):
        yield "elements in several sections are of the last one, as in CalculiX; Abaqus refuses them"


def _flow_notes(sections: Sequence[Section], bodies: Sequence[Body]) -> Iterator[str]:
    """How bodies that yield differ from the deck."""
    flows = [section.substance.flow for section in sections if section.substance.flow is not None]
    if any(body.material.yields and body.formulation == "mean dilatation" for body in bodies):
        yield "elements of bodies that yield have a mean dilatation, so that they do not lock"
    yield from dict.fromkeys(note for flow in flows for note in flow.notes)


def _ignored(first: Mapping[str, int]) -> Iterator[str]:
    """A note on keywords that are left out, with the first line of each."""
    if first:
        words = ", ".join(f"*{keyword} (line {line})" for keyword, line in sorted(first.items(), key=lambda i: i[1]))
        yield f"ignored, without effect on the answer: {words}"
