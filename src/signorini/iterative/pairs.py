# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of contacts that multipliers are iterated on, wherever the bodies are: here, or cut among ranks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.active import active_pairs
from signorini.interface.interface import Interface
from signorini.iterative.blocks import Blocks
from signorini.iterative.pressed import IncrementLoad
from signorini.law.result import ContactAnswer

_ENDLESS_PATIENCE = 10**6  # rounds
_SPRING_RATIO = 4.0  # springs of closed pairs, of what their nodes feel: multipliers then converge by as much a round


@dataclass(frozen=True, kw_only=True, eq=False)
class IteratedPairs(ABC):
    """Pairs, and who answers for their bodies.

    Attributes
    ----------
    pairs : (a,) their numbers
    tied : (a,) those that neither slip nor open
    active, held : (n,) pairs that the law is asked of; pairs that supports hold
    stiffness : (a,) D of the springs that trial forces are made with, in all directions, force per length
    compliance : (d, a) of the interface, length per force
    rest : (a,) closure that the interface has without force, length, in series as well; None for none
    blocks : of the unknowns
    patience : rounds after which an increment is given up whose residual has not halved
    name : for reports
    """

    pairs: IntArray
    tied: BoolArray
    active: BoolArray
    held: BoolArray
    stiffness: Array
    compliance: Array
    blocks: Blocks
    patience: int = _ENDLESS_PATIENCE
    name: str = ""
    rest: Array | None = None

    @property
    def directions(self) -> int:
        """Rows a pair, d."""
        return self.blocks.size

    @abstractmethod
    def answered(self, load: IncrementLoad, free: Array, forces: Array) -> tuple[ContactAnswer, Array]:
        """Solve one increment: the answer of the pairs, tied ones too, in their own units, and (z,) displacements.

        Parameters
        ----------
        load : what presses
        free : (z,) free displacements to start from
        forces : (d, a) of the pairs, to start from
        """

    @abstractmethod
    def among(self, kept: BoolArray) -> Self:
        """Bodies with fewer pairs, those of (n,) that stay."""

    def parts_among(self, kept: BoolArray) -> dict[str, Any]:
        """What is left of the pairs where some of (n,) stay, as fields of this class."""
        own = kept[self.pairs]
        return {
            "pairs": self.pairs[own],
            "tied": self.tied[own],
            "active": self.active & kept,
            "stiffness": self.stiffness[own],
            "compliance": self.compliance[:, own],
            "rest": None if self.rest is None else self.rest[own],
        }

    def rested(self, offset: Array) -> Array:
        """(d, a) Motions of the pairs that loads do not cause, with what the interface has closed without force."""
        return offset if self.rest is None else np.concatenate([offset[:1] + self.rest, offset[1:]])

    def closing(self, compliance: Array, rest: Array) -> Self:
        """Bodies whose interface closes otherwise along its normals.

        Parameters
        ----------
        compliance, rest : (a,) length per force, and what it has closed without force, length
        """
        both = np.concatenate([compliance[None], self.compliance[1:]])
        return replace(self, compliance=both, rest=rest)


class ChosenPairs(NamedTuple):
    """Pairs of an interface that multipliers are asked for: those that the law is asked of, and ties.

    Attributes
    ----------
    pairs : (a,) their numbers
    B : (d a, z) relative displacements of them in terms of the free displacements
    active, held : (n,) as of `IteratedPairs`
    """

    pairs: IntArray
    B: sp.csr_array
    active: BoolArray
    held: BoolArray

    def data(self, interface: Interface, felt: Array) -> dict[str, Any]:
        """Fields of `IteratedPairs`.

        Parameters
        ----------
        interface : of the pairs
        felt : (a,) stiffness that they feel, force per length
        """
        return {
            "pairs": self.pairs,
            "tied": interface.tied[self.pairs],
            "active": self.active,
            "held": self.held,
            "stiffness": _SPRING_RATIO * felt,
            "compliance": interface.compliance[:, self.pairs],
        }


def chosen_pairs(B: sp.csr_array, interface: Interface, candidates: BoolArray) -> ChosenPairs:
    """Pairs that multipliers are asked for.

    Parameters
    ----------
    B : (d n, z) relative displacements of the pairs in terms of the free displacements
    interface : the pairs
    candidates : (n,) pairs that may touch
    """
    n, d = len(interface), interface.directions
    seen, moves, held, active = active_pairs(B, interface, candidates)
    pairs = np.flatnonzero(active | (interface.tied & moves.reshape(d, n).any(axis=0)))
    rows = np.concatenate([pairs + k * n for k in range(d)])
    return ChosenPairs(pairs, sp.csr_array(seen[rows]), active, held)
