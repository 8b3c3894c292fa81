# SPDX-License-Identifier: BSD-3-Clause
"""Curves of a contact at one moment: values over one coordinate along its surface."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, BoolArray
from signorini.model.contact import Contact
from signorini.plot.style import status_words
from signorini.solution.results import OPEN, ContactResult

_MAX_LEAN = 1.03  # times its extent along an axis: a surface that is longer is drawn over its arc length
_MAX_GRAPH_LENGTH = 2.0  # times its extent: a surface that is longer is no graph over that axis


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """One contact at one moment, in the order of the coordinate.

    Attributes
    ----------
    contact : its name
    place : what the coordinate is, in words, for an axis: see `place_words`
    s : (n,) increasing coordinate
    pressure, traction : (n,) force per area; traction is friction on the nonmortar body along the tangent
    hoop : (n,) friction around the axis where bodies of revolution twist; None elsewhere
    status : (n,) see `status_words`
    friction : see `coefficient`
    """

    contact: str
    place: str
    s: Array
    pressure: Array
    traction: Array
    hoop: Array | None
    status: NDArray[np.str_]
    friction: float

    @property
    def has_bound(self) -> bool:
        """Whether ``mu p`` is a bound to draw."""
        return 0.0 < self.friction < math.inf


def curve_of(law: Contact, contact: ContactResult, touching: BoolArray, axes: str) -> Curve:
    """The pairs with an area of one contact of the plane.

    Parameters
    ----------
    law, contact : as the model has it, and at the moment
    touching : (n,) pairs that touch at the end of any step, so that all steps are drawn over one coordinate
    axes : letters of the model's axes
    """
    axis, s = place_along(contact.points[contact.area > 0], touching[contact.area > 0])
    own = np.flatnonzero(contact.area > 0)[np.argsort(s, kind="stable")]
    return Curve(
        contact=contact.name,
        place=place_words(axis, contact.name, axes),
        s=np.sort(s),
        pressure=contact.pressure[own],
        traction=contact.traction[own, 0] if contact.twists else contact.traction[own],
        hoop=contact.traction[own, 1] if contact.twists else None,
        status=status_words(contact)[own],
        friction=coefficient(law),
    )


def coefficient(law: Contact) -> float:
    """Coulomb's coefficient, infinite where the contact never slips, it varies or has another bound too."""
    return law.coefficient if law.coulomb and not math.isnan(law.coefficient) else math.inf


def surface_coordinate(points: Array) -> tuple[str, Array]:
    """The axis that a surface is a graph over, the longer one first; otherwise the angle about its middle.

    Examples
    --------
    >>> surface_coordinate(np.array([[0.0, 1.0], [4.0, 1.5], [2.0, 1.1]]))
    ('x', array([0., 4., 2.]))
    """
    extent = np.ptp(points, axis=0)
    for axis in np.argsort(-extent, kind="stable"):
        along = points[np.argsort(points[:, axis], kind="stable")]
        length = np.linalg.norm(np.diff(along, axis=0), axis=1).sum()
        if length <= _MAX_GRAPH_LENGTH * np.hypot(*extent):
            return "xy"[axis], points[:, axis]
    arm = points - points.mean(axis=0)
    return "angle in degrees", np.degrees(np.arctan2(arm[:, 1], arm[:, 0]))


def place_along(points: Array, touching: BoolArray) -> tuple[str, Array]:
    """The coordinate of a picture: that of `surface_coordinate`, but arc length where the touching part leans or bends.

    "x" or "y", "arc length" from the end of a surface, or "angle in degrees" about the middle of a closed one.

    Parameters
    ----------
    points : (n, 2) length
    touching : (n,) which of them are looked at; all where none is

    Examples
    --------
    >>> place_along(np.array([[0.0, 0.0], [3.0, 4.0], [6.0, 8.0]]), np.ones(3, bool))
    ('arc length', array([ 0.,  5., 10.]))
    """
    axis, s = surface_coordinate(points)
    if axis not in ("x", "y") or len(points) < 2:
        return axis, s
    order = np.argsort(s, kind="stable")
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points[order], axis=0), axis=1))])
    here = np.flatnonzero(touching[order])
    first, last = (here[0], here[-1]) if len(here) > 1 else (0, len(s) - 1)
    if way[last] - way[first] <= _MAX_LEAN * (s[order[last]] - s[order[first]]):
        return axis, s
    along = np.empty(len(s))
    along[order] = way
    return "arc length", along


def place_words(axis: str, contact: str, axes: str) -> str:
    """The coordinate along a contact in words, for an axis.

    Parameters
    ----------
    axis, contact : the coordinate, see `place_along`, and the name of the contact
    axes : letters of the model's axes: around an axis x is the radius, r, and y the height, z

    Examples
    --------
    >>> place_words("x", "seat", "rz")
    "r along 'seat', undeformed, length"
    """
    unit = "" if axis == "angle in degrees" else ", length"
    return f"{axes['xy'.index(axis)] if axis in ('x', 'y') else axis} along '{contact}', undeformed{unit}"


def closed_range(curve: Curve) -> tuple[float, float]:
    """The part of the coordinate worth showing: where the surface is closed, and half as much again on either side."""
    closed = np.nonzero(curve.status != OPEN)[0]
    low, high = float(curve.s[0]), float(curve.s[-1])
    if not len(closed):
        return low, high
    first, last = max(closed[0] - 1, 0), min(closed[-1] + 1, len(curve.s) - 1)
    start, end = float(curve.s[first]), float(curve.s[last])
    margin, edge = 0.35 * (end - start), 0.015 * (end - start)
    return max(low - edge, start - margin), min(high + edge, end + margin)
