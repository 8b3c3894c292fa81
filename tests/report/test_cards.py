# SPDX-License-Identifier: BSD-3-Clause
"""Everything public is said in a few lines, and has a card in a notebook that holds its numbers and no foreign HTML."""

import dataclasses
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.report.sketch import sketch_model
from signorini.short import Short

EXAMPLES = Path(__file__).parents[2] / "examples"
NASTY = "<script>alert('x')</script> & \"more\""
VOID = {"path", "br", "img"}


class Balance(HTMLParser):
    """Tags that are open, and names of all."""

    def __init__(self, text):
        super().__init__()
        self.open, self.names = [], set()
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.names.add(tag)
        self.open.append(tag)
        assert not any(name.startswith("on") for name, _ in attrs)

    def handle_startendtag(self, tag, _):
        self.names.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def solution():
    mesh = sg.rectangle(width=2.0, nx=2)
    mesh = dataclasses.replace(
        mesh, boundaries={NASTY if name == "bottom" else name: b for name, b in mesh.boundaries.items()}
    )
    return sg.solve(
        sg.Model(
            mesh,
            bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
            supports=[sg.Support("left", u=(0, None), name=NASTY + "s")],
            loads=[sg.Load("top", pressure=3.0, name=NASTY + "l")],
            contacts=[sg.Contact(NASTY, sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.2)],
            title=NASTY,
            units=NASTY,
        )
    )


def test_cards_hold_their_numbers_and_escape_names(solution):
    model, step, contact = solution.model, solution.last, solution.last.contacts[0]
    cards = [thing._repr_html_() for thing in (model, solution, step, contact, step.certificate)]
    for text in cards:
        names = Balance(text).names
        assert "script" not in names
        assert "table" in names
        assert len(text) < 20_000
    assert "(0, 6)" in cards[1]
    assert "(0, 6)" in cards[3]
    assert ">3<" in cards[3]
    assert "solved and certified" in cards[1]
    assert "1e-08" in cards[4]
    assert cards[0].count("&lt;script&gt;") >= 4
    assert "6 nodes" in cards[0]


def test_what_has_no_card_is_said_in_words(solution):
    assert solution.last.instants[0]._repr_html_() is None


def test_a_failure_has_a_card_too():
    model = sg.Model(
        sg.rectangle(),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", pressure=-3.0)],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))],
    )
    failed = sg.solve(model, raise_on_failure=False)
    assert "no_equilibrium" in failed._repr_html_()


def test_everything_public_is_short(solution):
    prepared = sg.prepare(solution.model)
    many = np.arange(600.0)
    things = [
        *(
            solution,
            solution.model,
            solution.model.mesh,
            solution.last,
            solution.last.certificate,
            solution.last.contacts[0],
        ),
        *(
            solution.end,
            solution.stress("block"),
            solution.along([(1.0, 0.5)], body="block"),
            solution.stress_history("block"),
        ),
        *(prepared, sg.check(solution.model), sg.paper.formulate(solution.model, E_n=1e4, E_tau=1e4)),
        sg.lcp.solve(np.eye(300), -np.ones(300)),
        sg.lcp.LCP(M=np.eye(300), q=-np.ones(300)),
        sg.Load("a", nodal_forces=np.ones((300, 2))),
        sg.Along("x", at=many, values=many),
        sg.NodeValues(many),
        sg.Profile([(x, 0.0) for x in many]),
        sg.Plastic([(x, 5.0 + x) for x in many]),
        sg.Closure([(x, x) for x in many]),
        sg.Step(scale={"a": many.tolist()}),
        sg.Contact("a", "b", friction=sg.Along("x", at=many, values=many)),
        sg.solve(solution.model, wellposed=True).wellposedness,
        solution.fatigue(sg.fatigue.SWT(), where="block"),
    ]
    for thing in things:
        words = repr(thing)
        assert words.count("\n") < 12, words
        assert len(words) < 900, words
        assert " object at 0x" not in words, words


def test_results_with_arrays_are_short_by_their_class():
    """Whatever is added to `sg.__all__`."""
    for name in sg.__all__:
        kind = getattr(sg, name)
        if isinstance(kind, type) and dataclasses.is_dataclass(kind) and not issubclass(kind, Short):
            arrays = [field.name for field in dataclasses.fields(kind) if re.search(r"Array\b", str(field.type))]
            assert name in ("Mesh", "Contact") or not arrays, (name, arrays)


def test_bodies_are_sketched_by_their_outlines():
    model = sg.Model(sg.rectangle(nx=3, ny=2), bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))])
    way = re.search(r'd="([^"]*)"', sketch_model(model))[1]
    assert way.count("M") == 1
    assert way.count("L") == 10  # edges around 3 x 2 cells
    box = sg.Model(sg.box(x=[0, 1], y=[0, 1], z=[0, 1]), bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))])
    assert re.search(r'd="([^"]*)"', sketch_model(box))[1].count("M") == 24  # both faces at every edge


def test_a_rigid_obstacle_is_sketched_where_it_fills_the_drawing():
    model = sg.Model(
        sg.rectangle(width=2.0, nx=3, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)))],
    )
    floor, block = re.findall(r'd="([^"]*)"', sketch_model(model, width=224))
    margin, ground = 0.12, 112.0  # 0.06 of the width of 2 around it; 224 across 2.24
    assert floor == f"M0.0 {ground + 100 * margin:.1f}L224.0 124.0L224.0 112.0L0.0 112.0Z"
    assert block.startswith("M12.0 112.0")
