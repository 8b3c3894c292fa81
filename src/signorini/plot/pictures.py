# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of results by name, and which choices each of them leaves to its reader."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from signorini.errors import InputError, one_of
from signorini.plot.accuracy import draw_accuracy
from signorini.plot.contact import draw_contacts
from signorini.plot.escape import plot_escape
from signorini.plot.fatigue import draw_fatigue
from signorini.plot.field import draw_field, draw_mesh
from signorini.plot.history import draw_history
from signorini.plot.look import Look
from signorini.plot.picture_data import PictureData
from signorini.plot.solid import draw_solid_field, draw_solid_mesh
from signorini.plot.style import literal
from signorini.plot.wear import draw_wear
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.figure import Figure

VIEW = "view"
"""The picture that PyVista renders, which `plot.view` writes."""

_MOMENT = frozenset({"step", "load"})
_FIELD = _MOMENT | {"range", "zoom", "scale"}
_NOTHING: frozenset[str] = frozenset()

PICTURES: dict[str, frozenset[str]] = {
    "contact": _MOMENT | {"range", "zoom"},
    "stress": _FIELD | {"component"},
    "displacement": _FIELD | {"component"},
    "peeq": _FIELD,
    "mesh": _MOMENT | {"zoom"},
    "history": _NOTHING,
    "wear": _NOTHING,
    "fatigue": _NOTHING,
    "accuracy": _NOTHING,
    "escape": _NOTHING,
    VIEW: _MOMENT,
}
"""Names, and what may be asked of them: see `look.Look`, and the moment that is shown."""


def check_picture(
    what: str, history: History, look: Look, moment: Mapping[str, object], results: str = "the results"
) -> None:
    """Refuse a picture that there is none of, and choices that it does not leave.

    Parameters
    ----------
    what : a name of `PICTURES`
    history : that it is drawn of
    look : what the reader asks for
    moment : step and load that the reader asks for, by name, or None
    results : what they are, in words

    Raises
    ------
    InputError
        Of what is wrong, with what is expected.
    """
    if what not in PICTURES:
        raise InputError(one_of(what, PICTURES, "picture"), where=("what",))
    for option in [*look.asked, *(name for name, value in moment.items() if value is not None)]:
        if option not in PICTURES[what]:
            others = ", ".join(name for name, options in PICTURES.items() if option in options)
            raise InputError(f"is no choice of the picture '{what}'; expected one of {others}", where=(option,))
    if what != "escape" and not history.steps:
        why = "" if history.solved else f": the run ended with '{history.status}': {history.message}"
        raise InputError(f"{results} hold no step{why}")
    if what in ("contact", "history") and not history.model.contacts:
        raise InputError(f"{results} have no contact to draw")


def picture(data: PictureData, what: str) -> Figure:
    """Draw a picture by its name, see `PICTURES`; axes have units.

    Raises
    ------
    InputError
        If it is the one that PyVista renders.
    """
    if what == VIEW:
        raise InputError("is 'view', which is rendered into a file; expected solution.view(path)", where=("what",))
    return literal(_drawn(data, what), data.units)


def _drawn(data: PictureData, what: str) -> Figure:
    if what in ("stress", "displacement", "peeq"):
        scalar = getattr(data, what)
        return draw_solid_field(data, scalar) if data.solid else draw_field(data, scalar)
    if what == "mesh":
        return draw_solid_mesh(data) if data.solid else draw_mesh(data)
    draw = {
        "contact": draw_contacts,
        "history": draw_history,
        "wear": draw_wear,
        "fatigue": draw_fatigue,
        "accuracy": draw_accuracy,
    }
    return draw[what](data) if what in draw else plot_escape(data.history)
