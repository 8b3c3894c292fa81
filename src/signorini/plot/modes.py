# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of natural modes, and of the loops of a mode with the frequency and the damping that they tell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.model.model import Model
from signorini.plot.camera import best_view
from signorini.plot.field import BODIES
from signorini.plot.oblique import HOOP_WORDS, oblique
from signorini.plot.paint import body_paint, paint_skin
from signorini.plot.picture_data import CELL_OUTLINES
from signorini.plot.skin import Skin, make_skin
from signorini.plot.style import INK, PRESSURE, TRACTION, dress, entitle, frame, label
from signorini.solution.damping import JointDamping
from signorini.solution.modes import NaturalModes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SHOWN_MODES = 6  # of every state of the joints: more are too small to be seen
_DRAWN_REACH = 0.12  # of the size of the bodies: how far the largest displacement of a shape is drawn
_PANEL_WIDTH = 3.2  # inches
_MOST_TICKS = 12  # of an axis in powers of ten: more run into one another


def draw_modes(model: Model, modes: Mapping[str, NaturalModes]) -> Figure:
    """The first shapes, a row for every state of the joints, over the bodies at rest."""
    from matplotlib.figure import Figure

    count = min(_SHOWN_MODES, *(len(own) for own in modes.values()))
    canvas = _Plane(model) if model.dimension == 2 else _Solid(model)
    low, high = canvas.frame(np.concatenate([own.shapes[:count].real for own in modes.values()]))
    shape = float(np.clip((high - low)[1] / (high - low)[0], 0.2, 2.5))
    size = (_PANEL_WIDTH * count, (_PANEL_WIDTH * shape + 0.4) * len(modes) + 0.5)
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(modes), count, squeeze=False)
    for row, (joint, own) in zip(panels, modes.items(), strict=True):
        for k, axes in enumerate(row):
            frame(axes, low, high)
            axes.set_axis_off()
            label(axes, title=f"{joint}, {own.frequencies[k]:.5g}" if len(modes) > 1 else f"{own.frequencies[k]:.5g}")
            canvas.draw(axes, own.shapes[k].real)
    around = f"; {HOOP_WORDS}" if model.twists else ""
    entitle(figure, model.title, f"natural modes, cycles per time; displacements are not to scale{around}")
    return figure


def _reaching(shape: Array, size: float) -> Array:
    """A shape as large as it is drawn."""
    drawn: Array = shape * (_DRAWN_REACH * size / np.linalg.norm(shape, axis=1).max())
    return drawn


class _Plane:
    """Bodies of a plane model."""

    def __init__(self, model: Model) -> None:
        self.points = model.mesh.points
        self.size = float(np.ptp(self.points, axis=0).max())
        self.outlines = [cells[:, CELL_OUTLINES[family]] for family, cells in model.mesh.cells.items()]
        self.body = model.mesh.by_family(model.body_of_cells())

    def frame(self, shapes: Array) -> tuple[Array, Array]:
        """Corners of what shapes need."""
        moved = np.concatenate([self.points + _reaching(oblique(shape), self.size) for shape in shapes])
        edge = 0.02 * self.size
        return np.minimum(moved.min(axis=0), self.points.min(axis=0)) - edge, moved.max(axis=0) + edge

    def draw(self, axes: Axes, shape: Array) -> None:
        """Draw a shape over the bodies at rest."""
        from matplotlib.collections import PolyCollection

        moved = self.points + _reaching(oblique(shape), self.size)
        for cells, body in zip(self.outlines, self.body, strict=True):
            faces = [BODIES[i % len(BODIES)] for i in body]
            axes.add_collection(
                PolyCollection(list(self.points[cells]), facecolors="none", edgecolors="#e3e3e3", lw=0.5)
            )
            axes.add_collection(PolyCollection(list(moved[cells]), facecolors=faces, edgecolors="#7d7d7d", lw=0.4))


