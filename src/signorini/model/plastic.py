# SPDX-License-Identifier: BSD-3-Clause
"""How isotropic materials yield: von Mises' criterion with isotropic and kinematic hardening."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from signorini.arrays import Array, frozen
from signorini.checks import number, rows
from signorini.errors import InputError, Where


@dataclass(frozen=True)
class Plastic:
    """Von Mises' yield criterion with its associated flow, in small strain, the same at any rate.

    ``|xi| <= sqrt(2/3) Y(p)`` with ``xi = dev sigma - sum X_i`` and the equivalent plastic strain p; where the two are
    equal, plastic strain grows along ``n = xi / |xi|``, ``d eps_p = sqrt(3/2) dp n``. Each backstress follows Armstrong
    and Frederick, ``d X_i = 2/3 C_i d eps_p - gamma_i X_i dp``: in tension it tends to ``C_i / gamma_i``, and with
    ``gamma_i = 0`` (Prager) it grows without end. Several are Chaboche's law.

    Parameters
    ----------
    yield_stress : Y in uniaxial tension, force per area, > 0: a number, or rows (p, Y), linear in between: the first p
        is 0, p increases, Y does not decrease
    hardening : slope of Y beyond the last row, force per area, >= 0
    backstresses : rows (C, gamma): C force per area, > 0, and gamma >= 0 without unit

    Raises
    ------
    InputError
        If something is out of these limits. A material that softens is refused: what flows has then no unique place.

    Examples
    --------
    >>> steel = Plastic([(0.0, 235.0), (0.02, 235.0), (0.3, 400.0)])
    >>> stress, slope = steel.at(np.array([0.01, 0.16, 0.5]))
    >>> stress.tolist(), [round(float(h)) for h in slope]
    ([235.0, 317.5, 400.0], [0, 589, 0])
    >>> Plastic(235.0).perfect, Plastic(235.0, backstresses=[(2e4, 100.0)]).perfect
    (True, False)
    """

    yield_stress: float | tuple[tuple[float, float], ...]
    hardening: float = 0.0
    backstresses: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "yield_stress", _yield_stress(self.yield_stress))
        object.__setattr__(self, "hardening", number(self.hardening, ("hardening",), least=0.0))
        given = self.backstresses if np.size(self.backstresses) else np.empty((0, 2))
        found = []
        for i, (modulus, recall) in enumerate(rows(given, ("backstresses",), size=2).tolist()):
            where = ("backstresses", i)
            found.append((number(modulus, (*where, 0), above=0.0), number(recall, (*where, 1), least=0.0)))
        object.__setattr__(self, "backstresses", tuple(found))

    @property
    def curve(self) -> Array:
        """(n, 2) Rows of equivalent plastic strain and yield stress."""
        return frozen(self.yield_stress)

    @property
    def perfect(self) -> bool:
        """Whether nothing hardens."""
        return not (self.hardening or self.backstresses or np.ptp(self.curve[:, 1]))

    def at(self, p: Array) -> tuple[Array, Array]:
        """Yield stress at equivalent plastic strains >= 0 of any shape, and its slope towards larger ones."""
        strain, stress = self.curve.T
        slopes = np.append(np.diff(stress) / np.diff(strain), self.hardening)
        row = np.searchsorted(strain, p, side="right") - 1
        return stress[row] + slopes[row] * (p - strain[row]), slopes[row]

    def __str__(self) -> str:
        strain, stress = self.curve.T
        words = [f"yields at {stress[0]:g}"]
        if len(stress) > 1:
            words.append(f"{stress[-1]:g} at {strain[-1]:g}")
        if self.hardening:
            words.append(f"hardening {self.hardening:g}")
        if self.backstresses:
            count = len(self.backstresses)
            words.append(f"{count} backstress{'es' if count > 1 else ''}")
        return ", ".join(words)


def _yield_stress(given: Any) -> tuple[tuple[float, float], ...]:
    """Rows (p, Y) that do not soften."""
    where: Where = ("yield_stress",)
    if not np.ndim(given):
        return ((0.0, number(given, where, above=0.0)),)
    table = rows(given, where, size=2).tolist()
    if not table:
        raise InputError("is empty; expected a number, or rows of plastic strain and yield stress", where=where)
    if table[0][0] != 0.0:
        raise InputError(f"is {table[0][0]:g}; expected 0, the plastic strain at first yield", where=(*where, 0, 0))
    for i, (before, row) in enumerate(pairwise(table), start=1):
        if row[0] <= before[0]:
            raise InputError(
                f"is {row[0]:g} after {before[0]:g}; expected increasing plastic strains", where=(*where, i, 0)
            )
        if row[1] < before[1]:
            raise InputError(
                f"is {row[1]:g} after {before[1]:g}: the material softens; expected stresses that do not decrease",
                where=(*where, i, 1),
            )
    number(table[0][1], (*where, 0, 1), above=0.0)
    return tuple((strain, stress) for strain, stress in table)
