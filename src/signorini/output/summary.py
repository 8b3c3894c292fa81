# SPDX-License-Identifier: BSD-3-Clause
"""A solution as plain data: what ``summary.json`` holds. Other programs read it: keys are added, never changed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from signorini._version import __version__
from signorini.arrays import Array
from signorini.law.friction import FrictionLaw
from signorini.memory import peak_memory
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import PHASES, History
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult, Instant, StepResult


def summary(history: History, seconds: Mapping[str, float], deck: str = "") -> dict[str, Any]:
    """Everything but the fields, in the order in which a reader wants it.

    Parameters
    ----------
    history : solved or not; its last step may not be finished
    seconds : by phase; phases that did not happen count 0
    deck : name of the file that was run, empty where there was none
    """
    model = history.model
    return {
        "signorini": __version__,
        "deck": deck,
        "title": model.title,
        "status": history.status,
        "message": history.message,
        "goes_on": history.loaded,
        "kind": model.kind,
        "thickness": model.thickness,
        "units": model.units,
        "size": {
            "nodes": model.mesh.number_of_nodes,
            "elements": model.mesh.number_of_cells,
            "dofs": model.number_of_dofs,
            "contact_pairs": history.pairs,
        },
        "bodies": [body.name for body in model.bodies],
        "thicknesses": model.thicknesses,
        "obstacles": _shapes(model),
        "timings": {phase: float(seconds.get(phase, 0.0)) for phase in PHASES},
        "backend": history.backend,
        "peak_memory_bytes": peak_memory(),
        "well_posedness": _well_posedness(history),
        "accuracy": _accuracy(history),
        "fatigue": [_fatigue(model, result) for result in history.fatigue_results],
        "steps": [_step(model, step) for step in history.steps],
    }


def _shapes(model: Model) -> list[dict[str, Any]]:
    """Rigid obstacles of a plane model as they are given, those without a name at rest; none in space."""
    if model.dimension == 3:
        return []
    known = [(obstacle.name, obstacle.shape, obstacle.about) for obstacle in model.obstacles]
    known += [("", c.mortar, (0.0, 0.0)) for c in model.contacts if isinstance(c.mortar, Obstacle)]
    return [
        {"name": name, "shape": type(shape).__name__.lower(), "about": list(about), **asdict(shape)}
        for name, shape, about in known
    ]


def _well_posedness(history: History) -> dict[str, Any] | None:
    """Findings on other solutions, None where nobody asked."""
    found = history.wellposedness
    if found is None:
        return None
    contacts = history.model.contacts
    return {
        "friction": found.friction if math.isfinite(found.friction) else None,
        "bound": found.bound if found.bound is None or math.isfinite(found.bound) else None,
        "verdict": found.verdict,
        "words": found.words,
        "others": [[_contact(*pair) for pair in zip(contacts, other, strict=True)] for other in found.others],
    }


def _accuracy(history: History) -> dict[str, Any] | None:
    """Estimated errors, None where nobody asked."""
    found = history.accuracy
    if found is None:
        return None
    asked = found.asked
    return {
        "asked": None if asked is None else {"error": asked.error, "of": str(asked.of)},
        "met": found.met,
        "reason": found.reason,
        "pressure": found.pressure,
        "traction": found.traction,
        "energy": found.energy,
        **({} if found.value is None else {"value": found.value, "output": found.output}),
        "levels": [{key: part for key, part in asdict(level).items() if part is not None} for level in found.levels],
        "notes": list(found.notes),
    }


def _fatigue(model: Model, result: FatigueResult) -> dict[str, Any]:
    """One criterion and its worst place; null is what it does not know, and a life without end."""
    one, request = result.at_worst, result.request
    return {
        "criterion": request.criterion.table,
        "where": list(request.where),
        "steps": list(result.steps),
        "distance": request.distance,
        "average": request.average,
        "places": result.count,
        "moments": result.moments,
        "exact": result.exact,
        "worst": {
            "parameter": float(one.parameter[0]),
            "amplitude": float(one.amplitude[0]),
            "stress": float(one.stress[0]),
            "body": str(one.body[0]),
            "node": int(model.mesh.labels_of(one.node)[0]),
            "at": _list(one.points[0]),
            "plane": _list(one.plane[0]) if result.planes else None,
            "life": float(one.life[0]) if math.isfinite(one.life[0]) else None,
        },
    }


def _step(model: Model, step: StepResult) -> dict[str, Any]:
    """One step."""
    labels = model.mesh.labels
    return {
        "name": step.name,
        "load_factor": step.load_factor,
        "finished": step.finished,
        "path": step.path,
        "increments": step.increments,
        "events": len(step.events),
        "event_list": [asdict(event) | {"nodes": labels[list(event.nodes)].tolist()} for event in step.events],
        "method": ", ".join(step.methods),
        "notes": list(step.notes),
        "reactions": {name: _list(force) for name, force in step.reactions.items()},
        "obstacles": {name: _rigid(obstacle) for name, obstacle in step.obstacles.items()},
        "rigid_bodies": {name: _rigid(body) for name, body in step.rigid_bodies.items()},
        "on_the_way": [_on_the_way(instant) for instant in step.instants[:-1] if instant.motions],
        "bolts": {name: asdict(bolt) for name, bolt in step.bolts.items()},
        "strain_energy": step.strain_energy,
        "interface_energy": step.interface_energy,
        "work": step.work,
        "dissipation": float(step.dissipation),
        "released": step.released,
        "energy_defect": step.energy_defect,
        "cycles": [asdict(cycle) for cycle in step.cycles],
        "steadiness": step.steadiness,
        "certificate": asdict(step.certificate) | {"passed": step.certificate.passed},
        "contacts": [_contact(*pair) for pair in zip(model.contacts, step.contacts, strict=True)],
        "plastic": _plastic(step),
    }


def _plastic(step: StepResult) -> dict[str, Any] | None:
    """Plastic flow at the end of a step; None where no body yields."""
    found, yielding = step.plastic, step.yielding
    if found is None or yielding is None:
        return None
    return {
        "dissipation": found.dissipation,
        "back_stress_energy": found.stored,
        "max_equivalent_strain": yielding.largest,
        "max_equivalent_strain_in": yielding.body,
        "max_equivalent_strain_at": list(yielding.at),
        "share_of_volume": yielding.share,
        "first_yield": yielding.first,
    }


def _on_the_way(instant: Instant) -> dict[str, Any]:
    """Where obstacles and rigid bodies are at a load inside of a step."""
    motions = {name: _rigid(motion) for name, motion in (instant.motions or {}).items()}
    return {"load_factor": instant.load_factor, "what": instant.what, "motions": motions}


def _rigid(found: ObstacleMotion) -> dict[str, Any]:
    return {key: value if isinstance(value, float) else _list(value) for key, value in vars(found).items()}


def _contact(contact: Contact, result: ContactResult) -> dict[str, Any]:
    worst = int(result.pressure.argmax())
    return {
        "name": result.name,
        "nonmortar": result.nonmortar,
        "mortar": result.mortar,
        "coupling": result.coupling,
        "friction": _friction(contact),
        "adhesion": contact.adhesion,
        "shear_limit": contact.shear_limit,
        "normal_force": _list(result.normal_force),
        "tangential_force": _list(result.tangential_force),
        "max_pressure": float(result.pressure[worst]),
        "max_pressure_at": _list(result.points[worst]),
        "area": result.closed_area,
        "open": result.count(OPEN),
        "stick": result.count(STICK),
        "slip": result.count(SLIP),
        "max_slip": float(result.slipped.max()),
        "max_sliding": float(result.sliding.max()),
        "max_slip_amplitude": float(0.5 * result.slip_range.max()),
        "dissipation": result.dissipation,
        "wear": _wear(result),
    }


def _wear(result: ContactResult) -> dict[str, Any] | None:
    """What both sides have lost; None where they do not wear."""
    wear = result.wear
    if wear is None:
        return None
    return {
        "cycles": wear.cycles,
        "max_depth": wear.deepest[0],
        "max_depth_mortar": wear.deepest[1],
        "volume": wear.volume[0],
        "volume_mortar": wear.volume[1],
        "max_distance": float(wear.distance.max(initial=0.0)),
        "mesh_moves": wear.mesh_moves,
    }


def _friction(contact: Contact) -> Any:
    """As a deck says it, but for what a function gives."""
    if isinstance(contact.friction, FrictionLaw):
        return contact.friction.table
    return "varies" if callable(contact.friction) else contact.friction


def _list(vector: Array) -> list[float]:
    return [float(part) + 0.0 for part in vector]  # + 0.0: no "-0.0"
