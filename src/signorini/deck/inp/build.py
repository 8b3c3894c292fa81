# SPDX-License-Identifier: BSD-3-Clause
"""A model from the keywords of a deck."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from signorini.deck.error import DeckError
from signorini.deck.inp.acting import Known
from signorini.deck.inp.amplitudes import make_amplitudes
from signorini.deck.inp.card import Card
from signorini.deck.inp.changes import make_changes
from signorini.deck.inp.conditions import Conditions, make_conditions
from signorini.deck.inp.couplings import make_couplings
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.grid import DeckGrid, make_grid
from signorini.deck.inp.interactions import make_interactions
from signorini.deck.inp.keywords import MODEL_WORDS, STEP_WORDS
from signorini.deck.inp.links import link_places, make_equations, make_rigid_bodies
from signorini.deck.inp.loading import follow_steps
from signorini.deck.inp.materials import Section, Substance, make_materials, make_sections
from signorini.deck.inp.pairs import Pair, make_contacts, make_ties
from signorini.deck.inp.places import Places
from signorini.deck.inp.prints import make_prints
from signorini.deck.inp.sets import make_sets
from signorini.deck.inp.steps import DeckStep, split_steps
from signorini.deck.inp.supported import refuse_unsupported
from signorini.deck.inp.surfaces import ElementFaces, make_surfaces
from signorini.errors import InputError, Where
from signorini.model.body import Body
from signorini.model.material import Orthotropic
from signorini.model.mesh import NODES_PER_CELL, Mesh
from signorini.model.model import Kind, Model
from signorini.model.prints import Prints
from signorini.model.step import Step

_SMALL_SLIDING = "contact is treated as small sliding: pairs are found on the undeformed bodies"
_OWN_INCREMENTS = (
    "increments of the deck are not used: {} follow the package's rule (exact path where there is friction, otherwise "
    "one increment); --increments deck takes them over"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Built:
    """A model and what a reader should know of how it was made.

    Attributes
    ----------
    model : the model
    places : keyword of every support, load, contact, body and step, by its path in the model
    notes : what differs from the deck, and what is left out
    unused_materials : names of materials that no section has
    prints : what the steps ask for
    """

    model: Model
    places: dict[Where, Card]
    notes: tuple[str, ...]
    unused_materials: tuple[str, ...]
    prints: Prints


def build(placed: list[Placed], path: object, *, small_strain: bool, deck_increments: bool) -> Built:
    """Build the model.

    Parameters
    ----------
    placed : keywords of the deck, flattened
    path : of the deck, for messages
    small_strain : solve with small displacements what asks for large ones (NLGEOM)
    deck_increments : follow the deck's increments

    Raises
    ------
    DeckError
        For anything that is wrong, or that would change the answer and is not supported.
    """
    outside, steps = split_steps(placed)
    ignored = _left_out(outside, steps)
    _refuse_incomplete(outside, steps, path)
    _refuse_large(steps, small_strain)

    grid = make_grid(outside)
    kind = _kind(grid)
    nodes, elements = make_sets(placed, grid)
    materials = make_materials(outside)
    sections = make_sections(outside, elements, materials, grid)
    edges = ElementFaces(grid)
    surfaces = make_surfaces(outside, edges, nodes, elements)
    interactions = make_interactions(outside)
    contacts = make_contacts(outside, interactions, surfaces, nodes, edges)
    contacts += make_ties(outside, surfaces, nodes, edges, contacts)
    places = Places(edges, surfaces, nodes)
    rigid = make_rigid_bodies(outside, nodes, elements, grid, places)
    rigid, equations = make_couplings(outside, rigid, nodes, surfaces, edges, grid, places)
    equations += make_equations(outside, nodes, rigid, kind)
    known = Known(
        nodes=nodes,
        elements=elements,
        surfaces=surfaces,
        edges=edges,
        sections=tuple(sections),
        amplitudes=make_amplitudes(placed),
        axisymmetric=kind == "axisymmetric",
        dimension=3 if kind == "3d" else 2,
        rigid=tuple(rigid),
    )
    courses = follow_steps(outside, steps, known)
    conditions = make_conditions(courses, places, known)
    changes = [make_changes(step, contacts, interactions, surfaces) for step in steps]
    model_steps = [_step(k, steps, conditions, changes[k], deck_increments) for k in range(len(steps))]
    where = _where(sections, contacts, conditions, steps) | link_places(rigid, equations)
    try:
        model = Model(
            _mesh(grid, sections, places),
            kind=kind,
            thickness=_thickness(sections[0], kind),
            bodies=[_body(section, _thickness(sections[0], kind), kind) for section in sections],
            supports=conditions.supports,
            loads=conditions.loads,
            contacts=[pair.contact for pair in contacts],
            rigid_bodies=[item.body for item in rigid],
            equations=[item.equation for item in equations],
            steps=model_steps,
            title=_title(outside),
        )
    except InputError as error:
        raise located(error, where, path, lambda cell: grid.at(int(grid.elements_of_cells[cell]))) from error
    return Built(
        model=model,
        places=where,
        notes=(*courses.notes, *_notes(grid, steps, contacts, ignored, small_strain, deck_increments)),
        prints=make_prints(steps, known, model.mesh, contacts),
        unused_materials=_unused(materials, sections),
    )


def located(error: InputError, places: Mapping[Where, Card], path: object, cell_at: Callable[[int], Card]) -> DeckError:
    """The error with the line of the keyword that its place in the model comes from; of a cell, that of its element."""
    if isinstance(error, DeckError):
        return error
    if error.cell is not None:
        return cell_at(error.cell).error(error.message)
    for end in range(len(error.where), 0, -1):
        card = places.get(error.where[:end])
        if card is not None:
            return card.error(error.message)
    return DeckError(error.message, path=str(path), where=error.where)


def _left_out(outside: Sequence[Placed], steps: Sequence[DeckStep]) -> dict[str, int]:
    """Keywords without effect on the answer, each with its first line; others that are not read stop."""
    ignored = refuse_unsupported(outside, MODEL_WORDS, "outside a step")
    for step in steps:
        ignored = refuse_unsupported(step.placed, STEP_WORDS, "inside a step") | ignored
    return ignored


def _refuse_incomplete(outside: Sequence[Placed], steps: Sequence[DeckStep], path: object) -> None:
    for needed in ("NODE", "ELEMENT", "SOLID SECTION"):
        if not any(item.card.keyword == needed for item in outside):
            raise DeckError(f"has no *{needed}; expected one", path=str(path))
    if not steps:
        raise DeckError("has no *STEP; expected at least one", path=str(path))


def _refuse_large(steps: Sequence[DeckStep], small_strain: bool) -> None:
    for step in steps:
        if step.nlgeom and not small_strain:
            raise step.card.error(
                "NLGEOM asks for large displacements, which are not supported; --small-strain solves with small ones"
            )


def _kind(grid: DeckGrid) -> Kind:
    first = grid.groups[0]
    assert first.type.kind is not None
    for group in grid.groups:
        if group.type.kind != first.type.kind:
            raise group.card.error(
                f"{group.card.value('TYPE')} is {group.type.kind}, but {first.card.value('TYPE')} of line "
                f"{first.card.line} {first.type.kind}; expected one of them for all elements"
            )
        if group.type.family not in NODES_PER_CELL:
            raise group.card.error(f"TYPE={group.card.value('TYPE')} is not supported")
    return first.type.kind


def _mesh(grid: DeckGrid, sections: Sequence[Section], places: Places) -> Mesh:
    """Cells family by family; their numbers and the bodies follow."""
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
        points=grid.points[:, : 3 if grid.groups[0].type.kind == "3d" else 2],
        cells=cells,
        bodies={section.name: np.sort(cell_of[section.elements]) for section in sections},
        boundaries=places.boundaries,
        nodes=places.nodes,
        node_numbers=grid.nodes.labels,
        cell_numbers=grid.elements.labels[element],
        cell_word="element",
    )


def _thickness(section: Section, kind: Kind) -> float:
    return 1.0 if kind in ("axisymmetric", "3d") else section.thickness  # CalculiX: the angle that it cuts out


def _body(section: Section, usual: float, kind: Kind) -> Body:
    """Of a section; where its thickness is not the usual one, with its own."""
    substance, thickness = section.substance, _thickness(section, kind)
    elastic, alpha = substance.elastic, substance.expansion or 0.0
    assert elastic is not None
    given: dict[str, Any] = {"density": substance.density or 0.0}
    if isinstance(elastic, Orthotropic):
        given |= {"angle": section.angle, "expansion1": alpha, "expansion2": alpha, "expansion3": alpha}
    else:
        given |= {"expansion": alpha}
    try:
        return Body(
            section.name,
            replace(elastic, **given),
            formulation="incompatible" if section.incompatible else "standard",
            thickness=None if thickness == usual else thickness,
        )
    except InputError as error:
        raise substance.card.error(str(error)) from error


def _step(
    k: int, steps: Sequence[DeckStep], conditions: Conditions, changes: Mapping[str, Any], deck_increments: bool
) -> Step:
    scale = conditions.scale(k, steps)
    segments = max((len(value) for value in scale.values() if isinstance(value, tuple)), default=1)
    increments = max(1, math.ceil(steps[k].increments / segments)) if deck_increments else None
    return Step(name=steps[k].name, scale=scale, increments=increments, **changes, **conditions.switched(k))


def _where(
    sections: Sequence[Section],
    contacts: Sequence[Pair],
    conditions: Conditions,
    steps: Sequence[DeckStep],
) -> dict[Where, Card]:
    places: dict[Where, Card] = {("body", i): section.card for i, section in enumerate(sections)}
    places |= {("contact", i): pair.card for i, pair in enumerate(contacts)}
    places |= {("support", i): conditions.cards[s.label] for i, s in enumerate(conditions.supports)}
    places |= {("load", i): conditions.cards[load.label] for i, load in enumerate(conditions.loads)}
    return places | {("step", i): step.card for i, step in enumerate(steps)}


def _unused(materials: Mapping[str, Substance], sections: Sequence[Section]) -> tuple[str, ...]:
    used = {id(section.substance) for section in sections}
    return tuple(substance.card.value("NAME") for substance in materials.values() if id(substance) not in used)


def _title(outside: Sequence[Placed]) -> str:
    for item in outside:
        if item.card.keyword == "HEADING":
            return " ".join(", ".join(row.fields) for row in item.card.rows())[:200]
    return ""


def _notes(
    grid: DeckGrid,
    steps: Sequence[DeckStep],
    contacts: Sequence[Pair],
    ignored: dict[str, int],
    small_strain: bool,
    deck_increments: bool,
) -> list[str]:
    notes = list(dict.fromkeys(group.type.note for group in grid.groups if group.type.note))
    if grid.skins:
        types = ", ".join(dict.fromkeys(group.type.name for group in grid.skins))
        notes.append(f"{types}: faces and lines of the bodies, for sets and surfaces; they carry nothing")
    if any(not pair.contact.tied for pair in contacts):
        notes.append(_SMALL_SLIDING)
    if any(pair.contact.tied and pair.card.keyword == "CONTACT PAIR" for pair in contacts):
        notes.append("surfaces of a TIED contact pair are tied exactly: a stiffness given with it is not used")
    if small_strain and any(step.nlgeom for step in steps):
        notes.append("NLGEOM is ignored: displacements and strains are taken as small")
    if not deck_increments and any(step.increments > 1 for step in steps):
        notes.append(_OWN_INCREMENTS.format(", ".join(step.name for step in steps if step.increments > 1)))
    if grid.nodes.shifted:
        notes.append("instances share node numbers: those of later instances are raised to be unique")
    if ignored:
        words = ", ".join(f"*{keyword} (line {line})" for keyword, line in sorted(ignored.items(), key=lambda i: i[1]))
        notes.append(f"ignored, without effect on the answer: {words}")
    return notes
