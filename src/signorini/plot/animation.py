# SPDX-License-Identifier: BSD-3-Clause
"""A contact along its load history, as a moving picture: between events everything is linear, and drawn so."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array
from signorini.errors import InputError, one_of
from signorini.plot.contact import shade_status
from signorini.plot.curve import coefficient, place_along, place_words
from signorini.plot.style import BOUND, INK, PRESSURE, STATUS_COLOURS, TRACTION, dress, literal
from signorini.plot.units import units_of
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

_FRAMES_PER_SECOND = 12  # enough for motion to look even


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactFilm:
    """A contact at every instant of a history, its k nodes in the order of the coordinate s.

    Attributes
    ----------
    name, place : of the contact, and what s is, in words
    friction : see `coefficient`
    s : (k,)
    load : (m,) where in the history; every straight segment of the loads takes 1
    pressure, traction, slip : (m, k)
    force : (m, 1) friction along the tangent
    status : (m, k)
    steps : (m,) names
    """

    name: str
    place: str
    friction: float
    s: Array
    load: Array
    pressure: Array
    traction: Array
    slip: Array
    force: Array
    status: NDArray[np.str_]
    steps: tuple[str, ...]

    def index(self, load: float) -> int:
        """The instant that comes next at a load factor."""
        return int(np.clip(np.searchsorted(self.load, load, side="left"), 1, len(self.load) - 1))

    def at(self, load: float, values: Array) -> Array:
        """Values at a load factor, straight between instants."""
        k = self.index(load)
        length = self.load[k] - self.load[k - 1]
        t = (load - self.load[k - 1]) / length if length > 0 else 1.0
        between: Array = (1.0 - t) * values[k - 1] + t * values[k]
        return between


def film_of(history: History, contact: str | None = None) -> ContactFilm:
    """A contact at every instant, with the unloaded beginning.

    Parameters
    ----------
    contact : by name; the first where not given

    Raises
    ------
    InputError
        If nothing was solved, there is no such contact, or the model is one in space or twists.
    """
    if history.model.dimension == 3:
        raise InputError("a film shows contacts over a line; in space open solution.pvd in ParaView")
    if history.model.twists:
        raise InputError("a film shows friction along a line, not around an axis; open solution.pvd in ParaView")
    names = [result.name for result in history.last.contacts]
    if not names:
        raise InputError("the model has no contact to draw")
    if contact is not None and contact not in names:
        raise InputError(one_of(contact, names, "contact"), where=("contact",))
    i = names.index(contact) if contact is not None else 0
    found = [(step.name, instant, instant.contacts[i]) for step in history.steps for instant in step.instants]
    kinks = [0.0, *(instant.load_factor for _, instant, _ in found if instant.what == "segment")]
    loads = np.array([0.0, *(instant.load_factor for _, instant, _ in found)])
    closed = np.any([result.closed for _, _, result in found], axis=0)
    axis, s = place_along(found[0][2].points, closed)
    order = np.argsort(s, kind="stable")

    def values(key: str) -> Array:
        later = np.array([getattr(result, key)[order] for _, _, result in found])
        return np.concatenate([np.zeros_like(later[:1]), later])

    return ContactFilm(
        name=names[i],
        place=place_words(axis, names[i], history.model.axes),
        friction=coefficient(history.model.contacts[i]),
        s=s[order],
        load=np.interp(loads, kinks, np.arange(len(kinks))),
        pressure=values("pressure"),
        traction=values("traction"),
        slip=values("slip"),
        force=np.array([[0.0], *([float(result.traction @ result.area)] for _, _, result in found)]),
        status=np.array([np.full(len(s), OPEN), *(result.status[order] for _, _, result in found)]),
        steps=(found[0][0], *(step for step, _, _ in found)),
    )


def animate_path(history: History, path: Path, *, contact: str | None = None, frames: int = 100) -> None:
    """Write a GIF of a history: path, contact and frames as of :meth:`signorini.api.Solution.animate`."""
    from matplotlib.animation import FuncAnimation, PillowWriter

    film = film_of(history, contact)
    figure, draw = _scene(film, history.model.title)
    loads = np.linspace(film.load[0], film.load[-1], frames)
    pictures = FuncAnimation(figure, lambda i: draw(float(loads[i])), frames=frames, blit=False)
    literal(figure, units_of(history.model.units))
    pictures.save(str(path), writer=PillowWriter(fps=_FRAMES_PER_SECOND), dpi=72)


def _scene(film: ContactFilm, title: str) -> tuple[Figure, Callable[[float], list[Artist]]]:
    """The figure, and what draws it at a load factor."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    figure = Figure(figsize=(7.6, 6.4), layout="constrained")
    tractions, slips, forces = figure.subplots(3, gridspec_kw={"height_ratios": [3.0, 1.3, 1.0]})
    low, high = _shown(film)
    for axes in (tractions, slips):
        axes.set_xlim(low, high)
    most = 1.08 * max(film.pressure.max(), np.abs(film.traction).max(), 1e-300)
    tractions.set_ylim(-1.08 * max(np.abs(film.traction).max(), 0.05 * most, _widest(film)), most)
    sliding = 1.1 * np.abs(film.slip).max() or 1.0
    slips.set_ylim(-sliding, sliding)
    (pressure,) = tractions.plot([], [], color=PRESSURE, lw=2.0, label="pressure p")
    (traction,) = tractions.plot([], [], color=TRACTION, lw=1.8, label="friction q")
    bounds = []
    if 0.0 < film.friction < math.inf:
        bounds = [tractions.plot([], [], "--", color=BOUND, lw=0.9, alpha=0.7)[0] for _ in range(2)]
        bounds[0].set_label(f"± μ p, μ = {film.friction:g}")
    (slip,) = slips.plot([], [], color=INK, lw=1.5)
    forces.plot(film.load, film.force[:, 0], color=TRACTION, lw=1.2)
    (here,) = forces.plot([], [], "o", color=INK, ms=6)
    forces.set_xlim(film.load[0], film.load[-1])
    dress(tractions, y="pressure and friction, force per area")
    dress(slips, x=film.place, y="slip, length")
    dress(forces, x="segment of the loads", y="friction force, force")
    shown = {name: STATUS_COLOURS[name] for name in (STICK, SLIP)}
    patches = [Patch(color=colour, label=name) for name, colour in shown.items()]
    handles = [pressure, traction, *bounds[:1], *patches]
    figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=9, frameon=False)
    heading = tractions.set_title("", loc="left", fontsize=10, color=INK)
    figure.suptitle(title, fontsize=12, color=INK)
    shades: list[Artist] = []

    def draw(load: float) -> list[Artist]:
        p = film.at(load, film.pressure)
        pressure.set_data(film.s, p)
        traction.set_data(film.s, film.at(load, film.traction))
        for sign, bound in zip((1.0, -1.0), bounds, strict=False):
            bound.set_data(film.s, sign * film.friction * p)
        slip.set_data(film.s, film.at(load, film.slip))
        here.set_data([load], film.at(load, film.force))
        while shades:
            shades.pop().remove()
        k = film.index(load)
        # on the way to the next event the pairs are as the last one has left them, which the next still shows
        shades.extend(shade_status(tractions, film.s, film.status[k - 1], shown))
        heading.set_text(f"step '{film.steps[k]}'")
        return []

    return figure, draw


def _widest(film: ContactFilm) -> float:
    """The largest friction that could act."""
    return film.friction * float(film.pressure.max()) if math.isfinite(film.friction) else 0.0


def _shown(film: ContactFilm) -> tuple[float, float]:
    """The part of the coordinate where the contact is closed at some time, with a margin."""
    closed = np.flatnonzero((film.status != OPEN).any(axis=0))
    if not len(closed):
        return float(film.s[0]), float(film.s[-1])
    low, high = float(film.s[closed[0]]), float(film.s[closed[-1]])
    margin = 0.12 * (high - low) or 1.0
    return max(low - margin, float(film.s[0])), min(high + margin, float(film.s[-1]))
