# SPDX-License-Identifier: BSD-3-Clause
"""A deck as it was understood, in words: what would be solved, and what looks wrong."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.deck import Deck
from signorini.engine.bond_company import in_increments
from signorini.engine.duplicate_check import same_loads
from signorini.engine.examine import Examined
from signorini.engine.plastic_steps import TOLERANCE as TOLERANCE_OF_FLOW
from signorini.engine.validity_notes import finer_notes, overlap_notes
from signorini.engine.ways import TOLERANCE_OF_FORCES
from signorini.fem.locking import modes_in_flow, stiffened_bodies, thin_bodies
from signorini.fem.rigid import describe_motions
from signorini.inspection.data import total_force
from signorini.inspection.notes import far_notes, held_notes, idle_notes, mesh_notes, unit_notes
from signorini.law.friction import FrictionLaw
from signorini.model.accuracy import Accuracy, Asked
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.model.varying import spell
from signorini.output.table import align, spell_vector

Rows = list[tuple[str, ...]]

_FORMULATIONS = {"incompatible": "incompatible modes", "mean dilatation": "mean dilatation"}


def deck_text(deck: Deck, examined: Examined) -> list[str]:
    """Lines on everything that the deck holds."""
    model, mesh = deck.model, deck.model.mesh
    families = ", ".join(
        f"{len(cells)} {family}{'s' if family.isalpha() else ''}" for family, cells in mesh.cells.items()
    )
    free = examined.constraints.transform.shape[1]
    lines = [
        f"{deck.path}: {model.title or 'untitled'}",
        f"{model.kind}{_thickness(model)}, units: {model.units}",
        f"{len(mesh.points)} nodes, {mesh.number_of_cells} elements ({families}), "
        f"{model.number_of_dofs} dofs, {free} of them free",
    ]
    for title, rows in (
        ("bodies", _bodies(model)),
        ("supports", _supports(examined)),
        ("foundations", _foundations(model)),
        ("loads", _loads(examined)),
        *([("obstacles", _obstacles(model))] if model.obstacles else []),
        *([("rigid bodies", _rigid_bodies(model))] if model.rigid_bodies else []),
        *([("equations", [_equations(examined)])] if model.equations else []),
        ("contacts", _contacts(examined)),
        ("steps", _steps(model)),
        *([("fatigue", _fatigue(model))] if model.fatigue else []),
    ):
        lines += ["", title, *(align(rows) if rows else ["  none"])]
    notes = all_notes(deck, examined)
    return [*lines, "", "notes", *(f"  {note}" for note in notes or ["nothing looks wrong"])]


def all_notes(deck: Deck, examined: Examined) -> list[str]:
    """Notes on what looks wrong, or differs from the deck."""
    return [
        *_notes(deck),
        *mesh_notes(deck.model),
        *unit_notes(deck.model),
        *_stiffness_notes(examined),
        *_contact_notes(examined),
        *overlap_notes(examined),
        *finer_notes(examined),
        *far_notes(examined),
        *held_notes(examined),
        *idle_notes(examined),
        *same_loads(deck.model, examined.loads),
        *_motion_notes(examined),
    ]


def _bodies(model: Model) -> Rows:
    return [
        (
            body.name,
            str(body.material),
            *([_FORMULATIONS[body.formulation]] if body.formulation in _FORMULATIONS else []),
            *([f"thickness {body.thickness:g}"] if body.thickness is not None else []),
            f"{len(model.mesh.bodies[body.name])} elements",
        )
        for body in model.bodies
    ]


def _supports(examined: Examined) -> Rows:
    rows: Rows = []
    for i, support in enumerate(examined.model.supports):
        parts = ", ".join("free" if part is None else spell(part) for part in support.u)
        held = int((examined.constraints.owner == i).sum())
        rows.append((support.label, f"u = ({parts})", f"holds {held} dofs"))
    return rows


def _foundations(model: Model) -> Rows:
    return [
        (f.label, f"normal stiffness {f.normal_stiffness:g}", f"tangential stiffness {f.tangential_stiffness:g}")
        for f in model.foundations
    ]


def _thickness(model: Model) -> str:
    if model.axisymmetric:
        return ", forces on the whole circumference"
    return f", thickness {model.thickness:g}" if model.dimension == 2 else ""


def _obstacles(model: Model) -> Rows:
    """Obstacles that move."""
    rows: Rows = []
    for obstacle in model.obstacles:
        parts = ", ".join("free" if part is None else f"{part:g}" for part in obstacle.u)
        turn = _alike(["free" if turn is None else f"{turn:g}" for turn in obstacle.rotations])
        force = spell_vector([part or 0.0 for part in obstacle.force or (0.0,) * model.dimension])
        moment = _alike([f"{moment:g}" for moment in obstacle.moments])
        way = (f"u = ({parts})", f"rotation {turn}", f"force {force}", f"moment {moment}")
        rows.append((obstacle.name, str(obstacle.shape), *way))
    return rows


def _alike(words: list[str]) -> str:
    """A vector, one word where all are the same."""
    return words[0] if len(set(words)) == 1 else f"({', '.join(words)})"


def _rigid_bodies(model: Model) -> Rows:
    return [(body.name, f"the nodes of {body.on}", f"about {spell_vector(body.point)}") for body in model.rigid_bodies]


def _equations(examined: Examined) -> tuple[str, ...]:
    given = len(examined.model.equations)
    return (f"{given} between displacements", f"{len(examined.constraints.dependent)} dofs follow from others")


def _loads(examined: Examined) -> Rows:
    totals = ((load, spell_vector(total_force(examined, load))) for load in examined.model.loads)
    return [(load.label, load.kind.replace("_", " "), f"total force {total} at factor 1") for load, total in totals]


def _contacts(examined: Examined) -> Rows:
    rows: Rows = []
    for i, contact in enumerate(examined.model.contacts):
        own = examined.interface.contact == i
        gap, points = examined.interface.gap[own], examined.model.mesh.points[examined.interface.node[own]]
        pairing = examined.interface.sides[i]
        sides = f"{pairing.nonmortar} on {pairing.mortar}"
        friction = "tied" if contact.tied else _friction(contact, points)
        if contact.closure is not None:
            friction += f", {contact.closure.words}"
        if contact.cohesion is not None:
            friction += f", {contact.cohesion.words}"
        if contact.facets:
            friction += f" on {contact.facets} facets"
        initial = f"initial gap {gap.min():.5g} to {gap.max():.5g}"
        rows.append((contact.label, sides, pairing.coupling, friction, f"{len(gap)} pairs", initial))
    return rows


def _friction(contact: Contact, points: Array) -> str:
    """Law of friction of one contact in words; ``points`` (n, d) of its pairs."""
    if isinstance(contact.friction, FrictionLaw):
        return contact.friction.words
    mu = contact.law.parameters(points)["friction"]
    limit = "" if contact.shear_limit is None else f"shear limit {contact.shear_limit:g}"
    if np.isinf(mu).all():
        return f"sticks up to {limit}" if limit else "sticks"
    low, high = mu.min(), mu.max()
    adhesion = f"adhesion {contact.adhesion:g}" if contact.adhesion else ""
    coefficient = f"friction {low:g}" if low == high else f"friction {low:g} to {high:g}"
    if isinstance(contact.friction, tuple):
        coefficient = "friction {:g} along ({:g}, {:g}, {:g}), {:g} across".format(
            contact.friction[0], *(contact.friction_axis or ()), contact.friction[1]
        )
    return ", ".join(part for part in (coefficient, adhesion, limit) if part)


def _steps(model: Model) -> Rows:
    rows: Rows = []
    for number, (step, factors) in enumerate(zip(model.steps, model.factors()[1:], strict=True), start=1):
        ends = ", ".join(f"{name} {factor:g}" for name, factor in factors.items())
        rows.append(
            (
                str(number),
                step.name,
                _stepping(step, model),
                f"ends at {ends or 'no load'}",
            )
        )
    return rows


def _fatigue(model: Model) -> Rows:
    last = model.steps[-1].name or "the last step"
    return [
        (
            request.criterion.words,
            f"on {', '.join(request.where) or 'all contacts'}",
            f"{request.average} at distance {request.distance:g}" if request.distance else "at the surface",
            f"over {', '.join(request.steps) or last}",
        )
        for request in model.fatigue
    ]


def _stepping(step: Step, model: Model) -> str:
    count = step.segments * step.repeat
    cycles = f", {step.repeat} cycles" if step.repeat > 1 else ""
    return _way(step, model) + (f" in each of {count} segments{cycles}" if count > 1 else "")


def _way(step: Step, model: Model) -> str:
    yields = model.yields
    auto = step.increments == "auto" or (yields and step.increments is None and step.path is None)
    if any(contact.cohesion for contact in model.contacts):
        exactly = step.path != "increments" and step.increments != "auto" and in_increments(model) is None
        if exactly:
            return "exact path" if step.increments in (None, 1) else f"exact path, in {step.increments} parts"
        auto = auto or (step.increments is None and step.path is None)
    if auto:
        tolerance = step.tolerance or (TOLERANCE_OF_FLOW if yields else TOLERANCE_OF_FORCES)
        return f"{'elastic to first yield, then ' * yields}increments until forces change less than {tolerance:g}"
    if step.increments is not None:
        return "1 increment" if step.increments == 1 else f"{step.increments} increments"
    if step.path is None:
        way = "exact path" if model.components == 2 else "increments to events"
        keeps = any(contact.closure is not None and contact.closure.unloading is not None for contact in model.contacts)
        return way if keeps else f"{way} where there is friction, otherwise 1 increment"
    return "exact path" if step.path == "exact" else "1 increment"


def _notes(deck: Deck) -> list[str]:
    model = deck.model
    notes = [*deck.notes]
    notes += [f"material '{name}' is not used" for name in deck.unused_materials]
    if not model.contacts:
        yields = any(body.material.yields for body in model.bodies)
        notes.append("there is no contact" if yields else "there is no contact: this is a linear problem")
    if deck.accuracy is not None:
        notes.append(_accuracy(deck.accuracy))
    if deck.modes is not None:
        about = "about the end of the steps" if deck.modes.preload else "of the bodies as they are drawn"
        notes.append(f"{deck.modes.number} natural modes {about} are asked for, which 'signorini modes' computes")
    elif not model.scaled_names and all(contact.interference == 0.0 for contact in model.contacts):
        notes.append("nothing is loaded or moved")
    return notes


def _accuracy(asked: Asked) -> str:
    """What is done about the accuracy."""
    if not isinstance(asked, Accuracy):
        return "errors are estimated on the mesh as it is"
    return f"the mesh is refined until the {asked.of} is exact to {asked.error:.3g}, up to {asked.nodes} nodes"


def _stiffness_notes(examined: Examined) -> list[str]:
    volume = [
        f"body '{name}' hardly changes its volume (Poisson's ratio above 0.45), and its standard cells are too stiff "
        "for that; take formulation = 'mean dilatation'"
        for name in stiffened_bodies(examined.model)
    ]
    volume += modes_in_flow(examined.model).values()
    return volume + [
        f"body '{name}' is at most two linear quadrilaterals thick: too stiff where it bends; take formulation = "
        "'incompatible', quadratic cells or more layers"
        for name in thin_bodies(examined.space, examined.model)
    ]


def _contact_notes(examined: Examined) -> list[str]:
    notes, interface, model = [], examined.interface, examined.model
    size = float(np.ptp(model.mesh.points, axis=0).max())
    for i, contact in enumerate(model.contacts):
        own = interface.contact == i
        gap = interface.gap[own]
        if gap.min() > 1e-9 * size:
            notes.append(f"contact '{contact.label}' is open everywhere at the start, by at least {gap.min():.4g}")
        coulomb = bool(interface.friction.bounded[own].any())
        if contact.shear_limit is not None and not interface.friction.rubs[own].any():
            notes.append(f"contact '{contact.label}' has a shear limit, but no friction that it could limit")
        if coulomb and any(step.increments == 1 for step in model.steps):
            notes.append(f"contact '{contact.label}' has friction, and a step one increment: it starts from zero slip")
    return notes


def _motion_notes(examined: Examined) -> list[str]:
    return [f"{words}: only contact can hold that" for words in describe_motions(examined.parts, examined.floating)]
