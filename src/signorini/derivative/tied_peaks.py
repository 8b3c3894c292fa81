# SPDX-License-Identifier: BSD-3-Clause
"""Largest pressures that several nodes have alike: with what is varied one of them grows most, and falls least."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.derivative.view import HistoryView
from signorini.model.outputs import AtNode, Output, Peak, WeightedSum

_ALIKE = 1e-10  # of the largest pressure: those that are as large


@dataclass(frozen=True, kw_only=True)
class TiedPeak:
    """A largest pressure in an output that several nodes have.

    Attributes
    ----------
    factor : of the largest pressure in the output
    others : of pressures at other nodes that are as large: by how much they are larger
    words : where they are
    """

    factor: float
    others: tuple[WeightedSum, ...]
    words: str

    @property
    def together(self) -> WeightedSum:
        """One sum of all of them, of random weights: what changes none of them changes it no more."""
        share = np.random.default_rng(0).uniform(0.5, 1.5, len(self.others))
        parts = [(float(a) * b, part) for a, other in zip(share, self.others, strict=True) for b, part in other.parts]
        return WeightedSum(parts=tuple(parts))


def tied_peaks(output: Output, view: HistoryView) -> list[TiedPeak]:
    """Largest pressures in an output that several nodes have alike."""
    found = []
    for factor, part in output.parts if isinstance(output, WeightedSum) else ((1.0, output),):
        if isinstance(part, Peak):
            first, *others = peak_nodes(part, view)
            if others:
                more = tuple(WeightedSum(parts=((1.0, other), (-1.0, first))) for other in others)
                found.append(TiedPeak(factor=factor, others=more, words=tied_words(view, first, others[0])))
    return found


def at_peaks(output: Output, view: HistoryView) -> Output:
    """An output with its largest pressures at the nodes that have them, also where what is varied moves these."""
    if isinstance(output, WeightedSum):
        return WeightedSum(parts=tuple((factor, at_peaks(part, view)) for factor, part in output.parts))
    return peak_nodes(output, view)[0] if isinstance(output, Peak) else output


def tied_words(view: HistoryView, one: AtNode, other: AtNode) -> str:
    """Where a largest pressure is that two nodes have, in the order of the mesh: rounding decides which is larger.

    Parameters
    ----------
    view : the history
    one, other : of the nodes
    """
    labels = " and ".join(str(view.model.mesh.labels[node]) for node in sorted((one.node, other.node)))
    return f"nodes {labels} of '{one.contact}' have the largest pressure alike"


def peak_nodes(output: Peak, view: HistoryView) -> list[AtNode]:
    """The pressures at all nodes that have the largest one, that which `value` takes first."""
    own, i = np.flatnonzero(view.pairs(output.contact)), view.number(output.load_factor)
    pressure = (view.forces(i)[0] / view.interface.area)[own]
    alike = np.flatnonzero(pressure >= (1.0 - _ALIKE) * pressure.max())
    order = own[alike[np.argsort(alike != pressure.argmax(), kind="stable")]]
    return [
        AtNode(field="pressure", contact=output.contact, node=int(node), load_factor=output.load_factor)
        for node in view.interface.node[order]
    ]
