# SPDX-License-Identifier: BSD-3-Clause
"""The two ways to fail: the input is wrong, or no certified solution was found. Both are told in one clear message."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any

from signorini.arrays import elsewhere, stored
from signorini.outcome import Outcome

Where = tuple[str | int, ...]

_MAX_WORDS = 200  # characters


class SignoriniError(Exception):
    """Base of every error that this package raises on purpose."""


class InputError(SignoriniError, ValueError):
    """The input is wrong: says where, what was found and what is expected.

    Parameters
    ----------
    message : what was found and what is expected
    where : path of the value in the model, as a deck spells it: ``("contact", 0, "friction")``
    cell : index of the cell that is wrong, where it is one: a deck may know its line

    Examples
    --------
    >>> print(InputError("is -0.1; expected a number >= 0", where=("contact", 0, "friction")))
    contact[0].friction: is -0.1; expected a number >= 0
    """

    def __init__(self, message: str, *, where: Where = (), cell: int | None = None) -> None:
        self.message = message
        self.where = where
        self.cell = cell
        super().__init__(f"{spell(where)}: {message}" if where else message)

    def inside(self, *outer: str | int) -> InputError:
        """This error from one level further out (a part of a model does not know its own index)."""
        return InputError(self.message, where=outer + self.where, cell=self.cell)


def told(sentence: str, *, remedy: str = "", evidence: str = "") -> str:
    """What happened in a sentence; what to do about it and what it rests on on lines of their own.

    >>> print(told("the body leaves", remedy="hold it", evidence="a third of the load is left"))
    the body leaves
      what to do: hold it
      evidence: a third of the load is left
    """
    return "\n  ".join(
        [sentence, *(f"what to do: {remedy}" for _ in remedy[:1]), *(f"evidence: {evidence}" for _ in evidence[:1])]
    )


@elsewhere("motion")
class SolveFailed(SignoriniError):
    """No certified solution: carries the reason and whatever was found before.

    Its words begin with one sentence; see :func:`told` for the lines that may follow.

    Attributes
    ----------
    status : NO_EQUILIBRIUM (proved), NOT_FOUND or JUMP, with its ``advice``
    solution : the steps that were finished before, or None
    motion : array (nodes, d) of displacements along which bodies run away, or None
    reached : the part of the step that was followed before, or None
    hopeless : whether it is proved that no way of stepping leads to the end of the step
    unsettled : whether every increment was certified, and only more and more of them lead to different answers
    mechanisms : in which plastic flow runs away, see :class:`signorini.engine.solver.Mechanism`
    """

    def __init__(
        self, message: str, *, status: str, solution: object | None = None, motion: object | None = None
    ) -> None:
        self.status = Outcome(status)
        self.motion = motion
        self.solution = solution
        self.reached: object | None = None
        self.hopeless = self.status == Outcome.NO_EQUILIBRIUM
        self.unsettled = False
        self.mechanisms: tuple[Any, ...] = ()
        super().__init__(message)

    @property
    def sentence(self) -> str:
        """What happened."""
        return str(self).partition("\n")[0]

    @property
    def details(self) -> str:
        """What to do, and evidence: the lines behind the sentence, each after a break; empty where there are none."""
        return str(self)[len(self.sentence) :]

    def saying(self, words: str) -> SolveFailed:
        """This failure with words more at the end of its sentence."""
        said = SolveFailed(f"{self.sentence}; {words}{self.details}", status=self.status, motion=stored(self, "motion"))
        said.solution, said.reached = self.solution, self.reached
        said.hopeless, said.unsettled, said.mechanisms = self.hopeless, self.unsettled, self.mechanisms
        return said


class Interrupted(KeyboardInterrupt):
    """Stopped from outside, by Ctrl-C or SIGTERM: carries whatever was found before.

    Attributes
    ----------
    solution : the steps that were finished before, and the next one as far as it was followed
    reached : the part of the step that was followed before, or None
    """

    def __init__(self, message: str = "", *, solution: object | None = None, reached: object | None = None) -> None:
        self.solution = solution
        self.reached = reached
        super().__init__(message)


def spell_point(point: Iterable[float], digits: int = 5) -> str:
    """Coordinates in words.

    >>> spell_point((0.0, 2 / 3))
    '(0, 0.66667)'
    """
    return f"({', '.join(f'{part:.{digits}g}' for part in point)})"


def spell(where: Where) -> str:
    """A path as a deck spells it.

    >>> spell(("contact", 0, "friction"))
    'contact[0].friction'
    """
    text = ""
    for part in where:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def one_of(found: str, known: Iterable[str], what: str) -> str:
    """Words for a name ``found`` where none is known for what it names: the nearest known one, and all of them.

    >>> one_of("botom", ["bottom", "top"], "boundary")
    "unknown boundary 'botom'; did you mean 'bottom'? Known: bottom, top"
    """
    names = sorted(known)
    near = difflib.get_close_matches(found, names, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else "."
    return f"unknown {what} '{found}'{hint} Known: {', '.join(names) if names else 'none'}"


def brief(error: BaseException) -> str:
    """What another package says of a file, in one line of few words: some of them quote what they have found.

    >>> brief(ValueError("no\\n" + "x" * 1000))[-6:]
    'xxx...'
    """
    words = " ".join(str(error).split()) or type(error).__name__
    return words if len(words) <= _MAX_WORDS else words[:_MAX_WORDS] + "..."
