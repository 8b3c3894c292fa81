# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in space that a reader can turn: their skin as numbers, drawn by page.js with what every browser has.

VTK's own export is ten megabytes of script; positions in 16 bits and a shader of ten lines are as good for a skin.
"""

from __future__ import annotations

import base64
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signorini.plot.camera import best_view
from signorini.plot.field import drawn_factor
from signorini.plot.picture_data import PictureData
from signorini.report.markup import said

_MOST_PIECES = 120_000  # of a skin: about 3 MB of the page
_KEYS = "drag or arrow keys turn, + and - zoom, 0 goes back"
_STEPS = 32_000  # of a coordinate from one end to the other, in 16 bits


def scene(data: PictureData) -> str:
    """HTML of the deformed skin coloured by its von Mises stress; words where it is too large for a page."""
    import matplotlib

    skin = data.skin
    if len(skin.pieces) > _MOST_PIECES:
        return f"<p>The skin has {len(skin.pieces)} pieces, too many for a page to turn.</p>"
    points, moved = skin.points, skin.values(data.bodies.displacement)
    own, index = np.unique(skin.pieces, return_inverse=True)
    pieces = index.reshape(-1, 4)
    triangles = np.concatenate([pieces[:, [0, 1, 2]], pieces[pieces[:, 2] != pieces[:, 3]][:, [0, 2, 3]]])
    edges = np.searchsorted(own, skin.edges[skin.sharp])
    points, moved = points[own], moved[own]
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    factor = drawn_factor(size, moved)
    stress = skin.values(data.stress.values)[own]
    top = float(stress.max()) or 1.0
    colours = (255.0 * matplotlib.colormaps["viridis"](stress / top)[:, :3]).astype(np.uint8)
    camera = best_view(skin.spans(skin.points), np.ones(len(skin.body)))
    fit = 1.9 * size / float(np.linalg.norm(high - low))  # a ball around all fills the canvas
    far = float(np.abs(moved).max()) or 1.0
    numbers = {
        "points": _coded(np.rint((points - 0.5 * (low + high)) / size * _STEPS).astype("<i2")),
        "moved": _coded(np.rint(moved / far * _STEPS).astype("<i2")),
        "colours": _coded(colours),
        "triangles": _coded(triangles.astype("<u4")),
        "edges": _coded(edges.astype("<u4")),
        "scale": fit / _STEPS,
        "far": fit * far / size * factor / _STEPS,
        "view": camera.axes.ravel().round(6).tolist(),
    }
    slider = '<input class="screen" type="range" min="0" max="1" step="0.05" value="1" aria-label="displacements">'
    ramp = f'<span>von Mises stress, 0 <span class="ramp"></span> {top:.4g} {said(data.units.pressure)}</span>'
    return (
        f'<figure class="scene"><canvas width="960" height="640" tabindex="0" role="img" aria-label="{_KEYS}"></canvas>'
        f"<figcaption>{ramp}<span>displacements x {factor:g} {slider}</span>"
        f'<small class="screen">{_KEYS}</small></figcaption>'
        f'<script type="application/json">{json.dumps(numbers, separators=(",", ":"))}</script></figure>'
    )


def _coded(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
