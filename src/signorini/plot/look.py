# SPDX-License-Identifier: BSD-3-Clause
"""What a reader asks a picture for: a component, a range of values, a part of the bodies, a scale of displacements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from signorini.errors import InputError


@dataclass(frozen=True, kw_only=True)
class Look:
    """Choices that a picture makes itself where they are None.

    Attributes
    ----------
    component : of a stress or a displacement, see `plot.components`
    range : smallest and largest value that is shown
    zoom : smallest and largest coordinate along every direction of the picture, one pair after the other, length
    scale : factor of displacements, 0: undeformed

    Raises
    ------
    InputError
        If a number is not finite, a range does not ascend, or the scale is negative.
    """

    component: str | None = None
    range: Sequence[float] | None = None
    zoom: Sequence[float] | None = None
    scale: float | None = None

    def __post_init__(self) -> None:
        if self.range is not None and len(self.range) != 2:
            raise InputError(f"has {len(self.range)} numbers; expected the smallest and the largest", where=("range",))
        for name, numbers in (("range", self.range or ()), ("zoom", self.zoom or ())):
            if not all(map(math.isfinite, numbers)):
                raise InputError(f"is {_spelled(numbers)}; expected finite numbers", where=(name,))
            if any(low >= high for low, high in zip(numbers[::2], numbers[1::2], strict=False)):
                raise InputError(f"is {_spelled(numbers)}; expected each first number below its second", where=(name,))
        if self.scale is not None and not 0.0 <= self.scale < math.inf:
            raise InputError(f"is {self.scale:g}; expected a factor >= 0", where=("scale",))

    @property
    def asked(self) -> list[str]:
        """Names of what is chosen."""
        return [name for name in ("component", "range", "zoom", "scale") if getattr(self, name) is not None]

    def corners(self, words: str) -> list[tuple[float, float]] | None:
        """Pairs of the zoom, one for every direction of a picture; None where there is no zoom.

        Parameters
        ----------
        words : names of the directions, with a blank between them: "x y"

        Raises
        ------
        InputError
            If there are more or fewer.
        """
        if self.zoom is None:
            return None
        names = words.split()
        if len(self.zoom) != 2 * len(names):
            pairs = ", ".join(f"{name} from and to" for name in names)
            raise InputError(f"is {_spelled(self.zoom)}; expected {2 * len(names)} numbers: {pairs}", where=("zoom",))
        return [(float(low), float(high)) for low, high in zip(self.zoom[::2], self.zoom[1::2], strict=True)]


def _spelled(numbers: Sequence[float]) -> str:
    return " ".join(f"{number:g}" for number in numbers)
