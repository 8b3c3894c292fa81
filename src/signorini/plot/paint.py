# SPDX-License-Identifier: BSD-3-Clause
"""Paint the skin of bodies: shaded patches and edges, what is nearer over what is farther."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.plot.camera import Camera
from signorini.plot.skin import Skin, piece_spans

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PATCHES_ACROSS = 80.0  # of one colour across a picture: more take longer and look the same
_MAX_HALVINGS = 3  # of the sides of a piece: 64 patches of one colour each
_LAMP = np.array([-0.40, 0.60, 0.70])  # to the right, up, towards the eye
_SHADE, _SHINE = 0.80, 1.12  # of a colour without light and in full light; beyond 1 it goes to white
_MESH_COLOUR = (0.15, 0.15, 0.15, 0.35)  # on the light colours of bodies
_CREASE_COLOUR = (0.1, 0.1, 0.1, 0.9)  # of the edges of bodies


@dataclass(frozen=True, kw_only=True, eq=False)
class Paint:
    """Colours of a skin.

    Attributes
    ----------
    values : (n,) at the points of the skin; None: the number of the body
    colours : of values, (k,) to (k, 3)
    mesh : of the edges between faces: red, green, blue and opacity
    """

    values: Array | None
    colours: Callable[[Array], Array]
    mesh: tuple[float, float, float, float]


def body_paint(colours: Sequence[str]) -> Paint:
    """A colour a body, over and over, with the edges of the mesh."""
    from matplotlib.colors import to_rgb

    palette = np.array([to_rgb(colour) for colour in colours])
    return Paint(values=None, colours=lambda body: palette[body.astype(int) % len(palette)], mesh=_MESH_COLOUR)


def paint_skin(axes: Axes, skin: Skin, points: Array, camera: Camera, paint: Paint) -> None:
    """Draw what can be seen of a skin inside the limits of the axes.

    Parameters
    ----------
    axes : whose limits are set
    skin : what is drawn
    points : of the skin, where they are drawn, (n, 3) length
    camera : from where it is seen
    paint : how it is coloured
    """
    from matplotlib.collections import PolyCollection

    seen = _seen(axes, skin, points, camera)
    view = _View(
        skin=skin.part(seen), crease=skin.sharp[seen[skin.edge_face]], points=points, camera=camera, paint=paint
    )
    fine = float(np.ptp(axes.get_xlim())) / _PATCHES_ACROSS
    parts = 2 ** np.clip(np.ceil(np.log2(np.maximum(view.size / fine, 1e-9))), 0, _MAX_HALVINGS).astype(int)
    strokes = [cut(parts == k, k) for k in np.unique(parts).tolist() for cut in (view.patches, view.edges)]
    if not strokes:
        return
    order = np.argsort(np.concatenate([part.depth for part in strokes]), kind="stable")
    width = np.concatenate([part.width for part in strokes])[order]
    axes.add_collection(
        PolyCollection(
            list(camera.across(np.concatenate([part.shapes for part in strokes])[order])),
            facecolors=np.concatenate([part.fill for part in strokes])[order],
            edgecolors=np.concatenate([part.line for part in strokes])[order],
            linewidths=width,
            antialiaseds=width > 0.0,  # patches side by side would let the background through
            capstyle="butt",
            rasterized=True,
        ),
        autolim=False,
    )


def _seen(axes: Axes, skin: Skin, points: Array, camera: Camera) -> BoolArray:
    """(f,) faces that look to the eye and reach into the limits of the axes."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    flat = camera.across(points)[skin.pieces]
    beside = (flat.max(axis=1) < [left, low]) | (flat.min(axis=1) > [right, high])
    within = np.zeros(len(skin.body), bool)
    within[skin.face[~beside.any(axis=1)]] = True
    return within & (skin.spans(points) @ camera.towards > 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Strokes:
    """Quadrangles (k, 4, 3), how near they are (k,), fill and line as colours (k, 4), width of the line (k,)."""

    shapes: Array
    depth: Array
    fill: Array
    line: Array
    width: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class _View:
    """The part of a skin that is seen, from where and in which colours; ``crease`` (e,): edges of bodies."""

    skin: Skin
    crease: BoolArray
    points: Array
    camera: Camera
    paint: Paint

    @property
    def size(self) -> Array:
        """Longest side of the pieces of every face, (f,)."""
        corners = self.points[self.skin.pieces]
        size = np.zeros(len(self.skin.body))
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        np.maximum.at(size, self.skin.face, sides)
        return size

    def patches(self, faces: BoolArray, k: int) -> _Strokes:
        """Patches of some faces, their pieces cut in k along either side."""
        own = np.flatnonzero(faces[self.skin.face])
        at = _blend(self.points[self.skin.pieces[own]], np.linspace(0.0, 1.0, k + 1))
        shapes = np.stack([at[:, :-1, :-1], at[:, 1:, :-1], at[:, 1:, 1:], at[:, :-1, 1:]], axis=3).reshape(-1, 4, 3)
        if self.paint.values is None:
            values = np.repeat(self.skin.body[self.skin.face[own]], k * k).astype(float)
        else:
            values = _blend(self.paint.values[self.skin.pieces[own]], (np.arange(k) + 0.5) / k).ravel()
        fill = np.ones((len(shapes), 4))
        fill[:, :3] = self._lit(self.paint.colours(values), shapes)
        nothing = np.zeros(len(shapes))
        depth = self.camera.depth(shapes.mean(axis=1))
        return _Strokes(shapes=shapes, depth=depth, fill=fill, line=np.zeros_like(fill), width=nothing)

    def edges(self, faces: BoolArray, k: int) -> _Strokes:
        """Edges of some faces, each cut in k, as flat quadrangles in front of the patches beside them."""
        width = np.where(self.crease, 0.9, self._mesh_width)
        own = np.flatnonzero(faces[self.skin.edge_face] & (width > 0.0))
        ends, t = self.points[self.skin.edges[own]], np.linspace(0.0, 1.0, k + 1)[:, None]
        along = ends[:, None, 0] * (1.0 - t) + ends[:, None, 1] * t
        shapes = np.stack([along[:, :-1], along[:, 1:], along[:, 1:], along[:, :-1]], axis=2).reshape(-1, 4, 3)
        reach = np.repeat(self.size[self.skin.edge_face[own]] / k, k)
        return _Strokes(
            shapes=shapes,
            depth=self.camera.depth(shapes.mean(axis=1)) + reach,
            fill=np.zeros((len(shapes), 4)),
            line=np.repeat(np.where(self.crease[own, None], _CREASE_COLOUR, self.paint.mesh), k, axis=0),
            width=np.repeat(width[own], k),
        )

    @property
    def _mesh_width(self) -> float:
        """Thinner lines where more faces are in view, none where they would cover all."""
        count = len(self.skin.body)
        return 0.5 if count < 1500 else 0.3 if count < 6000 else 0.12 if count < 20000 else 0.0

    def _lit(self, colours: Array, shapes: Array) -> Array:
        spans = piece_spans(shapes)
        unit = spans / np.maximum(np.linalg.norm(spans, axis=1, keepdims=True), 1e-300)
        light = (_LAMP / np.linalg.norm(_LAMP)) @ self.camera.axes
        bright = (_SHADE + (_SHINE - _SHADE) * np.clip(unit @ light, 0.0, 1.0))[:, None]
        return colours * np.minimum(bright, 1.0) + (1.0 - colours) * np.maximum(bright - 1.0, 0.0)


def _blend(corners: Array, at: Array) -> Array:
    """Bilinear values of pieces (m, 4, ...) at a grid of places (k,) along both sides, (m, k, k, ...)."""
    s, r = np.meshgrid(at, at, indexing="ij")
    weights = np.stack([(1.0 - s) * (1.0 - r), s * (1.0 - r), s * r, (1.0 - s) * r])
    return np.asarray(np.einsum("ma...,ast->mst...", corners, weights))
