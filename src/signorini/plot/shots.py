# SPDX-License-Identifier: BSD-3-Clause
"""Panels of pictures of bodies in space: all of them from their most stressed side, and a contact from its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.plot.camera import Camera, best_view
from signorini.plot.field import MAX_WINDOW, drawn_factor
from signorini.plot.picture_data import PictureData
from signorini.plot.skin import Skin

_HALF_WINDOW = 0.85  # of the size of the contact: half of what is shown of it
_MIN_HALF_WINDOW = 0.05  # of the size of the bodies: a contact of one node is shown with what is around it
_MIN_CORNERS = 3  # nodes of the contact: a face with as many is one of it


@dataclass(frozen=True, kw_only=True, eq=False)
class Shot:
    """A panel.

    Attributes
    ----------
    title : above it
    skin : what is drawn
    camera : from where
    focus : (k,) points around which it is cut out; none: everything is shown
    contact : (f,) faces of the skin that are those of the contact
    """

    title: str
    skin: Skin
    camera: Camera
    focus: IntArray
    contact: BoolArray

    def frame(self, points: Array) -> tuple[Array, Array]:
        """Lower left and upper right corner of what is shown of points (n, 3), each (2,)."""
        flat = self.camera.across(points)
        whole = flat[self.skin.pieces].reshape(-1, 2)
        low, high = whole.min(axis=0), whole.max(axis=0)
        edge = 0.03 * (high - low).max()
        low, high = low - edge, high + edge
        if not len(self.focus):
            return low, high
        here = flat[self.focus]
        half = max(_HALF_WINDOW * float(np.ptp(here, axis=0).max()), _MIN_HALF_WINDOW * float((high - low).max()))
        middle = 0.5 * (here.min(axis=0) + here.max(axis=0))
        return np.maximum(low, middle - half), np.minimum(high, middle + half)

    def size(self, points: Array) -> float:
        """Longer side of what is shown of points (n, 3), length."""
        return float(np.ptp(self.frame(points), axis=0).max())

    def inside(self, points: Array) -> IntArray:
        """The points that are shown."""
        low, high = self.frame(points)
        seen = self.skin.part(self.skin.spans(points) @ self.camera.towards > 0.0)
        own = np.unique(seen.pieces)
        flat = self.camera.across(points[own])
        return own[((flat >= low) & (flat <= high)).all(axis=1)]


def make_shots(data: PictureData) -> list[Shot]:
    """All bodies, and a contact where that shows anything else, or the part that the reader asks for.

    See :func:`whole_shot`, :func:`contact_shot` and :func:`part_shot`.
    """
    if data.look.zoom is not None:
        return [part_shot(data)]
    whole, near = whole_shot(data), contact_shot(data)
    if near is None:
        return [whole]
    cut, size = (shot.size(shot.skin.points) for shot in (near, whole))
    everything = len(near.skin.body) == len(whole.skin.body)
    same = everything and np.array_equal(near.camera.axes, whole.camera.axes) and cut >= MAX_WINDOW * size
    return [whole] if same else [whole, near]


def whole_shot(data: PictureData) -> Shot:
    """The bodies from where most of their stress is seen."""
    skin = data.skin
    camera = best_view(skin.spans(skin.points), _stressed(data))
    nothing = np.zeros(0, np.int64)
    return Shot(title="", skin=skin, camera=camera, focus=nothing, contact=np.zeros(len(skin.body), bool))


def part_shot(data: PictureData) -> Shot:
    """What lies in the box that the reader asks for, from where most of its stress is seen.

    Raises
    ------
    InputError
        If no face of the bodies has a corner in it.
    """
    skin = data.skin
    corners = np.array(data.look.corners("x y z"))
    inside = np.all((skin.points >= corners[:, 0]) & (skin.points <= corners[:, 1]), axis=1)
    focus = np.intersect1d(np.flatnonzero(inside), skin.pieces)
    if not len(focus):
        raise InputError("holds no part of the surface of a body; expected a larger box", where=("zoom",))
    own = np.bincount(skin.face, inside[skin.pieces].any(axis=1)) > 0.0
    camera = best_view(skin.spans(skin.points), _stressed(data) * own + 1e-300)
    return Shot(title="", skin=skin.part(own), camera=camera, focus=focus, contact=np.zeros(int(own.sum()), bool))


def contact_shot(data: PictureData) -> Shot | None:
    """The nonmortar body of the contact that presses most, on its own, from its side; None where all are open."""
    skin = data.skin
    name, focus, facing = _contact(data, skin)
    if not len(focus):
        return None
    stressed = _stressed(data)
    camera = best_view(skin.spans(skin.points), facing + 1e-3 * stressed / max(float(stressed.max()), 1e-300))
    body = int(np.argmax(np.bincount(skin.body[facing])))
    own = skin.body == body
    alone = f", '{data.model.bodies[body].name}' alone" if not own.all() else ""
    below = ", seen from below" if camera.towards[2] < 0.0 else ""
    title = f"at the contact '{name}'{alone}{below}"
    return Shot(title=title, skin=skin.part(own), camera=camera, focus=focus, contact=facing[own])


def deformed(data: PictureData, shot: Shot) -> tuple[float, Array]:
    """The factor of displacements in a shot, and the points of the skin there, (n, 3)."""
    skin = data.skin
    moved = skin.values(data.bodies.displacement)
    factor = drawn_factor(shot.size(skin.points), moved, data.look)
    return factor, skin.points + factor * moved


def _stressed(data: PictureData) -> Array:
    """Mean square of the stress on every face, (f,)."""
    skin = data.skin
    square = skin.values(data.bodies.von_mises) ** 2
    total = np.bincount(skin.face, weights=square[skin.pieces].mean(axis=1))
    return np.asarray(total / np.bincount(skin.face))


def _contact(data: PictureData, skin: Skin) -> tuple[str, IntArray, BoolArray]:
    """Name of the contact that presses most, its closed points, and which faces are its own, (f,)."""
    touching = [contact for contact in data.contacts if contact.closed.any()]
    if not touching:
        return "", np.zeros(0, np.int64), np.zeros(len(skin.body), bool)
    contact = max(touching, key=lambda contact: contact.pressure[contact.closed].max())
    every = np.zeros(len(skin.points), bool)
    every[: len(data.bodies.points)] = data.points_of(contact, np.ones(len(contact.node), bool))
    corners = np.bincount(skin.edge_face, weights=every[skin.edges[:, 0]], minlength=len(skin.body))
    faces = corners >= _MIN_CORNERS
    closed = np.flatnonzero(data.points_of(contact, contact.closed))
    return contact.name, np.intersect1d(closed, skin.pieces[faces[skin.face]]), faces
