# SPDX-License-Identifier: BSD-3-Clause
"""Fields of bodies as colours show them: components of stress and displacement, and the colours of a range."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError, one_of
from signorini.model.kind import revolves
from signorini.output.fields import BodyFields

_ONE_SIGN_TOL = 1e-6  # of the largest value: a field that is negative by less has one sign


class Scalar(NamedTuple):
    """A field of the bodies as colours show it.

    Attributes
    ----------
    values : (points,)
    words : what it is, with a place for where
    """

    values: Array
    words: str


class Colours(NamedTuple):
    """The range that colours stand for, and the name of their map."""

    low: float
    high: float
    map: str


def colours_of(values: Array, asked: Sequence[float] | None) -> Colours:
    """Colours of values (n,): from zero where they have one sign, otherwise symmetric about it.

    Parameters
    ----------
    values : that are shown
    asked : smallest and largest value instead

    Examples
    --------
    >>> colours_of(np.array([0.0, 2.0]), None), colours_of(np.array([-1.0, 2.0]), None).low
    (Colours(low=0.0, high=2.0, map='viridis'), -2.0)
    """
    low, high = (float(values.min(initial=0.0)), float(values.max(initial=0.0))) if asked is None else asked
    two_signs = -low > _ONE_SIGN_TOL * high > 0.0 and high > -_ONE_SIGN_TOL * low
    if asked is None:
        size = max(-low, high) or 1.0
        low, high = (-size, size) if two_signs else (0.0, size) if high >= -low else (-size, 0.0)
    return Colours(low, high, "RdBu_r" if two_signs else "viridis" if high > -low else "viridis_r")


def stress_component(fields: BodyFields, kind: str, name: str | None) -> Scalar:
    """A component of the stress: "von_mises", "principal" (the largest), "least_principal", or two of x, y and z.

    Parameters
    ----------
    fields : of the bodies
    kind : of the model: around an axis directions are r, z and t
    name : None: "von_mises"

    Raises
    ------
    InputError
        If there is no such component; the known ones are listed.
    """
    letters = "rzt" if revolves(kind) else "xyz"
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))  # in the order of `BodyFields.stress`
    known: dict[str, Callable[[], Array]] = {
        "von_mises": lambda: fields.von_mises,
        "principal": lambda: fields.principal_stress[:, 0],
        "least_principal": lambda: fields.principal_stress[:, 2],
    }
    for number, (i, j) in enumerate(pairs):
        known[letters[i] + letters[j]] = lambda number=number: fields.stress[:, number]  # type: ignore[misc]
    words = {
        "von_mises": "von Mises stress",
        "principal": "largest principal stress",
        "least_principal": "smallest principal stress",
    }
    found = _known(known, name or "von_mises", "stress")
    return Scalar(found(), f"{words.get(name or 'von_mises', f'stress {name}')}{{}}, force per area")


def displacement_component(fields: BodyFields, axes: str, name: str | None) -> Scalar:
    """A component of the displacement by its letter, or its "magnitude".

    Parameters
    ----------
    fields : of the bodies
    axes : letters of the components
    name : None: "magnitude"

    Raises
    ------
    InputError
        If there is no such component; the known ones are listed.
    """
    known: dict[str, Callable[[], Array]] = {"magnitude": lambda: np.linalg.norm(fields.displacement, axis=1)}
    for number, letter in enumerate(axes):
        known[letter] = lambda number=number: fields.displacement[:, number]  # type: ignore[misc]
    found = _known(known, name or "magnitude", "displacement")
    words = f" along {name}" if name in [*axes] else ""
    return Scalar(found(), f"displacement{words}{{}}, length")


def _known(known: Mapping[str, Callable[[], Array]], name: str, of: str) -> Callable[[], Array]:
    if name not in known:
        raise InputError(one_of(name, known, f"component of the {of}"), where=("component",))
    return known[name]
