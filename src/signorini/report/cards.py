# SPDX-License-Identifier: BSD-3-Clause
"""Cards of models and results, as notebooks show them: a short table and a small drawing."""

from __future__ import annotations

from functools import singledispatch

from signorini.model.model import Model
from signorini.output.table import spell_vector
from signorini.report.markup import said, table
from signorini.report.sketch import sketch_contact, sketch_model
from signorini.report.words import CONTACT_HEAD, certificate_rows, contact_row, load_rows, verdict
from signorini.solution.certificate import Certificate
from signorini.solution.history import History
from signorini.solution.results import ContactResult, StepResult

_MOST_ROWS = 12  # of a table in a card


@singledispatch
def card(thing: object) -> str | None:
    """HTML of a model or a result; None of everything else."""
    del thing
    return None


@card.register
def _of_model(model: Model) -> str:
    mesh = model.mesh
    rows = [
        ("mesh", f"{len(mesh.points)} nodes, {mesh.number_of_cells} {mesh.cell_word}s"),
        ("bodies", "; ".join(f"{body.name}: {body.material}" for body in model.bodies)),
        ("contacts", ", ".join(f"{contact.label}" for contact in model.contacts) or "none"),
        ("loads", ", ".join(f"{name}: {kind} {value}" for name, kind, value in load_rows(model)) or "none"),
        ("supports", ", ".join(support.label for support in model.supports) or "none"),
        ("steps", ", ".join(step.name for step in model.steps)),
        ("units", model.units),
    ]
    head = (model.title or "model", model.kind)
    return _card(table([head, *rows]), sketch_model(model))


@card.register
def _of_history(history: History) -> str:
    drawing = ""
    rows: list[tuple[str, ...]] = [("contact", *CONTACT_HEAD)]
    for step in history.steps[-1:]:
        rows += [(contact.name, *contact_row(contact)) for contact in step.contacts[:_MOST_ROWS]]
        drawing = "".join(sketch_contact(contact) for contact in step.contacts[:2])
    words = verdict(history)
    named = f"<p>{said(history.model.title or 'untitled')}: {said(words)}</p>"
    return _card(named + table(rows, numbers=range(1, len(rows[0]))), drawing or sketch_model(history.model))


@card.register
def _of_step(step: StepResult) -> str:
    rows: list[tuple[str, ...]] = [("contact", *CONTACT_HEAD)]
    rows += [(contact.name, *contact_row(contact)) for contact in step.contacts[:_MOST_ROWS]]
    reactions = [(name, spell_vector(force)) for name, force in step.reactions.items()][:_MOST_ROWS]
    held = table([("support", "reaction"), *reactions]) if reactions else ""
    return _card(f"<p>step {said(step.name)}</p>{table(rows, numbers=range(1, len(rows[0])))}{held}")


@card.register
def _of_contact(contact: ContactResult) -> str:
    rows = [(contact.name, f"{contact.nonmortar} on {contact.mortar}")]
    rows += list(zip(CONTACT_HEAD, contact_row(contact), strict=True))
    return _card(table(rows, numbers=(1,)), sketch_contact(contact))


@card.register
def _of_certificate(certificate: Certificate) -> str:
    return _card(table([("certificate", "violation", "allowed"), *certificate_rows(certificate)], numbers=(1, 2)))


def _card(*parts: str) -> str:
    inside = "".join(f"<div>{part}</div>" for part in parts if part)
    return f'<div style="display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start">{inside}</div>'
