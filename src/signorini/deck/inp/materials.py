# SPDX-License-Identifier: BSD-3-Clause
"""Materials, and which elements are made of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.grid import DeckGrid, nodes_of
from signorini.deck.inp.keywords import collect, look_up, of_keyword
from signorini.deck.inp.plasticity import Flow, make_flow, with_cyclic_hardening
from signorini.deck.inp.refusals import Refusals
from signorini.deck.inp.sets import Sets, unique_label
from signorini.errors import InputError, one_of
from signorini.model.material import Elastic, Material, Orthotropic

_MATERIAL_WORDS = ("ELASTIC", "DENSITY", "EXPANSION", "PLASTIC", "CYCLIC HARDENING")
"""Keywords that belong to the ``*MATERIAL`` before them and that are read here."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Substance:
    """What a deck says of a material.

    Attributes
    ----------
    card : where it begins
    elastic : None before ``*ELASTIC``
    density : mass per volume, None if not given
    expansion : thermal, per degree, None if not given
    flow : None without ``*PLASTIC``
    """

    card: Card
    elastic: Material | None = None
    density: float | None = None
    expansion: float | None = None
    flow: Flow | None = None

    @property
    def name(self) -> str:
        """Name as the deck spells it."""
        return self.card.value("NAME")

    @property
    def feels_heat(self) -> bool:
        """Whether temperature strains it or changes how it yields."""
        return bool(self.expansion) or (self.flow is not None and self.flow.law.varies_with_heat)


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """Elements that are one body.

    Attributes
    ----------
    card : the ``*SOLID SECTION``
    name : of the body
    elements, nodes : their indices, and those of their nodes, sorted
    substance : what they are made of
    angle : of the material's axes, degrees
    thickness : out of plane, length
    incompatible : its elements have incompatible modes
    """

    card: Card
    name: str
    elements: IntArray
    nodes: IntArray
    substance: Substance
    angle: float
    thickness: float
    incompatible: bool


def make_materials(cards: Sequence[Card], refusals: Refusals) -> dict[str, Substance]:
    """Read all ``*MATERIAL`` keywords, elasticity and von Mises' law with constant moduli, by name in capitals."""
    return collect(cards, "MATERIAL", _MATERIAL_WORDS, _begun, _with, refusals)


def _begun(card: Card) -> Substance:
    card.refuse_unknown(("NAME",), ("RTOL", "SRATE FACTOR"))
    return Substance(card=card)


def _with(substance: Substance, card: Card) -> Substance:
    if card.keyword == "DENSITY":
        return replace(substance, density=_constant(card, "the density"))
    if card.keyword == "EXPANSION":
        card.refuse_unknown(("TYPE", "ZERO"))
        card.choice("TYPE", ("ISO",), "ISO")
        return replace(substance, expansion=_constant(card, "the coefficient of expansion"))
    if card.keyword == "PLASTIC":
        if substance.flow is not None:
            raise card.error(f"'{substance.name}' has another one in line {substance.flow.card.line}; expected one")
        return replace(substance, flow=make_flow(card))
    if card.keyword == "CYCLIC HARDENING":
        if substance.flow is None:
            raise card.error("stands before any *PLASTIC of its material")
        return replace(substance, flow=with_cyclic_hardening(substance.flow, card))
    card.refuse_unknown(("TYPE", "MODULI"))
    card.choice("MODULI", ("LONG TERM", "INSTANTANEOUS"), "LONG TERM")
    kind = card.choice("TYPE", ("ISO", "ISOTROPIC", "ENGINEERING CONSTANTS", "ORTHO", "ORTHOTROPIC"), "ISO")
    if kind.startswith(("ENGINEERING", "ORTHO")):
        return replace(substance, elastic=_orthotropic(card, stiffnesses=kind.startswith("ORTHO")))
    rows = [(row, row.number(0, "Young's modulus"), row.number(1, "Poisson's ratio")) for row in card.rows()]
    if not rows:
        raise card.error("has no data line; expected Young's modulus and Poisson's ratio")
    if len({row[1:] for row in rows}) > 1:
        raise rows[1][0].error("*ELASTIC: moduli that depend on temperature are not supported; expected one data line")
    row, modulus, ratio = rows[0]
    try:
        return replace(substance, elastic=Elastic(E=modulus, nu=ratio))
    except InputError as error:
        raise row.error(f"*ELASTIC: {error}") from error


