# SPDX-License-Identifier: BSD-3-Clause
"""Values that vary, as decks say them: read, solved, written again, and told where they are wrong."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.cli import main
from signorini.deck import read

DECK = """\
kind = "plane strain"

[mesh]
generator = "rectangle"
x = [-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0]
y = [0.0, 0.5, 1.0]

[material.steel]
E = 200.0
nu = 0.3
expansion = 1e-5

[[body]]
name = "block"
material = "steel"

[[support]]
on = "left"
u = ["1e-3*y", "free"]

[[load]]
on = "top"
pressure = "1 + 0.1*x"

[[load]]
on = "block"
temperature = "10*y"

[[load]]
on = "right"
traction = ["0.1*y", 0.0]

[[contact]]
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = { x = [-2, 2], mu = [0.1, 0.3] }
interference = "-1e-3*x^2"
"""

PLACE = 'interference = "-1e-3*x^2"'
CROWN = np.linspace(-2.0, 2.0, 9)


def solved(path):
    return sg.solve(read(path)).steps[-1].contacts[0].pressure


def ways(folder):
    """The crown in every way that a deck has."""
    places, depths = CROWN.tolist(), (-1e-3 * CROWN**2).tolist()
    lengths = (CROWN + 2.0).tolist()
    (folder / "arc.csv").write_text("s,crown\n" + "\n".join(f"{s},{c}" for s, c in zip(lengths, depths, strict=True)))
    nodes = "\n".join(f"{i + 1}\t{c}" for i, c in enumerate(depths))
    (folder / "nodes.txt").write_text(f"# measured\nnode\tcrown\n{nodes}\n")
    places_file = "\n".join(f"{x};{y};0;{c}" for x, c in zip(places, depths, strict=True) for y in (-1.0, 1.0))
    (folder / "places.csv").write_text(f"x;y;spare;crown\n{places_file}\n")
    return {
        "along": f"{{ x = {places}, value = {depths} }}",
        "arc length": f"{{ s = {lengths}, value = {depths}, start = [-2, 0] }}",
        "nodes": f"{{ node = {list(range(1, 10))}, value = {depths} }}",
        "table of arc length": '{ file = "arc.csv", start = [-2.0, 0.0] }',
        "table of nodes": '{ file = "nodes.txt" }',
        "table of places": '{ file = "places.csv", column = "crown" }',
    }


def test_every_way_to_say_a_crown_presses_alike(tmp_path):
    deck = tmp_path / "deck.toml"
    deck.write_text(DECK)
    one = solved(deck)
    assert one.max() > 2.0 * one.min()
    for way in ways(tmp_path).values():
        deck.write_text(DECK.replace(PLACE, f"interference = {way}"))
        assert_allclose(solved(deck), one, atol=1e-12)


def test_fields_of_another_program_come_from_its_mesh(tmp_path):
    import meshio

    points = np.array([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [-2.0, 1.0, 0.0]])
    heat = {"T": 10.0 * points[:, 1], "rest": np.ones(4)}
    meshio.write(tmp_path / "heat.vtu", meshio.Mesh(points, {"quad": [[0, 1, 2, 3]]}, point_data=heat))
    deck = tmp_path / "deck.toml"
    deck.write_text(DECK)
    one = solved(deck)
    deck.write_text(DECK.replace('"10*y"', '{ file = "heat.vtu", column = "T" }'))
    assert_allclose(solved(deck), one, atol=1e-12)


def test_what_varies_is_written_into_decks(tmp_path):
    for i, way in enumerate(['"-1e-3*x^2"', *ways(tmp_path).values()][:6]):
        deck, again = tmp_path / f"deck{i}.toml", tmp_path / f"again{i}.toml"
        deck.write_text(DECK.replace(PLACE, f"interference = {way}"))
        assert main(["convert", str(deck), "-o", str(again)]) == 0
        assert_allclose(solved(again), solved(deck), atol=1e-12)


WRONG = {
    "no way": ("{ w = [1], value = [2] }", "contact[0].interference: has w, value; expected a coordinate, s, node or"),
    "two ways": ("{ x = [0], s = [0], value = [2] }", "contact[0].interference.x: unknown key"),
    "no start": ("{ s = [0, 1], value = [2, 3] }", "contact[0].interference: has no 'start'; expected it"),
    "no start of a file": ('{ file = "arc.csv" }', "contact[0].interference: has no 'start'; expected the point"),
    "not increasing": ("{ x = [1, 0], value = [2, 3] }", "contact[0].interference.at: is (1.0, 0.0); expected incr"),
    "no node": ("{ node = [1.5], value = [2] }", "contact[0].interference.nodes: are no whole numbers"),
    "twice": ("{ node = [3, 3], value = [2, 2] }", "contact[0].interference.nodes: name node 3 twice"),
    "no file": ('{ file = "none.csv" }', "contact[0].interference.file: "),
    "no column": ('{ file = "arc.csv", column = "crwn" }', "contact[0].interference.column: 'arc.csv': unknown"),
    "two columns": ('{ file = "places.csv" }', "contact[0].interference: 'places.csv' has 2 columns of values"),
    "formula": ('"-1e-3*u^2"', "contact[0].interference: has 'u'; expected one of x, y, z, pi"),
    "wrong end": ("{ s = [0, 1], value = [2, 3], start = [0, 0, 0] }", "contact[0].interference.start: has 3"),
}


@pytest.mark.parametrize(("given", "said"), WRONG.values(), ids=WRONG.keys())
def test_mistakes_are_told_with_their_line(given, said, tmp_path, capsys, monkeypatch):
    ways(tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "deck.toml").write_text(DECK.replace(PLACE, f"interference = {given}"))
    assert main(["check", "deck.toml"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("signorini: deck.toml:37: " + said), err


def test_check_says_what_is_prescribed(tmp_path, capsys):
    (tmp_path / "deck.toml").write_text(DECK)
    assert main(["check", str(tmp_path / "deck.toml")]) == 0
    assert "u = (1e-3*y, free)" in capsys.readouterr().out
