# SPDX-License-Identifier: BSD-3-Clause
"""Keywords and data lines: however they are written, the same is read, and every line is known."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signorini.deck.error import DeckError
from signorini.deck.inp.card import Card
from signorini.deck.inp.numbers import number_table, record_table
from signorini.deck.inp.syntax import read_cards


def cards_of(folder: Path, text: str | bytes) -> list[Card]:
    deck = folder / "deck.inp"
    deck.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_cards(deck)


PLAIN = "*NODE, NSET=All\n1, 0.5, 2000\n2, 1.5, 3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"
WAYS = {
    "case and blanks": "*node,nset = All\n 1 ,0.5,2e3\n2,\t1.5,3\n*SolidSection , elset=E,MATERIAL=M\n1.",
    "comments": "** a\n*NODE, NSET=All\n1, 0.5, 2.D3\n** b\n2, 1.5, 3,\n**\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.",
    "windows": PLAIN.replace("\n", "\r\n"),
    "old mac": PLAIN.replace("\n", "\r"),
    "continued": "*NODE,\nNSET=All\n1, 0.5, 2000\n\n\n2, 1.5, 3\n*SOLID SECTION,\n ELSET=E,\n MATERIAL=M\n1.\n",
    "title before": ">**\nany words\n" + PLAIN,
    "mark of UTF-8": b"\xef\xbb\xbf" + PLAIN.encode(),
    "another alphabet": "** Größe\n".encode("latin-1") + PLAIN.encode(),
    "quoted": PLAIN.replace("=All", '="All"'),
}


@pytest.mark.parametrize("way", WAYS)
def test_spelling_does_not_matter(tmp_path: Path, way: str) -> None:
    node, section = cards_of(tmp_path, WAYS[way])
    assert (node.keyword, section.keyword) == ("NODE", "SOLID SECTION")
    assert node.parameters == {"NSET": "All"}
    assert section.parameters == {"ELSET": "E", "MATERIAL": "M"}
    assert section.row("").number(0, "") == 1.0
    table = number_table(node, "nodes", least=1, most=4)
    assert np.array_equal(table, [[1, 0.5, 2000, 0], [2, 1.5, 3, 0]])


def test_lines_are_those_of_the_file(tmp_path: Path) -> None:
    node, static = cards_of(tmp_path, "**\n*NODE\n1, 2.\n** a\n\n2, x\n*STATIC\n")
    assert (node.line, static.line) == (2, 7)
    assert [row.line for row in node.rows()] == [3, 6]
    with pytest.raises(DeckError, match=r"deck\.inp:6: has 'x' in field 2"):
        number_table(node, "nodes", least=1, most=4)


def test_a_trailing_comma_does_not_swallow_data(tmp_path: Path) -> None:
    first, second = cards_of(tmp_path, "*BOUNDARY,\n2, 1, 1\n*NSET, NSET=a,\n1, 2\n")
    assert first.row("").fields == ("2", "1", "1")
    assert second.row("").fields == ("1", "2")


def test_files_are_included_where_they_are_named(tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "nodes.inc").write_text("1, 0.\n*NODE\n2, 1.\n")
    first, second, last = cards_of(tmp_path, "*NODE\n*INCLUDE, INPUT=more/nodes.inc\n*STATIC\n")
    assert first.row("").fields == ("1", "0.")
    assert (second.path.name, second.line, last.line) == ("nodes.inc", 2, 3)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/etc/passwd", "not near the deck"),
        ("/dev/zero", "not near"),
        ("none.inc", "there is no file"),
        ("", "no INPUT"),
    ],
)
def test_only_files_near_the_deck_are_included(tmp_path: Path, name: str, said: str) -> None:
    with pytest.raises(DeckError, match=rf"deck\.inp:2: \*INCLUDE: .*{said}"):
        cards_of(tmp_path, f"*NODE\n*INCLUDE, INPUT={name}\n")


def test_a_file_that_includes_itself_ends(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match="include itself"):
        cards_of(tmp_path, "*INCLUDE, INPUT=deck.inp\n")


def test_files_that_include_each_other_many_times_end(tmp_path: Path) -> None:
    """Seven files, ten million includes."""
    for k in range(7):
        (tmp_path / f"{k}.inc").write_text(f"*INCLUDE, INPUT={k + 1}.inc\n" * 10)
    (tmp_path / "7.inc").write_text("*NODE\n")
    with pytest.raises(DeckError, match="is the 1001th file that is included; expected at most 1000"):
        cards_of(tmp_path, "*INCLUDE, INPUT=0.inc\n")


def test_records_go_on_over_lines(tmp_path: Path) -> None:
    (card,) = cards_of(tmp_path, "*ELEMENT\n1, 11, 12,\n13\n2, 21,\n** in between\n22, 23\n")
    assert record_table(card, 4, "").tolist() == [[1, 11, 12, 13], [2, 21, 22, 23]]
    for wrong, said in (
        ("1, 2, 3, 4, 5", r"deck\.inp:2: .*5 numbers"),
        ("1, 2, 3", "ends after 3"),
        ("1,2.5,3,4", "2.5"),
    ):
        (card,) = cards_of(tmp_path, f"*ELEMENT\n{wrong}\n")
        with pytest.raises(DeckError, match=said):
            record_table(card, 4, "")


@given(
    st.lists(
        st.lists(
            st.sampled_from(["1", "-2.5", "3.E2", " .5", "4D-1", "", " ", "7 ", "x", "1 2"]), min_size=1, max_size=4
        ),
        min_size=1,
        max_size=5,
    )
)
def test_bulk_reading_is_reading_line_by_line(rows: list[list[str]]) -> None:
    """The fast way answers exactly what the slow way does, or leaves it to it."""
    text = "\n".join(",".join(row) for row in rows).encode()
    fast = Card(keyword="NODE", parameters={}, path=Path("d"), line=1, chunks=[(Path("d"), 2, text)])
    slow = list(fast.rows())
    try:
        expected = [[row.number(i, "", 0.0 if i else None) for i in range(4)] for row in slow]
    except DeckError:
        with pytest.raises(DeckError):
            number_table(fast, "", least=1, most=4)
    else:
        assert np.array_equal(number_table(fast, "", least=1, most=4), np.array(expected).reshape(-1, 4))