_MODULI = ("E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23")
_STIFFNESSES = ("D1111", "D1122", "D2222", "D1133", "D2233", "D3333", "D1212", "D1313", "D2323")


def _orthotropic(card: Card, *, stiffnesses: bool) -> Orthotropic:
    """Nine constants in two lines: moduli and ratios, or entries of the stiffness."""
    rows, names = list(card.rows()), _STIFFNESSES if stiffnesses else _MODULI
    words = [(row, i) for row in rows for i in range(len(row.fields))]
    if len(words) not in (9, 10):
        raise card.error(f"has {len(words)} constants; expected 9: {', '.join(names)}")
    values = [row.number(i, "a constant") for row, i in words[:9]]  # a tenth is the temperature that they belong to
    if stiffnesses:
        values = _moduli(values, rows[0])
    try:
        return Orthotropic(**dict(zip(_MODULI, values, strict=True)))
    except InputError as error:
        raise rows[0].error(f"*ELASTIC: {error}") from error


def _moduli(stiffnesses: list[float], row: Row) -> list[float]:
    """The engineering constants of entries of the stiffness: those of its inverse."""
    d11, d12, d22, d13, d23, d33, *shear = stiffnesses
    try:
        C = np.linalg.inv(np.array([[d11, d12, d13], [d12, d22, d23], [d13, d23, d33]]))
    except np.linalg.LinAlgError as error:
        raise row.error("*ELASTIC: the stiffness is singular; expected that of a material") from error
    moduli = 1.0 / np.diag(C)
    return [*moduli.tolist(), *(-moduli[i] * C[i, j] for i, j in ((0, 1), (0, 2), (1, 2))), *shear]


def _constant(card: Card, what: str) -> float:
    value = card.row(what).number(0, what)
    for row in card.rows():
        if row.number(0, what) != value:
            raise card.at(row).error(f"{what} depends on temperature, which is not supported; expected one data line")
    return value


def make_sections(
    cards: Sequence[Card], grid: DeckGrid, elements: Sets, materials: Mapping[str, Substance]
) -> list[Section]:
    """Read all ``*SOLID SECTION`` keywords; of several for one element the last counts; bodies are of one formulation.

    Parameters
    ----------
    cards : of the deck, outside its steps
    grid, elements : nodes and elements, and sets of these
    materials : by name in capitals
    """
    sections: list[Section] = []
    angles = _orientations(cards)
    owner = np.full(len(grid.elements.labels), -1)
    for card in of_keyword(cards, "SOLID SECTION"):
        card.refuse_unknown(("ELSET", "MATERIAL", "ORIENTATION"), ("CONTROLS", "OFFSET"))
        substance = look_up(card, "MATERIAL", materials, "material")
        if substance.elastic is None:
            raise substance.card.error(f"'{card.value('MATERIAL')}' has no *ELASTIC")
        if substance.flow is not None and isinstance(substance.elastic, Orthotropic):
            raise substance.flow.card.error(f"'{substance.name}' is orthotropic; only isotropic materials yield here")
        name, members = elements.find(card.value("ELSET"), card)
        members = distinct(members)
        if not len(members):
            raise card.error(f"element set '{name}' is empty")
        _refuse_skins(card, name, members, grid)
        angle, thickness = _angle(card, angles), _thickness(card)
        for kind, own in _by_formulation(members, grid):
            owner[own] = len(sections)
            label = f"{name} {kind}" if kind and len(own) < len(members) else name
            section = Section(
                card=card,
                name=unique_label(label, [section.name for section in sections]),
                elements=own,
                nodes=nodes_of(grid, own),
                substance=substance,
                angle=angle,
                thickness=thickness,
                incompatible=bool(kind),
            )
            sections.append(section)
    bodies = grid.elements_of_cells
    if (owner[bodies] < 0).any():
        bare = int(bodies[owner[bodies] < 0].min())
        raise grid.at(bare).error(f"element {elements.numbering.labels[bare]} has no section; expected *SOLID SECTION")
    return list(_what_is_left(sections, owner, grid))


