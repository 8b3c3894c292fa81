# SPDX-License-Identifier: BSD-3-Clause
"""A deck as it was understood, as plain data for other programs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from signorini.deck import Deck
from signorini.engine.examine import Examined
from signorini.model.conditions import Load
from signorini.model.model import Model
from signorini.model.varying import spell


def total_force(examined: Examined, load: Load) -> list[float]:
    """The force of a load at factor 1, (d,), with twist the third a torque; on a rigid body its moments follow."""
    if load.force and load.on in {body.name for body in examined.model.rigid_bodies}:
        return [part or 0.0 for part in load.force]
    space = examined.space
    return list(space.at_nodes(examined.loads[load.label] * space.arms).sum(axis=0).tolist())


def deck_data(deck: Deck, examined: Examined, notes: Sequence[str]) -> dict[str, Any]:
    """The data that ``signorini check --json`` prints.

    Parameters
    ----------
    deck : as it was read
    examined : its model, with interface, supports and loads
    notes : what looks wrong, or differs from the deck
    """
    model, mesh, interface = deck.model, deck.model.mesh, examined.interface
    components = model.components
    gaps = [interface.gap[interface.contact == i] for i in range(len(model.contacts))]
    return {
        "deck": str(deck.path),
        "title": model.title,
        "kind": model.kind,
        "thickness": model.thickness,
        "units": model.units,
        "size": {
            "nodes": len(mesh.points),
            "elements": {family: len(cells) for family, cells in mesh.cells.items()},
            "dofs": model.number_of_dofs,
            "free_dofs": int(examined.constraints.transform.shape[1]),
        },
        "bodies": [
            {
                "name": body.name,
                "material": str(body.material),
                "thickness": thickness,
                "elements": len(mesh.bodies[body.name]),
            }
            for body, thickness in zip(model.bodies, model.thicknesses, strict=True)
        ],
        "node_sets": {name: len(nodes) for name, nodes in mesh.nodes.items()},
        "surfaces": {name: sum(map(len, mesh.facets(name))) for name in mesh.boundaries},
        "supports": [
            {
                "name": support.label,
                "u": [part if isinstance(part, float | None) else spell(part) for part in support.u],
                "dofs": int((examined.constraints.owner == i).sum()),
            }
            for i, support in enumerate(model.supports)
        ],
        "loads": [
            {"name": load.label, "kind": load.kind, "total_force": total_force(examined, load)[:components]}
            for load in model.loads
        ],
        "contacts": [
            {
                "name": contact.label,
                "nonmortar": side.nonmortar,
                "mortar": side.mortar,
                "coupling": side.coupling,
                "pairs": len(gap),
                "initial_gap": [float(gap.min(initial=math.inf)), float(gap.max(initial=-math.inf))],
            }
            for contact, side, gap in zip(model.contacts, interface.sides, gaps, strict=True)
        ],
        "steps": [
            {"name": step.name, "factors": factors}
            for step, factors in zip(model.steps, model.factors()[1:], strict=True)
        ],
        "fatigue": _fatigue(model),
        "notes": list(notes),
    }


def _fatigue(model: Model) -> list[dict[str, Any]]:
    """Fatigue criteria that are asked for."""
    return [
        request.criterion.table
        | {"where": list(request.where), "steps": list(request.steps)}
        | {"distance": request.distance, "average": request.average}
        for request in model.fatigue
    ]
