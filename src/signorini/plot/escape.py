# SPDX-License-Identifier: BSD-3-Clause
"""The picture of why there is no equilibrium: the rigid motion along which bodies run away."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from signorini.errors import InputError
from signorini.plot.style import INK, PRESSURE, TRACTION
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PART = 0.12  # of the size of the model: what the motion is drawn with
_ARROWS = 12


def plot_escape(history: History) -> Figure:
    """The bodies where they are, and where the motion takes them.

    Raises
    ------
    InputError
        If the history has no such motion, or the model is one in space.
    """
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

    if history.escape is None:
        raise InputError("no body runs away in this history; there is nothing to draw")
    if history.model.dimension == 3:
        raise InputError("draws bodies of the plane; in space the message says in words how they run away")
    mesh = history.model.mesh
    points = np.asarray(mesh.points)
    size = float(np.ptp(points, axis=0).max())
    motion = _PART * size * np.asarray(history.escape)
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    axes = figure.add_subplot()
    for where, colour, alpha in ((points, PRESSURE, 0.35), (points + motion, TRACTION, 0.8)):
        for family, cells in mesh.cells.items():
            corners = cells[:, : 3 if family.startswith("triangle") else 4]
            faces = list(where[corners])
            axes.add_collection(PolyCollection(faces, facecolors="none", edgecolors=colour, lw=0.6, alpha=alpha))
    moving = np.flatnonzero(np.linalg.norm(motion, axis=1) > 1e-6 * size)
    chosen = moving[np.linspace(0, len(moving) - 1, min(_ARROWS, len(moving))).astype(int)]
    axes.quiver(*points[chosen].T, *motion[chosen].T, angles="xy", scale_units="xy", scale=1.0, color=INK, width=0.004)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_title("no equilibrium: the loads carry the bodies away", loc="left", fontsize=11, color=INK)
    return figure
