# SPDX-License-Identifier: BSD-3-Clause
"""A wrong input whose place in a file is known."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from signorini.errors import InputError, Where


class DeckError(InputError):
    """Something in a deck is wrong: says file, line, key, what was found and what is expected.

    Parameters
    ----------
    message : what was found and what is expected
    path : of the deck, as the user spelled it
    where : path of the value in the deck, as ``("contact", 0, "friction")``
    line : from 1, where it is known
    others : further things that are wrong, each told on a line of its own

    Examples
    --------
    >>> print(DeckError("is -0.1; expected a number >= 0", path="a.toml", where=("contact", 0, "friction"), line=12))
    a.toml:12: contact[0].friction: is -0.1; expected a number >= 0
    """

    def __init__(
        self,
        message: str,
        *,
        path: str | Path,
        where: Where = (),
        line: int | None = None,
        others: Sequence[DeckError] = (),
    ) -> None:
        super().__init__(message, where=where)
        self.path = Path(path)
        self.line = line
        self.others = tuple(others)

    def __str__(self) -> str:
        place = str(self.path) if self.line is None else f"{self.path}:{self.line}"
        return "\n".join([f"{place}: {super().__str__()}", *map(str, self.others)])
