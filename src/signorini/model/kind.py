# SPDX-License-Identifier: BSD-3-Clause
"""Kinds of models: how many components displacements have, what they are called, which have no thickness."""

from __future__ import annotations

from typing import Literal

Kind = Literal["plane strain", "plane stress", "axisymmetric", "axisymmetric twist", "3d"]
KINDS = ("plane strain", "plane stress", "axisymmetric", "axisymmetric twist", "3d")
TWIST: Kind = "axisymmetric twist"

_OF_CIRCUMFERENCE = "an axisymmetric model has none: forces and areas are for the circumference"
WITHOUT_THICKNESS = {"axisymmetric": _OF_CIRCUMFERENCE, TWIST: _OF_CIRCUMFERENCE, "3d": "a model in space has none"}
"""Why models of some kinds have no thickness."""

_AXES: dict[str, str] = {"axisymmetric": "rz", TWIST: "rzt", "3d": "xyz"}


def revolves(kind: str) -> bool:
    """Whether the coordinates of a kind of model are radius and height."""
    return kind in ("axisymmetric", TWIST)


def axes(kind: str) -> str:
    """Letters of the components of displacements and forces of a kind of model.

    >>> axes("plane stress"), axes("axisymmetric twist")
    ('xy', 'rzt')
    """
    return _AXES.get(kind, "xy")
