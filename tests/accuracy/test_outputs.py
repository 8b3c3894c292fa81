"""An accuracy of a named output: the number that was asked for is as true as it is said to be."""

import json
from dataclasses import replace

import pytest

import signorini as sg
from benchmarks.accuracy_variations import variation
from signorini.accuracy.goals import Goal
from signorini.engine.solve import solve
from signorini.engine.tape import Tape
from signorini.gallery import coarse
from signorini.model.output_words import output_of
from tests.accuracy.test_refine import run

PEAK, WIDTH = 38.1643, 2.6473
"""Largest pressure and half-width of the paper's cylinder on a mesh of 50,000 nodes that was refined for each."""

FRICTION = 51.61
"""Of `variation("quarter of a disk", 0)`: 51.7160 with 169 pairs that touch, 51.6626 with their facets halved, 51.643
with about 480, where errors fall with the length of facets."""


@pytest.mark.parametrize(("output", "true"), [("peak pressure", PEAK), (sg.halfwidth("seat", about=(0.0, 0.0)), WIDTH)])
def test_an_output_is_as_accurate_as_asked(output, true):
    solution = sg.solve(coarse.cylinder(), accuracy=sg.Accuracy(0.001, of=output))
    found = solution.accuracy
    assert found.met
    assert len(found.levels) >= 3
    assert found.value == found.levels[-1].value
    assert found.levels[-1].nodes == len(solution.model.mesh.points)
    assert found.levels[0].output > 0.1
    assert abs(found.value / true - 1.0) <= 0.001
    assert found.output <= 0.001
    for level in found.levels[2:]:
        assert 0.7 <= level.output / abs(level.value / true - 1.0) <= 3.0


def test_a_force_of_friction_that_fell_from_one_side_and_turns():
    """Its changes from mesh to mesh told 0.5 % where 2.2 % is true: that contacts end between nodes is remembered."""
    of = sg.force("seat", along=(1.0, 0.0), of="friction")
    found = sg.solve(variation("quarter of a disk", 0), accuracy=sg.Accuracy(0.01, of=of)).accuracy
    assert found.met
    assert abs(found.value / FRICTION - 1.0) <= 0.01
    for level in found.levels[2:]:
        assert 0.65 <= level.output / abs(level.value / FRICTION - 1.0) <= 2.0


def test_an_output_that_the_first_mesh_has_not():
    """One pair touches there, and has no half-width yet: what halving its facets changes is not known."""
    found = sg.solve(coarse.hertz_line(), accuracy=sg.Accuracy(0.05, of="half-width about (0, 0)")).accuracy
    assert found.met
    assert found.levels[0].output is None
    assert abs(found.value - 1.0) <= 0.05


@pytest.mark.slow
def test_cells_are_refined_by_what_counts_for_the_output():
    """The largest pressure is at the pole: two thirds of the nodes that the pressure of the whole side needs."""
    of = sg.pressure("seat").peak
    peak, whole = (sg.solve(coarse.cylinder(), accuracy=sg.Accuracy(0.005, of=what)) for what in (of, "pressure"))
    assert 3 * peak.accuracy.levels[-1].nodes < 2 * whole.accuracy.levels[-1].nodes


@pytest.mark.slow
def test_errors_of_stresses_tell_by_their_sign_whether_an_output_is_too_large():
    """A force that moves two cylinders, where facets are halved until they lack less than the stresses do."""
    model, of = coarse.two_cylinders(), sg.force("seat", along=(0.0, 1.0))
    rough, fine = (sg.solve(model, accuracy=sg.Accuracy(error, of=of)) for error in (0.005, 3e-4))
    tape = Tape()
    solve(rough.model, tape=tape)
    _, _, lacks = Goal(of).products(rough.model, tape)
    assert 0.7 <= lacks / (fine.accuracy.value - rough.accuracy.value) <= 2.0


