# SPDX-License-Identifier: BSD-3-Clause
"""Data that holds arrays, said in a few words."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.arrays import ArrayElsewhere, stored
from signorini.doors import door

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_NAMED = 4  # of many things
_MAX_VALUE = 120  # characters of one value


class Short:
    """A dataclass, made with ``repr=False``, said in a few words: arrays by their shapes, others by their names.

    >>> @dataclasses.dataclass(repr=False)
    ... class Result(Short):
    ...     name: str
    ...     pressure: np.ndarray
    ...     parts: tuple[object, ...] = ()
    >>> Result("floor", np.ones(700), (Result("one", np.ones(2)), Result("two", np.ones(3))))
    Result(name='floor', pressure=array(700), parts=(one, two))
    """

    def __repr__(self) -> str:
        assert dataclasses.is_dataclass(self)
        parts = (f"{field.name}={_said(stored(self, field.name))}" for field in dataclasses.fields(self) if field.repr)
        return f"{type(self).__name__}({', '.join(parts)})"

    def _repr_html_(self) -> str | None:
        """A card in a notebook; None: there is none, and the words are shown."""
        found: str | None = door("card")(self)
        return found


class Drawable(Short):
    """A model: short, and drawn before it is solved."""

    def plot(self) -> Figure:
        """Draw the mesh, a colour a body, with the names of its boundaries, supports, loads and contacts."""
        figure: Figure = door("draw_model")(self)
        return figure


def _said(value: Any) -> str:
    if isinstance(value, np.ndarray | ArrayElsewhere):
        return f"array({' x '.join(map(str, value.shape))})"
    if isinstance(value, Mapping):
        return f"{{{_listed([f'{key}: {_named(own)}' for key, own in value.items()])}}}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"({_listed([_named(own) for own in value])})"
    if isinstance(value, Short):
        return _named(value)
    words = repr(value)
    return words if len(words) <= _MAX_VALUE else f"{words[:_MAX_VALUE]}..."


def _listed(words: Sequence[str]) -> str:
    left = len(words) - _NAMED
    return ", ".join([*words[:_NAMED], *(f"{left} more" for _ in range(left > 0))])


def _named(value: Any) -> str:
    """What something is called, or else what it is."""
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"{len(value)} of them"
    if not dataclasses.is_dataclass(value):
        return _said(value)
    name = getattr(value, "label", None) or getattr(value, "name", None)
    return str(name) if name else type(value).__name__
