# SPDX-License-Identifier: BSD-3-Clause
"""Rows of words as aligned lines."""

from __future__ import annotations

from collections.abc import Collection, Sequence


def align(rows: Sequence[Sequence[str]], *, right: Collection[int] = (), indent: str = "  ") -> list[str]:
    """Lines whose columns stand below each other.

    Parameters
    ----------
    rows : of equal lengths
    right : columns that are set flush right, for numbers
    indent : before every line

    Examples
    --------
    >>> print(*align([["name", "n"], ["foundation", "12"], ["top", "3"]], right=[1]), sep="|\\n")
      name         n|
      foundation  12|
      top          3
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        words = [
            word.rjust(width) if i in right else word.ljust(width)
            for i, (word, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append((indent + "  ".join(words)).rstrip())
    return lines