def test_nodes_are_those_of_the_mesh_to_begin_with():
    model = coarse.cylinder()
    (top,) = (n for n, (x, y) in enumerate(model.mesh.points) if (x, y) == (0.0, 8.0))
    found = sg.solve(model, accuracy=sg.Accuracy(0.05, of=sg.displacement(top, along=(0.0, 1.0)))).accuracy
    assert found.met
    assert found.value == pytest.approx(-0.7446, rel=0.02)


@pytest.mark.parametrize(
    "output",
    [
        sg.pressure("a b").peak,
        sg.pressure("c").mean(),
        sg.pressure("c")[12],
        sg.gap("c")[3].after(1.5),
        sg.force("c", along=(1.0, -0.5)),
        sg.force("c", along=(0.0, 0.0, 1.0), of="friction"),
        sg.moment("c", about=(0.0, 1.0)),
        sg.dissipation(),
        sg.dissipation("c"),
        sg.displacement(4, along=(0.0, 1e-3)),
        sg.stress("pad", 7, "xy"),
    ],
)
def test_outputs_are_read_by_the_words_that_they_print(output):
    assert output_of(repr(output)) == output


def test_a_deck_and_the_command_line_name_an_output(tmp_path, capsys):
    assert run(tmp_path, "[solve]\naccuracy = 0.05\nof = 'peak pressure'") == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())["accuracy"]
    assert summary["asked"] == {"error": 0.05, "of": "peak pressure of 'arc'"}
    assert abs(summary["value"] / PEAK - 1.0) <= 0.05
    assert summary["output"] <= 0.05
    told = capsys.readouterr().out
    assert "peak pressure of 'arc': 3" in told
    assert "accuracy 0.05 of the peak pressure of 'arc' met" in told
    assert run(tmp_path, "", "--accuracy", "0.001,of=peak pressure of 'arc',nodes=300") == 0
    assert "NOT met: the next mesh has " in capsys.readouterr().out
    for given, words in (("0.1,of=peek", "unknown kind of accuracy 'peek'"), ("0.1,nods=3", "did you mean 'nodes'")):
        assert run(tmp_path, "", "--accuracy", given) == 2
        assert words in capsys.readouterr().err


def test_no_room_for_halved_facets():
    """What was given is solved, and nothing told of what it lacks; later the last halved mesh is the answer."""
    model = coarse.cylinder()
    for nodes, halved in ((100, False), (500, True)):
        solution = sg.solve(model, accuracy=sg.Accuracy(1e-4, of="peak pressure", nodes=nodes))
        found = solution.accuracy
        assert f"more than {nodes}" in found.reason
        assert found.levels[-1].nodes == len(solution.model.mesh.points) <= nodes
        assert found.value == pytest.approx(solution.contact("seat").pressure.max())
        assert (found.output is not None) == halved


def test_what_ends_it_is_memory_too():
    found = sg.solve(coarse.cylinder(), accuracy=sg.Accuracy(0.001, memory=1e6)).accuracy
    assert len(found.levels) == 1
    assert " GB of memory are expected, more than 0.001 GB" in found.reason


def test_outputs_that_have_no_derivative_are_named():
    model = coarse.cylinder()
    for wrong, words in (
        ("peak pressure of 'sead'", "unknown contact 'sead'"),
        (sg.displacement(1000, along=(0, 1)), "is node 1000; expected the number of a corner"),
        (sg.pressure("seat").mean(weights=[1.0]), "weights belong to one mesh"),
    ):
        with pytest.raises(sg.InputError, match=words):
            sg.solve(model, accuracy=sg.Accuracy(0.1, of=wrong))
    worn = replace(model, steps=[sg.Step(name="one"), sg.Step(name="two", release=("axis",), hold=())])
    with pytest.raises(sg.InputError, match="derivatives do not know"):
        sg.solve(worn, accuracy=sg.Accuracy(0.1, of="peak pressure"))
