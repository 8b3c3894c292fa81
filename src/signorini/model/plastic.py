# SPDX-License-Identifier: BSD-3-Clause
"""How isotropic materials yield: von Mises' criterion with isotropic and kinematic hardening."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from signorini.arrays import Array, frozen
from signorini.checks import number, rows
from signorini.errors import InputError, Where
from signorini.short import Short


@dataclass(frozen=True, repr=False)
class Plastic(Short):
    """Von Mises' yield criterion with its associated flow, in small strain, the same at any rate.

    ``|xi| <= sqrt(2/3) Y(p)`` with ``xi = dev sigma - sum X_i`` and the equivalent plastic strain p; where the two are
    equal, plastic strain grows along ``n = xi / |xi|``, ``d eps_p = sqrt(3/2) dp n``. Each backstress follows Armstrong
    and Frederick, ``d X_i = 2/3 C_i d eps_p - gamma_i X_i dp``: in tension it tends to ``C_i / gamma_i``, and with
    ``gamma_i = 0`` (Prager) it grows without end. Several are Chaboche's law.

    Parameters
    ----------
    yield_stress : Y in uniaxial tension, force per area, > 0: a number, or rows (p, Y), linear in between: the first p
        is 0, p increases, Y does not decrease. Rows (p, Y, T) depend on temperature, that of loads, above the one
        without strain: such rows for every T, one T after the other, linear in between, constant below and above;
        the curves of neighbouring T do not cross
    hardening : slope of Y beyond the last row of any temperature, force per area, >= 0
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
    >>> hot = Plastic([(0.0, 235.0, 20.0), (0.0, 180.0, 220.0), (0.1, 200.0, 220.0)])
    >>> [round(float(hot.at(np.array(0.05), temperature)[0]), 6) for temperature in (20.0, 120.0, 500.0)]
    [235.0, 212.5, 190.0]
    >>> Plastic(235.0).perfect, Plastic(235.0, backstresses=[(2e4, 100.0)]).perfect
    (True, False)
    """

    yield_stress: float | tuple[tuple[float, ...], ...]
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
        """(n, 2) Rows of equivalent plastic strain and yield stress, at the lowest temperature."""
        return self.curves[0]

    @property
    def curves(self) -> tuple[Array, ...]:
        """(n, 2) Rows of equivalent plastic strain and yield stress at every temperature."""
        rows = np.array(self.yield_stress)
        if rows.shape[1] == 2:
            return (frozen(rows),)
        return tuple(frozen(rows[rows[:, 2] == temperature, :2]) for temperature in self.temperatures)

    @property
    def temperatures(self) -> Array:
        """(t,) Of the curves, increasing; 0 alone where the yield stress does not depend on temperature."""
        rows = np.array(self.yield_stress)
        return np.zeros(1) if rows.shape[1] == 2 else np.unique(rows[:, 2])

    @property
    def varies_with_heat(self) -> bool:
        """Whether the yield stress depends on temperature."""
        return len(self.temperatures) > 1

    @property
    def perfect(self) -> bool:
        """Whether nothing hardens."""
        return not (self.hardening or self.backstresses or any(np.ptp(curve[:, 1]) for curve in self.curves))

    def at(self, p: Array, temperature: float = 0.0) -> tuple[Array, Array]:
        """Yield stress at equivalent plastic strains >= 0 of any shape, and its slope towards larger ones.

        Parameters
        ----------
        p : equivalent plastic strains
        temperature : above that without strain
        """
        place = float(np.interp(temperature, self.temperatures, np.arange(len(self.temperatures))))
        low, way = int(place), place % 1.0
        stress, slope = self._on(self.curves[low], p)
        if way:
            beyond = self._on(self.curves[low + 1], p)
            stress, slope = stress + way * (beyond[0] - stress), slope + way * (beyond[1] - slope)
        return stress, slope

    def _on(self, curve: Array, p: Array) -> tuple[Array, Array]:
        """Yield stress and slope on the curve of one temperature."""
        strain, stress = curve.T
        slopes = np.append(np.diff(stress) / np.diff(strain), self.hardening)
        row = np.searchsorted(strain, p, side="right") - 1
        return stress[row] + slopes[row] * (p - strain[row]), slopes[row]

    def __str__(self) -> str:
        strain, stress = self.curve.T
        words = [f"yields at {stress[0]:g}"]
        if self.varies_with_heat:
            words = [
                f"yields at {', '.join(f'{curve[0, 1]:g}' for curve in self.curves)} at the temperatures "
                f"{', '.join(f'{temperature:g}' for temperature in self.temperatures)}"
            ]
        elif len(stress) > 1:
            words.append(f"{stress[-1]:g} at {strain[-1]:g}")
        if self.hardening:
            words.append(f"hardening {self.hardening:g}")
        if self.backstresses:
            count = len(self.backstresses)
            words.append(f"{count} backstress{'es' if count > 1 else ''}")
        return ", ".join(words)


def _yield_stress(given: Any) -> tuple[tuple[float, ...], ...]:
    """Rows (p, Y) or (p, Y, T) that do not soften."""
    where: Where = ("yield_stress",)
    if isinstance(given, str) or not np.iterable(given):
        return ((0.0, number(given, where, above=0.0)),)
    warm = any(isinstance(row, Sized) and len(row) == 3 for row in given)
    table = rows(given, where, size=3 if warm else 2).tolist()
    if not table:
        raise InputError("is empty; expected a number, or rows of plastic strain and yield stress", where=where)
    for i, row in enumerate(table):
        before = table[i - 1] if i else None
        if before is not None and row[2:] < before[2:]:
            raise InputError(
                f"is {row[2]:g} after {before[2]:g}; expected increasing temperatures, the rows of each together",
                where=(*where, i, 2),
            )
        if before is None or row[2:] > before[2:]:
            if row[0] != 0.0:
                raise InputError(f"is {row[0]:g}; expected 0, the plastic strain at first yield", where=(*where, i, 0))
            number(row[1], (*where, i, 1), above=0.0)
            continue
        if row[0] <= before[0]:
            raise InputError(
                f"is {row[0]:g} after {before[0]:g}; expected increasing plastic strains", where=(*where, i, 0)
            )
        if row[1] < before[1]:
            raise InputError(
                f"is {row[1]:g} after {before[1]:g}: the material softens; expected stresses that do not decrease",
                where=(*where, i, 1),
            )
    if warm:
        _check_apart(np.array(table), where)
    return tuple(tuple(row) for row in table)


def _check_apart(table: Array, where: Where) -> None:
    """Refuse curves (p, Y) of two temperatures that cross: one of them is wrong, or belongs to the other temperature.

    Parameters
    ----------
    table : (n, 3) rows (p, Y, T), in order
    where : path of the table
    """
    starts = np.flatnonzero(np.diff(table[:, 2], prepend=-np.inf))
    curves = np.split(table, starts[1:])
    for (low, high), start in zip(pairwise(curves), starts[1:], strict=True):
        strain = np.unique(np.concatenate([low[:, 0], high[:, 0]]))
        apart = np.interp(strain, *high[:, :2].T) - np.interp(strain, *low[:, :2].T)
        (sides,) = np.nonzero(apart)
        crossed = sides[np.sign(apart[sides]) != np.sign(apart[sides[:1]])]
        if len(crossed):
            row = start + min(int(np.searchsorted(high[:, 0], strain[crossed[0]])), len(high) - 1)
            raise InputError(
                f"is {table[row, 1]:g}: the curve of temperature {high[0, 2]:g} crosses that of {low[0, 2]:g} before a "
                f"plastic strain of {strain[crossed[0]]:g}; expected one above the other",
                where=(*where, int(row), 1),
            )
