# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a model one after the other, with everything that earlier steps have set."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from signorini.model.model import Model
from signorini.model.step import Step


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A step as the steps before it leave it.

    Attributes
    ----------
    number : 1, 2, ...
    step : as the user wrote it
    ends : load factors at the end of every segment, those of every cycle
    friction : contact to its coefficient or two of them, of contacts that some step has changed
    interference : contact to its overlap at the end of the step, of contacts that some step has changed
    inactive : contacts that are switched off
    released : supports that do not hold
    """

    number: int
    step: Step
    ends: tuple[Mapping[str, float], ...]
    friction: Mapping[str, float | tuple[float, float]]
    interference: Mapping[str, float]
    inactive: frozenset[str]
    released: frozenset[str]

    @property
    def name(self) -> str:
        """For messages."""
        return f"step '{self.step.name}'" if self.step.name else f"step {self.number}"

    @property
    def title(self) -> str:
        """For results."""
        return self.step.name or f"step {self.number}"


def stages(
    model: Model,
    *,
    factors: Mapping[str, float] | None = None,
    inactive: frozenset[str] = frozenset(),
    released: frozenset[str] = frozenset(),
) -> Iterator[Stage]:
    """Every step of a model in order.

    Parameters
    ----------
    factors : load factors before the first step, all 0 where nothing else is said
    inactive : contacts that are switched off before the first step
    released : supports that do not hold before it
    """
    now = dict.fromkeys(model.scaled_names, 0.0) | dict(factors or {})
    friction: dict[str, float | tuple[float, float]] = {}
    interference: dict[str, float] = {}
    for number, step in enumerate(model.steps, start=1):
        ends = step.ends(now)
        now = ends[-1]
        friction |= {name: math.inf if value == "stick" else value for name, value in step.friction.items()}
        interference |= step.interference
        inactive = (inactive | set(step.inactive)) - set(step.active)
        released = (released | set(step.release)) - {*step.hold, *step.restore}
        yield Stage(
            number=number,
            step=step,
            ends=tuple(ends),
            friction=dict(friction),
            interference=dict(interference),
            inactive=inactive,
            released=released,
        )
