# SPDX-License-Identifier: BSD-3-Clause
"""What wears says so, in Python and in decks, and is refused where it makes no sense."""

from dataclasses import replace
from pathlib import Path

import pytest

import signorini as sg
from signorini.deck.write import write_deck
from signorini.gallery.wearing import rubbed_cylinder, to_and_fro

FLOOR = sg.Plane((0.0, 0.0), (0.0, 1.0))
MODEL = rubbed_cylinder(to_and_fro(2, block="auto"), spacing=0.05)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: sg.Wear(), "has neither of coefficient and energy; expected one of them"),
        (lambda: sg.Wear(1e-8, energy=1e-8), "has both of coefficient and energy; expected one of them"),
        (lambda: sg.Wear(-1e-8), "coefficient: is -1e-08; expected a number >= 0"),
        (lambda: sg.Wear(0.0), "is 0 on both sides, and nothing wears; expected a coefficient > 0"),
        (lambda: sg.Wear(energy=1e-8, mortar="soft"), "mortar: is 'soft'; expected a number"),
        (
            lambda: sg.Contact("a", "b", friction="tied", wear=sg.Wear(1e-8)),
            "wear: is given, but the contact is tied, and nothing wears",
        ),
        (
            lambda: sg.Contact("a", "b", friction="stick", wear=sg.Wear(1e-8)),
            "wear: is given, but the contact never slips, and nothing wears",
        ),
        (
            lambda: sg.Contact("a", "b", wear=sg.Wear(energy=1e-8)),
            "wear.energy: goes by the work of friction, and the contact has none; expected a coefficient",
        ),
        (
            lambda: sg.Contact("a", FLOOR, friction=0.1, wear=sg.Wear(1e-8, mortar=2e-8)),
            "wear.mortar: is 2e-08, but the other side is a rigid obstacle, which does not wear; expected 0",
        ),
        (lambda: sg.Step(block=0), "block: is 0; expected a whole number >= 1"),
        (lambda: sg.Step(block="all"), "block: unknown number of cycles 'all'. Known: auto"),
        (
            lambda: replace(MODEL, contacts=[replace(MODEL.contacts[0], wear=None)]),
            "step[1].block: is given, but no contact wears",
        ),
        (
            lambda: replace(
                MODEL, bodies=[sg.Body("pad", sg.Elastic(2e5, 0.3, plastic=sg.Plastic(900.0))), MODEL.bodies[1]]
            ),
            "contact[0].wear: is given, but 'pad' yields; expected elastic bodies where sides wear",
        ),
    ],
)
def test_what_makes_no_sense_is_refused(make, words):
    with pytest.raises(sg.InputError) as caught:
        make()
    assert str(caught.value).startswith(words)


def test_wear_needs_the_condensed_interface():
    with pytest.raises(sg.InputError) as caught:
        sg.prepare(MODEL, backend="iterative")
    assert str(caught.value).startswith(
        "contact[0].wear: needs the condensed interface, and this model is solved by iteration"
    )


def test_the_paper_knows_no_wear():
    with pytest.raises(sg.InputError) as caught:
        sg.paper.formulate(MODEL, E_n=1e6, E_tau=1e6)
    assert str(caught.value) == "contact[0].wear: the paper's sides do not wear; expected none"


def test_a_deck_says_what_a_model_does(tmp_path: Path):
    path, _ = write_deck(MODEL, tmp_path / "deck.toml")
    read = sg.read(path)
    assert read.contacts[0].wear == MODEL.contacts[0].wear
    assert read.steps[1].block == "auto"
    path.write_text(path.read_text().replace("coefficient", "coeficient"))
    with pytest.raises(sg.InputError) as caught:
        sg.read(path)
    assert (
        "contact[0].wear.coeficient: unknown key; did you mean 'coefficient'? Known: coefficient, energy, mortar, "
        "move_mesh" in str(caught.value)
    )