def _what_is_left(sections: Sequence[Section], owner: IntArray, grid: DeckGrid) -> Iterator[Section]:
    """Sections without the elements that later ones have taken, ``owner`` (elements,) by index of the section."""
    for i, section in enumerate(sections):
        own = section.elements[owner[section.elements] == i]
        if len(own) == len(section.elements):
            yield section
        elif len(own):
            yield replace(section, elements=own, nodes=nodes_of(grid, own))


def _refuse_skins(card: Card, name: str, members: IntArray, grid: DeckGrid) -> None:
    for skin in (*grid.skins, *grid.gaskets):
        if np.isin(skin.index, members).any():
            cells = grid.groups[0].type.name
            other = "*GASKET SECTION" if skin.type.gasket else "no section"
            raise card.error(f"'{name}' holds {skin.type.name} beside {cells} of the model; expected {other} for these")


def _by_formulation(members: IntArray, grid: DeckGrid) -> Iterator[tuple[str, IntArray]]:
    """Elements without and with incompatible modes, which are bodies of their own: "" or their type, and members."""
    groups = [group for group in grid.groups if group.type.incompatible]
    modes = np.isin(members, np.concatenate([np.empty(0, np.int64), *(group.index for group in groups)]))
    if not modes.all():
        yield "", members[~modes]
    if modes.any():
        yield groups[0].card.value("TYPE").upper(), members[modes]


def _orientations(cards: Sequence[Card]) -> dict[str, float]:
    """Angle of every ``*ORIENTATION`` from the x axis, degrees, by name in capitals."""
    angles: dict[str, float] = {}
    for card in of_keyword(cards, "ORIENTATION"):
        card.refuse_unknown(("NAME", "SYSTEM", "DEFINITION"))
        card.choice("SYSTEM", ("RECTANGULAR",), "RECTANGULAR")
        card.choice("DEFINITION", ("COORDINATES",), "COORDINATES")
        angles[card.value("NAME").upper()] = _axes(card)
    return angles


def _axes(card: Card) -> float:
    """Angle of the first axis, degrees, from points on it and beside it, and a turn about a local axis behind them."""
    rows = list(card.rows())
    if len(rows) not in (1, 2):
        raise card.error(f"has {len(rows)} data lines; expected points on and beside the first axis, then a rotation")
    a, b, c = (np.array([rows[0].number(3 * k + i, "a coordinate", 0.0) for i in range(3)]) for k in range(3))
    a, b = a - c, b - c
    if a[2] or b[2] or not a[0] * b[1] - a[1] * b[0] > 0.0:
        raise card.at(rows[0]).error("its axes do not lie in the plane with the third towards the reader")
    axis = rows[1].whole(0, "the local axis of the rotation", 1) if len(rows) == 2 else 3
    turn = rows[1].number(1, "the additional rotation, degrees", 0.0) if len(rows) == 2 else 0.0
    if axis != 3 and turn:
        raise card.at(rows[1]).error(f"turns by {turn:g} degrees about axis {axis}; expected axis 3, across the plane")
    return float(np.degrees(np.arctan2(a[1], a[0]))) + turn


def _angle(card: Card, angles: dict[str, float]) -> float:
    if "ORIENTATION" not in card.parameters:
        return 0.0
    name = card.value("ORIENTATION")
    if name.upper() not in angles:
        raise card.error(one_of(name.upper(), angles, "orientation"))
    return angles[name.upper()]


def _thickness(card: Card) -> float:
    for row in card.rows():
        thickness = row.number(0, "the thickness", 1.0)
        if not thickness > 0.0:
            raise row.error(f"*SOLID SECTION: the thickness is {thickness:g}; expected a number > 0")
        return thickness
    return 1.0
