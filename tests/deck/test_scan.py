# SPDX-License-Identifier: BSD-3-Clause
"""The scanner of lines against the standard parser: it must see the same document."""

import tomllib
from typing import Any

import hypothesis.strategies as st
import pytest
from hypothesis import given, settings

from signorini.deck.syntax import line_of, scan

HARD = '''\
# a comment with [brackets] and "quotes"
"quoted key" = 'literal # no comment'
a.b.c = """three
lines # of text
]""" # after it
inline = { x = [1, 2,
  3], y = { z = "}" } }

[table."with dots.inside"]
array = [
    # comment
    [1, 2],  # nested
    { key = 3 }, "a]b",
]
[[list]]
n = 1
[list.sub]
deep = true
[[list]]
n = 2
[list.sub]
date = 1979-05-27T07:32:00Z
[[list.inner]]
m = "\\"]"
[[list.inner]]
m = 2
'''


def paths(value: Any, at: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every path of a parsed document but the root."""
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [at] * bool(at) + [path for key, child in children for path in paths(child, (*at, key))]


def test_hard_document() -> None:
    lines = scan(HARD)
    missing = [path for path in paths(tomllib.loads(HARD)) if line_of(lines, path) is None]
    assert not missing
    found = {path: lines[path] for path in lines if path[-1] in ("m", "z", "key", "date", "deep", "c")}
    assert found == {
        ("a", "b", "c"): 3,
        ("inline", "y", "z"): 7,
        ("table", "with dots.inside", "array", 1, "key"): 13,
        ("list", 0, "sub", "deep"): 18,
        ("list", 1, "sub", "date"): 22,
        ("list", 1, "inner", 0, "m"): 24,
        ("list", 1, "inner", 1, "m"): 26,
    }
    assert lines["list", 0] == 15
    assert lines["list", 1] == 19
    assert lines["table", "with dots.inside", "array", 2] == 13


def test_windows_line_ends() -> None:
    assert scan("a = 1\r\nb = [\r\n2]\r\n") == {("a",): 1, ("b",): 2, ("b", 0): 3}


NAMES = st.text("abcXYZ019_-", min_size=1, max_size=4)
LEAVES = st.one_of(
    st.integers(-9, 9).map(str),
    st.booleans().map(lambda value: str(value).lower()),
    st.text("ab#[]{}=,. '", max_size=6).map(lambda text: f'"{text}"'),
)
VALUES = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(lambda parts: f"[{','.join(f'{chr(10)} {part}' for part in parts)}]"),
        st.dictionaries(NAMES, inner, max_size=3).map(
            lambda parts: f"{{{', '.join(f'{key} = {part}' for key, part in parts.items())}}}"
        ),
    ),
    max_leaves=6,
)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.dictionaries(NAMES, VALUES, max_size=4), st.lists(st.dictionaries(NAMES, VALUES, max_size=3), max_size=3))
def test_every_key_has_the_line_it_stands_on(top: dict[str, str], entries: list[dict[str, str]]) -> None:
    text = "".join(f"{key} = {value}\n" for key, value in top.items())
    for entry in entries:
        text += "[[many]]\n" + "".join(f"{key} = {value}\n" for key, value in entry.items())
    if "many" in top:
        return
    data, lines = tomllib.loads(text), scan(text)
    assert set(lines) == set(paths(data))
    for path, line in lines.items():
        if isinstance(path[-1], str) and path != ("many",):
            assert path[-1] in text.splitlines()[line - 1]


@pytest.mark.parametrize("where", [("list", 0, "sub", "deep", "er"), ("list", 0, "sub", "missing")])
def test_nearest_line(where: tuple[str | int, ...]) -> None:
    assert line_of(scan(HARD), where) in (17, 18)
