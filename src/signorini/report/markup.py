# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of HTML; every word that comes from a user is escaped here."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from html import escape

_CELL = "padding:.15em .6em;"


def said(words: object) -> str:
    """Words as text of HTML, whatever signs they hold."""
    return escape(str(words))


def table(rows: Sequence[Sequence[object]], *, numbers: Collection[int] = (), caption: str = "") -> str:
    """A table with a head, which scrolls on its own where it is wider than the page.

    Parameters
    ----------
    rows : of words or numbers, the head first
    numbers : columns that are set flush right
    caption : above it; none where empty
    """
    named = f"<caption>{said(caption)}</caption>" if caption else ""
    head, *body = [
        "".join(_cell(word, i in numbers, head=not k) for i, word in enumerate(row)) for k, row in enumerate(rows)
    ]
    lines = "".join(f"<tr>{row}</tr>" for row in body)
    return (
        f'<div style="overflow-x:auto"><table style="border-collapse:collapse">{named}'
        f"<thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>"
    )


def _cell(word: object, number: bool, *, head: bool) -> str:
    name = 'th scope="col"' if head else "td"
    side = "text-align:right;font-variant-numeric:tabular-nums" if number else "text-align:left"
    return f'<{name} style="{_CELL}{side}">{said(word)}</{name[:2]}>'


def listed(items: Sequence[str]) -> str:
    """A list of pieces of HTML."""
    return f"<ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>"
