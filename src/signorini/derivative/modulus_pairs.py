# SPDX-License-Identifier: BSD-3-Clause
"""How pairs see the bodies otherwise as the modulus of one grows: normals of tilted sides lie nearer to it then."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from signorini.derivative.body_side import pairs_at
from signorini.derivative.pair_change import PairChange
from signorini.engine.prepare import Prepared
from signorini.model.model import Model

_STEP = 1e-4  # of a modulus: normals of tilted sides are smooth in it, differences right to a part in 1e8


class ModulusPairs:
    """What every modulus of a model changes of its pairs, each found when it is asked for, and kept.

    Normals know ratios of moduli alone. Of two bodies, what one modulus does the other one does the other way, so that
    sides are paired anew for one of both.

    Parameters
    ----------
    prepared : the model
    """

    def __init__(self, prepared: Prepared) -> None:
        self._prepared = prepared
        self._found: dict[int, PairChange] = {}

    def step(self, body: int) -> float:
        """Half of what the modulus of a body differs by between both sides."""
        return _STEP * self._prepared.model.bodies[body].material.smallest_modulus

    def models(self, body: int) -> tuple[Model, Model]:
        """The model with the modulus of a body at both sides."""
        model, step = self._prepared.model, self.step(body)
        modulus = model.bodies[body].material.smallest_modulus
        low, high = (with_material(model, body, E=modulus + part) for part in (-step, step))
        return low, high

    def of(self, body: int) -> PairChange:
        """What the modulus of a body changes of the pairs."""
        if body not in self._found:
            other = self._found.get(1 - body) if self._two_alone else None
            self._found[body] = self._paired(body) if other is None else other.mirrored(self.step(body))
        return self._found[body]

    @property
    def _two_alone(self) -> bool:
        """Whether there are two bodies, and no compliance that corners have of the softer one."""
        return len(self._prepared.model.bodies) == 2 and not self._prepared.interface.tangential_compliance.any()

    def _paired(self, body: int) -> PairChange:
        """What it changes, by pairing the sides at both of its values."""
        low, high = (pairs_at(self._prepared, self._prepared.space, model) for model in self.models(body))
        return PairChange.between(low, high, self.step(body))


def with_material(model: Model, body: int, **changed: float) -> Model:
    """The model with a body of another material.

    Parameters
    ----------
    body : its number
    changed : fields of its material
    """
    bodies = list(model.bodies)
    material: Any = bodies[body].material
    bodies[body] = replace(bodies[body], material=replace(material, **changed))
    return replace(model, bodies=tuple(bodies))
