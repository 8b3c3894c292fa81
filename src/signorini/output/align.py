# SPDX-License-Identifier: BSD-3-Clause
"""Rows of words as aligned lines."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import zip_longest


def align(rows: Sequence[Sequence[str]], *, right: Collection[int] = (), indent: str = "  ") -> list[str]:
    """Lines whose columns stand below each other.

    Parameters
    ----------
    rows : those that are shorter end in empty words
    right : columns that are set flush right, for numbers
    indent : before every line

    Examples
    --------
    >>> print(*align([["name", "n"], ["foundation", "12"], ["top", "3"]], right=[1]), sep="|\\n")
      name         n|
      foundation  12|
      top          3
    >>> align([["a", "b"], ["c"]])
    ['  a  b', '  c']
    """
    widths = [max(map(len, column)) for column in zip_longest(*rows, fillvalue="")]
    lines = []
    for row in rows:
        words = [
            word.rjust(width) if i in right else word.ljust(width)
            for i, (word, width) in enumerate(zip(row, widths, strict=False))
        ]
        lines.append((indent + "  ".join(words)).rstrip())
    return lines
