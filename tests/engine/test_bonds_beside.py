# SPDX-License-Identifier: BSD-3-Clause
"""Bonds in models that have more: overlaps, sectors, ties and other laws beside them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.gallery.cohesion import BAR_LENGTH, BAR_MODULUS, bonded_bar
from signorini.gallery.sectors import SECTORS, ring_on_shaft

GENTLE = sg.Cohesion(5.0, opening=0.02)


@pytest.mark.parametrize("compliance", [0.0, 1e-3])
def test_an_overlap_presses_before_its_bond_is_drawn(compliance):
    overlap, stretch = 0.001, 0.013
    model = bonded_bar(GENTLE, stretch, compliance=compliance)
    pressed = replace(model, contacts=[replace(model.contacts[0], interference=overlap)])
    step = sg.solve(pressed).steps[0]
    soft = BAR_LENGTH / BAR_MODULUS + compliance
    opening = ((stretch - overlap) / soft - 5.0) / (1.0 / soft - 250.0)
    assert_allclose(step.contacts[0].pressure, (opening - stretch + overlap) / soft, rtol=1e-12)
    assert [event.load_factor for event in step.events] == pytest.approx([(5.0 * soft + overlap) / stretch])
    assert abs(step.energy_defect) < 1e-14


@pytest.mark.parametrize("bond", [sg.Cohesion(0.03, opening=0.002), sg.Cohesion(0.03)])
def test_a_sector_that_is_torn_off_is_the_whole_ring(bond):
    """The sides of the sector cut the bonded contact; some of it opens, closes again, and opens farther."""
    both = []
    for whole in (True, False):
        model = ring_on_shaft(whole=whole)
        contacts = [replace(model.contacts[0], interference=0.0, cohesion=bond)]
        steps = [sg.Step(scale={"drag": 0.1 * size, "lobes": size}) for size in (1.0, 0.2, 2.0)]
        both.append(sg.solve(replace(model, contacts=contacts, steps=steps)).steps)
    for ring, sector in zip(*both, strict=True):
        one, own = ring.contacts[0], sector.contacts[0]
        at = [int(np.argmin(np.linalg.norm(one.points - point, axis=1))) for point in own.points]
        largest = np.abs(one.pressure).max()
        assert_allclose(own.pressure, one.pressure[at], rtol=0, atol=1e-9 * largest)
        assert_allclose(own.damage, one.damage[at], rtol=0, atol=1e-9)
        assert SECTORS * sector.work == pytest.approx(ring.work, rel=1e-9)
    assert (own.damage == 0.0).any()
    assert SECTORS * sector.dissipation == pytest.approx(ring.dissipation, rel=1e-9)


@pytest.mark.parametrize(
    ("lift", "other"),
    [
        (4.0, {"friction": "tied"}),
        (1.2, {"friction": sg.TabularFriction([0.5, 2.0], [0.5, 0.3])}),
        (1.2, {"friction": 0.2, "adhesion": 0.1, "shear_limit": 0.6}),
    ],
)
def test_other_contacts_have_laws_of_their_own(lift, other):
    """A block between a bond below and another law above, where a lid presses it on and drags it off."""
    blocks = {
        "lid": sg.rectangle(width=2.0, height=0.5, nx=3, ny=1, origin=(0, 1)),
        "block": sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
    }
    model = sg.Model(
        sg.join(blocks),
        kind="plane stress",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.2)) for name in blocks],
        supports=[sg.Support("lid.top", u=(0.002, -0.0005), name="drag")],
        loads=[sg.Load("block.right", traction=(0.0, lift), name="lift")],
        contacts=[
            sg.Contact("lid.bottom", "block.top", name="lid", **other),
            sg.Contact("block.bottom", sg.Plane((0, 0), (0, 1)), cohesion=sg.Cohesion(1.0, opening=0.02), name="bond"),
        ],
    )
    step = sg.solve(model).steps[0]
    by_name = {contact.name: contact for contact in step.contacts}
    assert 0.0 < by_name["bond"].damage.max() < 1.0
    assert np.abs(by_name["lid"].traction).max() > 0.0
    assert step.certificate.passed
    assert abs(step.energy_defect) < 1e-12 * abs(step.work)
