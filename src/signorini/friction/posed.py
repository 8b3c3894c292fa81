# SPDX-License-Identifier: BSD-3-Clause
"""What the condensed contact problems of the plane and of space share, whatever the law of friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, read_only
from signorini.condense.operator import InterfaceOperator
from signorini.errors import InputError
from signorini.law.bound import FrictionBound


@dataclass(frozen=True, kw_only=True)
class PosedContact:
    """``G h - W r = b``, ``G = I - W``, of n pairs with d rows each: n normals, then n of every tangent.

    Parameters
    ----------
    image : W, its compliance and its rigid motions, of d n rows; ``dataclasses.replace(problem, b=...)`` shares it
    b : (d n,)
    friction : (n,) or (n, d - 1)
    scale : size of b's entries
    adhesion, limit : (n,) scaled forces of `law.bound`: friction at no normal force, and the most there is;
        None stands for none
    """

    image: InterfaceOperator
    b: Array
    friction: Array
    scale: float
    adhesion: Array | None = None
    limit: Array | None = None

    @classmethod
    def of(cls, *, W: ArrayLike, motions: ArrayLike, **law: Any) -> Self:
        """The problem of a given W, (d n, d n), and the rigid motions that the pairs see, (d n, k), W R = R.

        Parameters
        ----------
        W : symmetric, spectrum in [0, 1]; 1 belongs to rigid motions alone. Exactly zero tangential rows say that
            supports lock the pair's motion along that tangent. Kept with W R = R restored to rounding
        motions : k = 0 where supports hold every body
        law : what else the problem takes
        """
        return cls(image=InterfaceOperator.of_form(np.asarray(W), np.asarray(motions)), **law)

    def __post_init__(self) -> None:
        for name in ("b", "friction"):
            object.__setattr__(self, name, read_only(getattr(self, name)))
        for name in ("adhesion", "limit"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, read_only(getattr(self, name)))
        self._check()

    @property
    def W(self) -> Array:
        """(d n, d n) InterfaceOperator form, formed when first asked for."""
        return self.image.W

    @property
    def motions(self) -> Array:
        """(d n, k) Rigid motions seen by the pairs."""
        return self.image.motions

    @property
    def pairs(self) -> int:
        """Number of pairs n."""
        return len(self.friction)

    @property
    def floating(self) -> bool:
        """Whether some body is held by contact alone."""
        return bool(self.motions.shape[1])

    def misfit(self, h: Array, r: Array, b: Array | None = None) -> Array:
        """(d n,) ``b - (G h - W r)``, the motion that equilibrium lacks, under the problem's b or another."""
        return (self.b if b is None else b) + self.image.applied(h + r) - h

    @property
    def bound(self) -> FrictionBound:
        """What friction is bounded by at every normal force."""
        raise NotImplementedError

    def _check(self) -> None:
        raise NotImplementedError

    def _check_data(self, rows: int, frictions: list[tuple[int, ...]]) -> None:
        """Refuse wrong shapes and numbers.

        Parameters
        ----------
        rows : d n
        frictions : shapes that friction may have
        """
        if len(self.motions) != rows:
            raise InputError(f"has {len(self.motions)} rows; expected {rows} for {self.pairs} pairs", where=("W",))
        shapes: dict[str, list[tuple[int, ...]]] = {"b": [(rows,)], "friction": frictions}
        for name, expected in shapes.items():
            found = getattr(self, name)
            if found.shape not in expected:
                said = " or ".join(map(str, expected))
                raise InputError(f"has shape {found.shape}; expected {said} for {self.pairs} pairs", where=(name,))
            if not np.isfinite(found).all() and name != "friction":
                raise InputError("has entries that are not finite", where=(name,))
        if not (self.friction >= 0).all():
            raise InputError(
                "has negative entries or NaN; expected mu >= 0, inf for pairs that stick", where=("friction",)
            )
        for name, given in (("adhesion", self.adhesion), ("limit", self.limit)):
            if given is None:
                continue
            if given.shape != (self.pairs,):
                raise InputError(f"has shape {given.shape}; expected {(self.pairs,)}", where=(name,))
            if not (given >= 0).all() or (name == "adhesion" and not np.isfinite(given).all()):
                raise InputError("has negative entries or NaN; expected scaled forces >= 0", where=(name,))
        if not (np.isfinite(self.scale) and self.scale >= 0):
            raise InputError(f"is {self.scale}; expected a finite number >= 0", where=("scale",))

    def _check_dragged(self, pulled: BoolArray) -> None:
        """Refuse pairs without bound on their friction, (n,) or (n, d - 1), that supports pull along."""
        n = self.pairs
        if self.limit is not None:
            pulled = pulled & np.isinf(self.limit.reshape(-1, *[1] * (pulled.ndim - 1)))
        if np.any(pulled.reshape(n, -1 if n else 1) & np.isinf(self.friction.reshape(n, -1 if n else 1))):
            raise InputError(
                "is infinite at a pair whose supports drag it along: it can neither slip nor stick; give a finite mu",
                where=("friction",),
            )
