# SPDX-License-Identifier: BSD-3-Clause
"""What a deck asks for of natural modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from signorini.checks import choice, number, whole
from signorini.errors import InputError

STUCK, SLIPPING, OPEN_JOINT = "stuck", "slipping", "open"
"""What joints do in a mode: pairs that touch move as one; stay closed and slide freely; are not there."""

JOINTS = (STUCK, SLIPPING, OPEN_JOINT)

MOST_MODES = 1000
"""That can be asked for: so many no mesh resolves."""


MOST_CYCLES = 1000
"""At one amplitude: what has not closed by then goes on."""


@dataclass(frozen=True, kw_only=True)
class ModesRequest:
    """The natural modes of a deck, and the loops of one of them.

    Parameters
    ----------
    number : of modes
    joints : states of the joints, of :data:`JOINTS`
    preload : about the end of the steps; otherwise nothing is solved, and pairs without a gap touch
    mode : whose loops are followed, from 1, of the stuck joint
    amplitudes : of the loops, ascending, length; none: no loop
    cycles : at each amplitude, of which the last is the loop: the first ones may shake down
    nodal_diameters : waves around the ring that a cyclic sector is of

    Raises
    ------
    InputError
        For a number out of its range, amplitudes that do not ascend, or loops without a preload or of waves.
    """

    number: int = 6
    joints: Sequence[str] = JOINTS
    preload: bool = True
    mode: int = 1
    amplitudes: Sequence[float] = ()
    cycles: int = 2
    nodal_diameters: int = 0

    def __post_init__(self) -> None:
        whole(self.number, ("number",), most=MOST_MODES)
        whole(self.mode, ("mode",), most=MOST_MODES)
        whole(self.nodal_diameters, ("nodal_diameters",), least=0)
        whole(self.cycles, ("cycles",), most=MOST_CYCLES)
        if isinstance(self.joints, str) or not self.joints:
            raise InputError(f"are {self.joints!r}; expected a list of states", where=("joints",))
        for i, joint in enumerate(self.joints):
            choice(joint, JOINTS, ("joints", i), "state of the joints")
        if not isinstance(self.preload, bool):
            raise InputError(f"is {self.preload!r}; expected true or false", where=("preload",))
        object.__setattr__(self, "joints", tuple(dict.fromkeys(self.joints)))
        object.__setattr__(self, "amplitudes", ascending(self.amplitudes, ("amplitudes",)))
        if self.amplitudes and self.nodal_diameters:
            raise InputError(
                "are those of loops alike in all sectors; expected nodal_diameters = 0", where=("amplitudes",)
            )
        if self.amplitudes and not self.preload:
            raise InputError("are those of loops about a preload; expected preload = true", where=("amplitudes",))


def ascending(values: Sequence[float], where: tuple[str, ...]) -> tuple[float, ...]:
    """Lengths > 0, each larger than the one before, named by where they stand.

    Raises
    ------
    InputError
        If they are not.
    """
    if isinstance(values, str) or not isinstance(values, Sequence):
        raise InputError(f"are {values!r}; expected a list of lengths", where=where)
    found = tuple(number(value, (*where, i), above=0.0) for i, value in enumerate(values))
    if any(later <= value for value, later in pairwise(found)):
        raise InputError(f"are {list(found)}; expected them to ascend", where=where)
    return found