class _Solid:
    """Bodies in space, seen from the side that shows most of their surface."""

    def __init__(self, model: Model) -> None:
        owners = model.mesh.by_family(model.body_of_cells())
        blocks = [(family, cells, body) for (family, cells), body in zip(model.mesh.cells.items(), owners, strict=True)]
        self.skin: Skin = make_skin(model.mesh.points, blocks)
        self.size = float(np.ptp(model.mesh.points, axis=0).max())
        self.camera = best_view(self.skin.spans(self.skin.points), np.ones(len(self.skin.body)))

    def frame(self, shapes: Array) -> tuple[Array, Array]:
        """Corners of what shapes need."""
        flat = np.concatenate([self.camera.across(self._moved(shape)) for shape in shapes])
        edge = 0.02 * self.size
        return flat.min(axis=0) - edge, flat.max(axis=0) + edge

    def draw(self, axes: Axes, shape: Array) -> None:
        """Draw a shape."""
        paint_skin(axes, self.skin, self._moved(shape), self.camera, body_paint(BODIES))

    def _moved(self, shape: Array) -> Array:
        moved: Array = self.skin.points + self.skin.values(_reaching(shape, self.size))
        return moved


def draw_damping(damping: JointDamping, title: str = "") -> Figure:
    """Loops of a mode; over the amplitude its frequency, its damping ratio, and the dissipation with its exponents.

    Loops are drawn without what the stuck joint would do, which hides them.

    Parameters
    ----------
    damping : of a mode
    title : of the model
    """
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    (loops, frequency), (ratio, spent) = figure.subplots(2, 2)
    for number, loop in enumerate(damping.loops, start=1):
        beyond = loop.coordinate - loop.force / (2.0 * np.pi * damping.frequency) ** 2
        loops.plot(beyond, loop.force, color=PRESSURE, lw=1.2, alpha=0.35 + 0.65 * number / len(damping.loops))
    dress(loops, x="modal coordinate beyond that of the stuck joint, q - Q / omega^2", y="modal force Q", title="loops")
    loops.xaxis.set_major_locator(MaxNLocator(nbins=6))
    share = damping.frequencies / damping.frequency
    _over_amplitude(frequency, damping.amplitudes, share, PRESSURE, powers=False)
    frequency.set_ylim(*_around(share))
    label(frequency, y="frequency over that of the stuck joint", title="secant frequency")
    slips = bool((damping.dissipations > 0.0).all())
    _over_amplitude(ratio, damping.amplitudes, damping.ratios, TRACTION, powers=slips)
    label(ratio, y="damping ratio", title="damping")
    _over_amplitude(spent, damping.amplitudes, damping.dissipations, TRACTION, powers=slips)
    exponents = damping.exponents[np.isfinite(damping.exponents)]
    words = f", exponents {exponents.min():.2f} to {exponents.max():.2f}" if len(exponents) else ""
    label(spent, y="work that friction takes from a loop", title=f"dissipation{words}")
    entitle(figure, title, f"mode {damping.mode}, {damping.frequency:.5g} cycles per time where the joint is stuck")
    return figure


def _over_amplitude(axes: Axes, amplitudes: Array, values: Array, colour: str, *, powers: bool) -> None:
    """Values over amplitudes in powers of ten; the values too, where they go in ``powers``."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.plot(amplitudes, values, color=colour, marker="o", ms=4, lw=1.3)
    axes.set_xscale("log")
    if powers:
        axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis) if powers else (axes.xaxis,):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=_MOST_TICKS))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.tick_params(colors=INK, labelsize=9)
    axes.grid(True, color="#dddddd", linewidth=0.6)
    label(axes, x="amplitude: the largest displacement")


def _around(values: Array) -> tuple[float, float]:
    """Limits of an axis that ends at 1 above, with some room."""
    room = 0.06 * max(1.0 - float(values.min()), 1e-6)
    return float(values.min()) - room, 1.0 + room
