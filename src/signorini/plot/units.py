# SPDX-License-Identifier: BSD-3-Clause
"""Units on axes: those that a model names, and where it names none what they are units of."""

from __future__ import annotations

import re
from dataclasses import dataclass

_LENGTHS = ("m", "mm", "cm", "um", "µm", "nm", "in", "inch", "ft")
_FORCES = ("N", "kN", "MN", "mN", "uN", "lbf", "kip", "kgf")
_PRESSURES = ("Pa", "kPa", "MPa", "GPa", "psi", "ksi", "N/mm2", "N/mm^2", "N/m2")
_DERIVED = {("N", "mm"): "MPa", ("N", "m"): "Pa", ("kN", "mm"): "GPa", ("kN", "m"): "kPa", ("lbf", "in"): "psi"}
"""Force and length to the pressure that goes with them."""


@dataclass(frozen=True)
class Units:
    """Words for axes, each a unit or the name of the quantity."""

    length: str = "length"
    force: str = "force"
    pressure: str = "force per area"
    work: str = "work"
    volume: str = "volume"

    def after_comma(self, quantity: str) -> str:
        """Unit of a quantity behind a comma; of one without, "force per area", and of others nothing.

        >>> Units(length="mm").after_comma("length"), Units().after_comma("length")
        (', mm', '')
        """
        unit = self.pressure if quantity == "force per area" else str(getattr(self, quantity))
        return "" if unit == quantity != "force per area" else f", {unit}"


def units_of(words: str) -> Units:
    """Units from the words of a model; what they do not hold, or hold twice, is called by its quantity.

    >>> units_of("mm, N, MPa")
    Units(length='mm', force='N', pressure='MPa', work='N mm', volume='mm^3')
    >>> units_of("as given, consistent").pressure, units_of("N, m").pressure
    ('force per area', 'Pa')
    """
    named = re.findall(r"[A-Za-zµ]+(?:/[A-Za-z]+\^?2)?", words)
    length, force, pressure = (_only(named, kind) for kind in (_LENGTHS, _FORCES, _PRESSURES))
    pressure = pressure or _DERIVED.get((force, length), "")
    plain = Units()
    return Units(
        length=length or plain.length,
        force=force or plain.force,
        pressure=pressure or plain.pressure,
        work=f"{force} {length}" if force and length else plain.work,
        volume=f"{length}^3" if length else plain.volume,
    )


def _only(named: list[str], kind: tuple[str, ...]) -> str:
    found = list(dict.fromkeys(word for word in named if word in kind))
    return found[0] if len(found) == 1 else ""
