# SPDX-License-Identifier: BSD-3-Clause
"""Bonds: what is none, and what they bear and take over their opening."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.law.cohesion import PairCohesion, bonded


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"strength": 0.0}, "strength: is 0.0; expected a number > 0"),
        ({"strength": "much"}, "strength: is 'much'; expected a number > 0"),
        ({"strength": 1.0, "opening": -1.0}, "opening: is -1.0; expected a number >= 0"),
        ({"strength": 1.0, "shear_strength": 0.0}, "shear_strength: is 0.0; expected a number > 0"),
        (
            {"strength": 1.0, "shear_strength": 1.0, "shear": "free"},
            'shear_strength: is given, but the sides are "free" to slide',
        ),
        ({"strength": 1.0, "shear": "loose"}, "shear: unknown shear 'loose'. Known: free, held"),
    ],
)
def test_what_is_no_bond(given, told):
    with pytest.raises(sg.InputError) as caught:
        sg.Cohesion(**given)
    assert str(caught.value) == told


def test_energy_stands_for_the_opening():
    assert sg.Cohesion.by_energy(4.0, energy=0.1, shear="free") == sg.Cohesion(4.0, opening=0.05, shear="free")
    with pytest.raises(sg.InputError, match=r"energy: is 0.0; expected a number > 0"):
        sg.Cohesion.by_energy(4.0, energy=0.0)


@pytest.mark.parametrize(
    ("other", "told"),
    [
        ({"friction": "tied"}, "the contact is tied"),
        ({"closure": sg.Closure([(0, 0), (1, 1)])}, "a closure too"),
        ({"wear": sg.Wear(1e-8)}, "the contact wears"),
        ({"sliding": "finite"}, "the sides slide far"),
        ({"friction": 0.1, "adhesion": 2.0}, "adhesion or a shear limit too"),
        ({"friction": sg.TabularFriction([1.0], [0.1])}, "friction is not Coulomb's with one coefficient"),
    ],
)
def test_what_a_bond_does_not_go_with(other, told):
    with pytest.raises(sg.InputError) as caught:
        sg.Contact("a", "b", cohesion=sg.Cohesion(1.0), **other)
    assert str(caught.value) == f"cohesion: is given, but {told}; expected one of both"


def test_a_contact_takes_a_bond_alone():
    with pytest.raises(sg.InputError, match="is 3; expected a Cohesion"):
        sg.Contact("a", "b", cohesion=3)


def test_tension_falls_with_the_opening_and_goes_back_to_the_closed_state():
    """The line of softening, back to the origin, up the same way, and on; the energy taken is that between both."""
    pairs = PairCohesion(
        most=np.array([4.0]), opening=np.array([0.2]), sticks=np.ones(1, bool), along=np.full(1, np.inf)
    )
    bonds = pairs.unharmed
    assert pairs.holds(bonds).all()
    for opening, tension, taken in (
        (0.05, 3.0, 0.1),
        (0.025, 1.5, 0.1),
        (0.0, 0.0, 0.1),
        (0.05, 3.0, 0.1),
        (0.1, 2.0, 0.2),
        (0.3, 0.0, 0.4),
        (0.1, 0.0, 0.4),
    ):
        gap = np.array([opening])
        bonds = pairs.after(bonds, gap)
        assert_allclose(pairs.tension(bonds, gap), tension, atol=1e-15)
        assert_allclose(bonds.taken, taken, rtol=1e-14)
        assert not pairs.holds(bonds).any()


def test_pairs_that_touch_are_bonded():
    contact, gap = np.array([0, 0, 1, 1]), np.array([1e-12, 0.1, 0.0, -0.2])
    gaps, pairs = bonded([sg.Cohesion(3.0), None], contact, gap, np.full(4, 2.0), 1.0)
    assert pairs.most.tolist() == [6.0, 0.0, 0.0, 0.0]
    assert gaps.tolist() == [0.0, 0.1, 0.0, -0.2]
    assert pairs.unharmed.damage.tolist() == [0.0, 1.0, 1.0, 1.0]
    with pytest.raises(sg.InputError, match=r"contact\[1\].cohesion: bonds nothing: no pair touches"):
        bonded([None, sg.Cohesion(3.0)], contact, np.full(4, 0.1), np.ones(4), 1.0)
