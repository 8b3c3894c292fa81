# SPDX-License-Identifier: BSD-3-Clause
"""Load histories: straight segments between load factors, and what of the contacts changes with them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from signorini.checks import choice, number, text, whole
from signorini.errors import InputError, Where
from signorini.law.friction import coefficient
from signorini.model.varying import Varying, varying
from signorini.short import Short

_MAX_COUNT = 1_000_000
"""Cycles, increments and times of a step: more of them have no meaning."""

Factors = float | tuple[float, ...]


@dataclass(frozen=True, kw_only=True, repr=False)
class Step(Short):
    """A part of the load history: one straight segment, or several that may be repeated.

    Parameters
    ----------
    name : what results call it
    scale : factors at the end of the step, by name of load or moving support; what is not named keeps its factor.
        A list of m factors makes m straight segments of equal length, each ending at one of them; all lists of a step
        are equally long, and a single number beside them is reached in equal parts. None: everything goes to 1
    repeat : how many times the segments are gone through, one cycle after the other
    at : parts of the step (0 .. 1) at whose end the full results are kept too; a number n: every n-th of the step; or
        "events": wherever a pair changes its state on an exact path
    friction : contact to its coefficient from here on, a number, two where the contact has a ``friction_axis``, or
        "stick". What slips because of that slips at once, before the loads of the step
    interference : contact to its overlap at the end of the step, length, a number or what varies over the side; it
        grows linearly over the step
    inactive : contacts switched off from here on: their forces go linearly to zero over the step
    active : contacts switched on again: they touch where they meet from here on, with no slip behind them; what
        overlaps at that moment is pressed out linearly over the step
    release : supports that let go from here on: their forces go linearly to zero over the step
    hold : supports that hold again, each node where it is at that moment; what they prescribe is added from there on
    restore : supports that hold again and take the nodes to where they prescribe linearly over the step
    increments : equal parts in which every segment is solved, or "auto": more and more until the contact forces
        change less than ``tolerance``, in space such as end at events; None leaves it to ``path``
    tolerance : of "auto", relative to the largest contact force; None: 1e-3. Where bodies yield, of tractions in
        the norm of areas and of plastic work; None: 1e-2. Where contacts wear, of ``block = "auto"``; None: 1e-2
    path : "increments", or "exact": from event to event (a pair closes, opens, slips, sticks), without any step size;
        in space for contacts with ``facets``. None chooses: "increments" where their number is given or nothing rubs
        and no closure is kept (one is exact then), otherwise "exact", in space increments as with "auto", some tens at
        most, and the notes say what they left
    block : where contacts wear, cycles that one of them stands for, implicitly: what wears in a block is what the
        last of its cycles wears on the worn surfaces, times their number; "auto": as many as keep the error of a
        block below ``tolerance`` of what it wears, or one by one where no block pays. None wears after every cycle
        what it has worn, explicitly
    jump : where an exact path, in space also one in increments that end at events, has no gradual continuation, "stop"
        there, or "follow" the equilibria to the next one at that load, which is called a candidate. None stops where
        the path is asked to be exact, otherwise follows

    Examples
    --------
    >>> Step(name="fret", scale={"push": [1, -1, 1]}, repeat=5).segments
    3
    """

    name: str = ""
    scale: Mapping[str, float | Sequence[float]] | None = None
    repeat: int = 1
    at: Sequence[float] | int | Literal["events"] = ()
    friction: Mapping[str, float | tuple[float, float] | Literal["stick"]] = field(default_factory=dict)
    interference: Mapping[str, Varying] = field(default_factory=dict)
    inactive: Sequence[str] = ()
    active: Sequence[str] = ()
    release: Sequence[str] = ()
    hold: Sequence[str] = ()
    restore: Sequence[str] = ()
    increments: int | Literal["auto"] | None = None
    tolerance: float | None = None
    path: Literal["increments", "exact"] | None = None
    jump: Literal["stop", "follow"] | None = None
    block: int | Literal["auto"] | None = None

    def __post_init__(self) -> None:
        if self.name:
            text(self.name, ("name",))
        whole(self.repeat, ("repeat",), most=_MAX_COUNT)
        if self.tolerance is not None:
            number(self.tolerance, ("tolerance",), above=0.0)
        if isinstance(self.increments, str):
            choice(self.increments, ("auto",), ("increments",), "number of increments")
        elif self.increments is not None:
            whole(self.increments, ("increments",), most=_MAX_COUNT)
        if self.path is not None:
            choice(self.path, ("increments", "exact"), ("path",), "path")
        if self.jump is not None:
            choice(self.jump, ("stop", "follow"), ("jump",), "answer to jumps")
        if isinstance(self.block, str):
            choice(self.block, ("auto",), ("block",), "number of cycles")
        elif self.block is not None:
            whole(self.block, ("block",), most=_MAX_COUNT)
        if self.path == "exact" and self.increments is not None:
            raise InputError("has a number of increments, but the path is exact; expected one of both")
        if self.scale is not None:
            self._set("scale", _factors(self.scale))
        self._set("at", _times(self.at))
        self._set("friction", {name: _coefficient(value, name) for name, value in _table(self.friction, "friction")})
        overlaps = _table(self.interference, "interference")
        self._set("interference", {name: _overlap(value, ("interference", name)) for name, value in overlaps})
        for key in ("active", "inactive"):
            self._set(key, _names(getattr(self, key), key, "contacts"))
        for key in ("release", "hold", "restore"):
            self._set(key, _names(getattr(self, key), key, "supports"))
        twice = [name for name, count in Counter((*self.release, *self.hold, *self.restore)).items() if count > 1]
        if twice:
            raise InputError(f"'{twice[0]}' is named twice; expected one of release, hold, restore", where=("release",))
        both = set(self.active) & set(self.inactive)
        if both:
            raise InputError(f"'{min(both)}' is switched on and off; expected one of both", where=("active",))

    def _set(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, MappingProxyType(value) if isinstance(value, dict) else value)

    @property
    def varies(self) -> bool:
        """Whether any interference varies over its side."""
        return any(not isinstance(value, float) for value in self.interference.values())

    @property
    def follows_jumps(self) -> bool:
        """Whether an exact path goes on behind a jump."""
        return self.jump == "follow" or (self.jump is None and self.path is None)

    @property
    def segments(self) -> int:
        """Straight segments of one cycle."""
        return max((len(value) for value in (self.scale or {}).values() if isinstance(value, tuple)), default=1)

    def ends(self, start: Mapping[str, float]) -> list[dict[str, float]]:
        """Load factors at the end of every segment of every cycle.

        Parameters
        ----------
        start : factors at the beginning of the step, of everything that can be scaled

        Examples
        --------
        >>> Step(scale={"push": [1, -1], "press": 3}, repeat=2).ends({"push": 0.0, "press": 1.0, "pull": 0.5})[1:3]
        [{'push': -1.0, 'press': 3.0, 'pull': 0.5}, {'push': 1.0, 'press': 3.0, 'pull': 0.5}]
        """
        scale: Mapping[str, Any] = dict.fromkeys(start, 1.0) if self.scale is None else self.scale
        m = self.segments
        first = [
            dict(start)
            | {
                name: value[j] if isinstance(value, tuple) else start[name] + (j + 1) / m * (value - start[name])
                for name, value in scale.items()
            }
            for j in range(m)
        ]
        last = first[-1]
        reached = {name: value for name, value in scale.items() if not isinstance(value, tuple)}
        first[-1] = last | reached
        again = [ends | reached for ends in first]
        return first + again * (self.repeat - 1)


def _factors(scale: Any) -> dict[str, Factors]:
    factors: dict[str, Factors] = {}
    for name, value in _table(scale, "scale"):
        if isinstance(value, Sequence) and not isinstance(value, str):
            if not value:
                raise InputError(
                    "is an empty list; expected a number, or a factor for every segment", where=("scale", name)
                )
            factors[name] = tuple(number(part, ("scale", name, i)) for i, part in enumerate(value))
        else:
            factors[name] = number(value, ("scale", name))
    lengths = {name: len(value) for name, value in factors.items() if isinstance(value, tuple)}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise InputError(f"lists are of different lengths ({words}); expected one factor a segment", where=("scale",))
    return factors


def _table(value: Any, key: str) -> list[tuple[str, Any]]:
    if not isinstance(value, Mapping):
        what = "factors" if key == "scale" else "numbers"
        raise InputError(f"is {value!r}; expected a table of names and {what}", where=(key,))
    return list(value.items())


def _coefficient(value: Any, name: str) -> float | tuple[float, float] | str:
    return "stick" if value == "stick" else coefficient(value, ("friction", name))


def _overlap(value: Any, where: Where) -> Varying:
    return number(value, where) if isinstance(value, float | int) else varying(value, where)


def _times(at: Any) -> tuple[float, ...] | str:
    if at == "events":
        return "events"
    if isinstance(at, int) and not isinstance(at, bool) and at > 0:
        whole(at, ("at",), most=_MAX_COUNT)
        return tuple(k / at for k in range(1, at + 1))
    if isinstance(at, str) or not isinstance(at, Sequence):
        expected = 'a list of parts of the step between 0 and 1, a number of equal parts, or "events"'
        raise InputError(f"is {at!r}; expected {expected}", where=("at",))
    times = [number(part, ("at", i), above=0.0) for i, part in enumerate(at)]
    late = [i for i, part in enumerate(times) if part > 1.0]
    if late:
        raise InputError(f"is {times[late[0]]:g}; expected a part of the step, at most 1", where=("at", late[0]))
    return tuple(sorted(set(times)))


def _names(value: Any, key: str, what: str) -> tuple[str, ...]:
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise InputError(f"is {value!r}; expected a list of {what}", where=(key,))
    return tuple(text(name, (key, i)) for i, name in enumerate(value))
