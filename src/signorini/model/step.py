# SPDX-License-Identifier: BSD-3-Clause
"""Load histories: straight segments between load factors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from signorini.checks import choice, number, text, whole
from signorini.errors import InputError


@dataclass(frozen=True, kw_only=True)
class Step:
    """One straight segment of the load history.

    Parameters
    ----------
    name : what results call it
    scale : factors at the end of the step, by name of load or moving support; what is not named keeps its factor.
        None: everything goes to 1
    increments : equal parts in which the segment is solved; None leaves it to ``path``
    path : "increments", or "exact": from event to event (a pair closes, opens, slips, sticks), without any step size.
        None chooses: "increments" where their number is given or nothing rubs (one is exact then), otherwise "exact"

    Examples
    --------
    >>> Step(name="drag", scale={"push": 1.0}, increments=10).increments
    10
    """

    name: str = ""
    scale: Mapping[str, float] | None = None
    increments: int | None = None
    path: Literal["increments", "exact"] | None = None

    def __post_init__(self) -> None:
        if self.name:
            text(self.name, ("name",))
        if self.increments is not None:
            whole(self.increments, ("increments",))
        if self.path is not None:
            choice(self.path, ("increments", "exact"), ("path",), "path")
        if self.path == "exact" and self.increments is not None:
            raise InputError("has a number of increments, but the path is exact; expected one of both")
        if self.scale is not None:
            if not isinstance(self.scale, Mapping):
                raise InputError(f"is {self.scale!r}; expected a table of names and factors", where=("scale",))
            scale = {key: number(value, ("scale", key)) for key, value in self.scale.items()}
            object.__setattr__(self, "scale", MappingProxyType(scale))
