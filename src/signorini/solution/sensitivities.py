# SPDX-License-Identifier: BSD-3-Clause
"""How far a derivative holds, and the table of all of them in per cent per per cent."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array
from signorini.short import Short


@dataclass(frozen=True, kw_only=True)
class Validity:
    """The changes of a parameter in which a derivative holds, to first order.

    Attributes
    ----------
    low, high : change of the parameter at which the sequence of events becomes another; infinite where none does
    ends : what happens at both, in words; empty where nothing does
    """

    low: float
    high: float
    ends: tuple[str, str]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sensitivities(Short):
    """Changes of answers in per cent for one per cent of each parameter, at the end of a history.

    Attributes
    ----------
    outputs : (m,) in words
    values : (m,) of them
    parameters : (n,) as ``kind.name``
    given : (n,) their values; 1 of loads and supports, which stand for all that is multiplied
    per_cent : (n, m)
    holds : (n,) in which changes of the parameters, in per cent, the sequence of events stays
    refused : parameters without a derivative, and why
    """

    outputs: tuple[str, ...]
    values: Array
    parameters: tuple[str, ...]
    given: Array
    per_cent: Array
    holds: tuple[Validity, ...]
    refused: tuple[str, ...] = ()
