# SPDX-License-Identifier: BSD-3-Clause
"""The report of a history: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from string import Template

from signorini._version import __version__
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.fields import Fields
from signorini.output.table import accuracy_lines, history_table, spell_vector
from signorini.plot.accuracy import draw_accuracy
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.field import draw_field
from signorini.plot.picture_data import PictureData
from signorini.plot.solid import draw_solid_field
from signorini.plot.style import literal
from signorini.plot.units import Units
from signorini.report.charts import chart
from signorini.report.contact_map import contact_maps
from signorini.report.curves import forces, hysteresis, profiles, reactions
from signorini.report.markup import listed, said, table
from signorini.report.scene import scene
from signorini.report.sensitivities import sensitivities_section
from signorini.report.sketch import sketch_model
from signorini.report.words import (
    CONTACT_HEAD,
    MEANINGS,
    certificate_rows,
    contact_row,
    contact_words,
    further_words,
    load_rows,
    material_words,
    support_words,
    verdict,
)
from signorini.solution.accuracy import AccuracyResult
from signorini.solution.history import PHASES, History
from signorini.solution.sensitivities import Sensitivities

_MOST_EVENTS = 200  # in the list of a page; history.csv has all
_MOST_STEPS = 30  # of which there are tables
_DEFECT = (
    "The energy defect is work less what is stored, dissipated and released: rounding on exact paths, and the error of "
    "a trapezoidal rule in increments, which vanishes with their number."
)
_MEASURED = (
    "These numbers were measured on the displacements and forces that are reported here, on the problem as it was "
    "posed, and by nothing of the solver that found them. Forces are relative to the largest load of the history, "
    "lengths to the displacement that goes with it. An answer with a number beyond what is allowed is not returned as "
    "a solution. They say nothing of how fine the mesh is, nor whether the model is the right one."
)


def write_report(
    history: History, path: Path, fields: Fields | None = None, sensitivities: Sensitivities | None = None
) -> None:
    """Write the report of a history into one HTML file.

    Parameters
    ----------
    history : finished or not
    path : of the file, ``*.html``
    fields : of its model, where there are any already
    sensitivities : of its answers, where they were asked for

    Raises
    ------
    InputError
        If the name ends otherwise.
    """
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"is '{path}'; expected a name that ends in .html", where=("path",))
    with atomic_write(path) as aside:
        Path(aside).write_text(report(history, fields, sensitivities), encoding="utf-8")


def report(history: History, fields: Fields | None = None, sensitivities: Sensitivities | None = None) -> str:
    """The HTML of a report.

    Parameters
    ----------
    history, fields, sensitivities : as of `write_report`
    """
    model, title = history.model, history.model.title or "untitled"
    sections = dict(_sections(history, fields))
    if sensitivities is not None:
        sections["Sensitivities"] = sensitivities_section(sensitivities)
    anchors = [(name, name.lower().replace(" ", "-")) for name in sections]
    body = "".join(f'<section id="{anchor}"><h2>{name}</h2>{sections[name]}</section>' for name, anchor in anchors)
    mesh = model.mesh
    asset = resources.files("signorini.report")
    page, style, script = (asset.joinpath(f"page.{kind}").read_text(encoding="utf-8") for kind in ("html", "css", "js"))
    return Template(page).substitute(
        title=said(title),
        style=style,
        state="verdict" if history.solved else "verdict failed",
        verdict=said(verdict(history)),
        kind=said(model.kind),
        size=said(f"{len(mesh.points)} nodes, {mesh.number_of_cells} {mesh.cell_word}s, {history.pairs} contact pairs"),
        units=said(model.units),
        links=listed([f'<a href="#{anchor}">{name}</a>' for name, anchor in anchors]),
        body=body,
        version=said(__version__),
        backend=said(history.backend),
        script=script,
    )


def _sections(history: History, fields: Fields | None) -> Iterator[tuple[str, str]]:
    """Heading and HTML of every part that has anything to say."""
    yield "Problem", _problem(history.model)
    if not history.steps:
        if history.escape is not None:
            yield (
                "Escape",
                _picture(plot_escape(history), "the motion along which the loads carry the bodies away", Units()),
            )
        return
    data = PictureData(history, fields)
    yield "Results", _results(history)
    yield "Certificate", _certificate(history)
    if history.accuracy is not None:
        yield "Accuracy", _accuracy(data, history.accuracy)
    if notes := list(dict.fromkeys(note for step in history.steps for note in step.notes)):
        yield "Notes", listed([said(note) for note in notes])
    along = [] if data.solid else list(profiles(data))
    if along:
        yield "Contacts", "".join(map(chart, along))
    elif data.model.contacts:
        still = _picture(draw_contacts(data), "pressure, status and friction of the contacts", data.units)
        yield "Contacts", "".join(contact_maps(data)) + still
    if over := [*forces(data), *hysteresis(data), *reactions(data)]:
        yield "History", "".join(map(chart, over))
    drawn = draw_solid_field(data, data.stress) if data.solid else draw_field(data, data.stress)
    yield (
        "Bodies",
        (scene(data) if data.solid else "") + _picture(drawn, "von Mises stress after the last step", data.units),
    )
    if events := _events(history):
        yield "Events", events
    yield "Time", _time(history)


def _accuracy(data: PictureData, found: AccuracyResult) -> str:
    """Estimated errors in words, the meshes that were tried, and where the errors are."""
    levels = [
        (
            f"{level.nodes}",
            f"{level.pairs}",
            *(f"{error:.2%}" for error in (level.pressure, level.traction, level.energy)),
            *(() if found.value is None else ("-" if level.output is None else f"{level.output:.2%}",)),
        )
        for level in found.levels
    ]
    output = () if found.value is None or found.asked is None else (str(found.asked.of),)
    head = ("nodes", "pairs that touch", "pressure", "with friction", "stresses", *output)
    meshes = table([head, *levels], caption="Meshes that were tried, with their estimated errors") if levels else ""
    picture = _picture(draw_accuracy(data), "shares of the elements in the error of the stresses", data.units)
    return listed([said(line) for line in accuracy_lines(found)]) + meshes + picture


def _problem(model: Model) -> str:
    tables = [
        table([("body", "material", "elements"), *material_words(model)], caption="Bodies"),
        table([("support", "displacement"), *support_words(model)], caption="Supports") if model.supports else "",
        table([("load", "kind", "value at factor 1"), *load_rows(model)], caption="Loads") if model.loads else "",
        table([("contact", "sides", "friction"), *contact_words(model)], caption="Contacts") if model.contacts else "",
        table([("further", "what"), *further_words(model)], caption="Further") if further_words(model) else "",
    ]
    ends = [
        (step.name, ", ".join(f"{name} {factor:g}" for name, factor in factors.items()) or "no load")
        for step, factors in zip(model.steps, model.factors()[1:], strict=True)
    ]
    tables.append(table([("step", "load factors at its end"), *ends[:_MOST_STEPS]], caption="Steps"))
    return f'<div class="side"><div>{sketch_model(model)}</div><div>{"".join(tables)}</div></div>'


def _results(history: History) -> str:
    rows, held, left = [], [], max(0, len(history.steps) - _MOST_STEPS)
    for number, step in enumerate(history.steps[left:], start=left + 1):
        when = f"{number} {step.name}" + ("" if step.finished else ", not finished")
        rows += [(when, contact.name, *contact_row(contact)) for contact in step.contacts]
        noise = 1e-12 * float(abs(step.external).sum())
        held += [(when, name, spell_vector(force, noise)) for name, force in step.reactions.items()]
    parts = [
        table([("step", "contact", *CONTACT_HEAD), *rows], numbers=range(4, 10), caption="Contacts") if rows else "",
        table([("step", "support", "reaction on the bodies"), *held], caption="Reactions") if held else "",
    ]
    more = f"<p>The first {left} steps are in history.csv.</p>" if left else ""
    whole = (
        f"<details><summary>the table of the command line</summary><pre>{said(history_table(history))}</pre></details>"
    )
    return more + "".join(parts) + whole


def _certificate(history: History) -> str:
    worst = max((step.certificate for step in history.steps), key=lambda found: found.worst)
    rows = [(*row, MEANINGS[row[0]]) for row in certificate_rows(worst)]
    defects = [
        (step.name, f"{step.work:.5g}", f"{step.energy_defect:.2e}", step.path) for step in history.steps[-_MOST_STEPS:]
    ]
    head = ("step", "work", "energy defect", "way")
    energy = table([head, *defects], numbers=(1, 2)) + f"<p>{_DEFECT}</p>"
    head = ("number", "worst of all steps", "allowed", "what it is")
    return f"<p>{_MEASURED}</p>{table([head, *rows], numbers=(1, 2))}{energy}"


def _events(history: History) -> str:
    """Where pairs change their state, of exact paths."""
    labels = history.model.mesh.labels
    events = [event for step in history.steps for event in step.events]
    if not events:
        return ""
    rows = [
        (
            f"{event.load_factor:.6g}",
            event.contact,
            event.what,
            ", ".join(str(labels[node]) for node in event.nodes[:8]),
        )
        for event in events[:_MOST_EVENTS]
    ]
    more = f"<p>The first {_MOST_EVENTS} of {len(events)}.</p>" if len(events) > _MOST_EVENTS else ""
    listing = table([("load factor", "contact", "what", "nodes"), *rows], numbers=(0,))
    return f"{more}<details><summary>{len(events)} events</summary>{listing}</details>"


def _time(history: History) -> str:
    rows = [(phase, f"{history.timings[phase]:.3g}") for phase in PHASES if phase in history.timings]
    return table([("phase", "seconds"), *rows], numbers=(1,))


def _picture(figure: object, words: str, units: Units) -> str:
    """A figure of Matplotlib inside the page."""
    from matplotlib.figure import Figure

    assert isinstance(figure, Figure)
    held = io.BytesIO()
    literal(figure, units).savefig(held, format="png", dpi=110)
    coded = base64.b64encode(held.getvalue()).decode("ascii")
    return f'<figure><img alt="{said(words)}" src="data:image/png;base64,{coded}"></figure>'
