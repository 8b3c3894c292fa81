# SPDX-License-Identifier: BSD-3-Clause
"""``*PRE-TENSION SECTION``: bolts, cut along a surface or given in two halves, drawn by a node of no element."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.deck.inp.card import Card
from signorini.deck.inp.grid import nodes_of
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.surfaces import FACES
from signorini.errors import InputError
from signorini.meshing.cut import HALF_ABOVE, HALF_BELOW, cut, section_normal
from signorini.meshing.halves import facets_opposite, section, section_equations
from signorini.model.links import Equation
from signorini.model.mesh import Mesh

KEYWORD = "PRE-TENSION SECTION"


@dataclass(frozen=True, kw_only=True, eq=False)
class Pretension:
    """A section of a bolt.

    Attributes
    ----------
    section : name of the boundary in the model's mesh
    node : number of the node whose first displacement is the shortening
    normal : as the deck gives it, empty where it does not
    inside : (d,) a point in the middle of the elements of the surface, length
    card : where it stands
    """

    section: str
    node: int
    normal: tuple[float, ...]
    inside: Array
    card: Card


def make_pretensions(cards: Sequence[Card], known: Known) -> list[Pretension]:
    """Read all ``*PRE-TENSION SECTION`` keywords."""
    found = []
    for card in of_keyword(cards, KEYWORD):
        if "ELEMENT" in card.parameters:
            raise card.error("ELEMENT is a beam, which is not supported; expected SURFACE")
        card.refuse_unknown(("SURFACE", "NODE"))
        surface = known.surfaces.find(card.value("SURFACE", "a surface"), card)
        nodes = known.nodes.find(card.value("NODE", "a node"), card)[1]
        if len(nodes) != 1:
            raise card.error(f"NODE is a set of {len(nodes)} nodes; expected one node")
        names = known.places.at_faces(surface.keys, surface.name)
        if len(names) != 1:
            raise card.error(f"SURFACE={surface.name} has faces of {len(names)} kinds of elements; expected one kind")
        normal: tuple[float, ...] = ()
        if card.has_data:
            row = card.row("the direction of the normal")
            normal = tuple(row.number(i, "a component of the normal", 0.0) for i in range(known.dimension))
            if not any(normal):
                raise row.error("is zero; expected the direction of the normal")
        number = int(known.grid.nodes.labels[nodes[0]])
        inside = known.grid.points[nodes_of(known.grid, surface.keys // FACES), : known.dimension].mean(axis=0)
        found.append(Pretension(section=names[0], node=number, normal=normal, inside=inside, card=card))
    return found


def cut_along(mesh: Mesh, pretensions: Sequence[Pretension]) -> Mesh:
    """The mesh cut along all sections; where one is the end of a half, what lies opposite is the other.

    Raises
    ------
    DeckError
        If one does not go through a body, or its node belongs to an element.
    """
    used = np.concatenate([cells.ravel() for cells in mesh.cells.values()])
    for one in pretensions:
        if one.node in mesh.labels[used]:
            raise one.card.error(f"NODE={one.node} belongs to an element; expected a node of its own")
        try:
            other = facets_opposite(mesh, one.section)
            mesh = _between_halves(mesh, one.section, other) if other else cut(mesh, one.section, node=False)
        except InputError as error:
            raise one.card.error(f"surface '{one.section}' {error.message}") from error
    return mesh


def _between_halves(mesh: Mesh, name: str, other: tuple[IntArray, ...]) -> Mesh:
    """The mesh with the section between a boundary, whose name it takes, and the facets opposite."""
    below, above = name + HALF_BELOW, name + HALF_ABOVE
    boundaries = {own: facets for own, facets in mesh.boundaries.items() if own != name}
    apart = replace(mesh, boundaries=boundaries | {below: mesh.boundaries[name], above: other})
    return section(apart, name, below, above, node=False)


def pretension_equations(mesh: Mesh, pretensions: Sequence[Pretension]) -> list[tuple[Equation, Card]]:
    """``u_above - u_below + d n = 0`` at every node of a section, d the displacement of its node.

    The normal goes from below to above. One that the deck gives and that points into the elements of the surface turns
    the sign of the force, as in CalculiX.

    Parameters
    ----------
    mesh : cut along them
    pretensions : the sections
    """
    found = []
    for one in pretensions:
        normal = section_normal(mesh, one.section)
        if one.normal:
            middle = mesh.points[mesh.nodes_of(one.section + HALF_BELOW)].mean(axis=0)
            side = np.sign((middle - one.inside) @ normal)  # 1 where the elements of the surface are below
            normal = side * np.array(one.normal) / np.linalg.norm(one.normal)
        equations = section_equations(mesh, one.section, one.node, normal)
        found += [(equation, one.card) for equation in equations]
    return found
