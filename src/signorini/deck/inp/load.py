# SPDX-License-Identifier: BSD-3-Clause
"""From an Abaqus or CalculiX deck to a model."""

from __future__ import annotations

from pathlib import Path

from signorini.deck.inp.build import Built, build
from signorini.deck.inp.card import Card
from signorini.deck.inp.flatten import flatten
from signorini.deck.inp.grid import make_grid
from signorini.deck.inp.steps import split_steps
from signorini.deck.inp.syntax import read_cards
from signorini.sources import Reach


def load_inp(path: Path, reach: Reach, *, small_strain: bool = False, deck_increments: bool = False) -> Built:
    """Read a deck of keywords.

    Parameters
    ----------
    reach : files that it may include
    small_strain : solve with small displacements what asks for large ones (NLGEOM)
    deck_increments : follow the deck's increments instead of the package's rule

    Raises
    ------
    DeckError
        With file and line, for what is wrong, or would change the answer and is not supported.
    """
    return build(flatten(read_cards(path, reach)), path, small_strain=small_strain, deck_increments=deck_increments)


def element_place(path: Path, reach: Reach, cell: int) -> Card:
    """The ``*ELEMENT`` keyword at the line of the element that a cell of the model is; reads the deck once more."""
    grid = make_grid(split_steps(flatten(read_cards(path, reach)))[0])
    return grid.at(int(grid.elements_of_cells[cell]))
