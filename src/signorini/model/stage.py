# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a model one after the other, with everything that earlier steps have set."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields

from signorini.model.model import Model
from signorini.model.step import Step
from signorini.model.varying import Varying


@dataclass(frozen=True, kw_only=True)
class Standing:
    """What the steps of a history have set up to some point of it; what goes on from there keeps it.

    Attributes
    ----------
    friction : contact to its coefficient or two of them, of contacts that some step has changed
    interference : contact to its overlap, of contacts that some step has changed
    inactive : contacts that are switched off
    released : supports that do not hold
    loosened : supports that did not hold in some step so far
    """

    friction: Mapping[str, float | tuple[float, float]] = field(default_factory=dict)
    interference: Mapping[str, Varying] = field(default_factory=dict)
    inactive: frozenset[str] = frozenset()
    released: frozenset[str] = frozenset()
    loosened: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True)
class Stage(Standing):
    """A step as the steps before it leave it, and what stands at its end.

    Attributes
    ----------
    number : 1, 2, ...
    step : as the user wrote it
    ends : load factors at the end of every segment, those of every cycle
    """

    number: int
    step: Step
    ends: tuple[Mapping[str, float], ...]

    @property
    def standing(self) -> Standing:
        """What stands at its end, for what goes on from there."""
        return Standing(**{part.name: getattr(self, part.name) for part in fields(Standing)})

    @property
    def name(self) -> str:
        """For messages."""
        return f"step '{self.step.name}'" if self.step.name else f"step {self.number}"

    @property
    def title(self) -> str:
        """For results."""
        return self.step.name or f"step {self.number}"


def stages(
    model: Model, *, factors: Mapping[str, float] | None = None, before: Standing | None = None
) -> Iterator[Stage]:
    """Every step of a model in order.

    Parameters
    ----------
    factors : load factors before the first step, all 0 where nothing else is said
    before : what stands before it; None where nothing has been set
    """
    now = dict.fromkeys(model.scaled_names, 0.0) | dict(factors or {})
    before = before or Standing()
    friction, interference = dict(before.friction), dict(before.interference)
    inactive, released, loosened = before.inactive, before.released, before.loosened
    for number, step in enumerate(model.steps, start=1):
        ends = step.ends(now)
        now = ends[-1]
        friction |= {name: math.inf if value == "stick" else value for name, value in step.friction.items()}
        interference |= step.interference
        inactive = (inactive | set(step.inactive)) - set(step.active)
        released = (released | set(step.release)) - {*step.hold, *step.restore}
        loosened |= released
        yield Stage(
            number=number,
            step=step,
            ends=tuple(ends),
            friction=dict(friction),
            interference=dict(interference),
            inactive=inactive,
            released=released,
            loosened=loosened,
        )
