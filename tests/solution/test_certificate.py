# SPDX-License-Identifier: BSD-3-Clause
"""The certificate sees every way in which a state can be wrong, and each in its own number."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.law.states import OPEN, STICK
from signorini.solution.certificate import TOLERANCE, Certificate, certify
from signorini.solution.state import initial_state, next_state

NUMBERS = ("equilibrium", "penetration", "tension", "cone", "complementarity")


class Answer:
    """A good answer taken apart: displacement and pair forces, which a test may then spoil."""

    def __init__(self, **options):
        self.prepared = prepare(zhu_cylinder(**options))
        self.step = solve_prepared(self.prepared).last
        (contact,) = self.step.contacts
        self.n = len(contact.node)
        self.u = self.step.displacement.ravel().copy()
        self.r = np.stack([contact.pressure, contact.traction]) * contact.area
        self.closed = np.nonzero(contact.closed)[0]
        self.open = np.nonzero(~contact.closed)[0]
        self.stuck = np.nonzero((contact.status == "stick") & (contact.points[:, 0] > 0))[0]
        self.slipping = np.nonzero(contact.status == "slip")[0]
        self.length, self.force = self.prepared.scale.length, self.prepared.scale.force

    def certificate(self, u=None, r=None):
        p, u, r = self.prepared, self.u if u is None else u, self.r if r is None else r
        factors = p.model.factors()
        before = initial_state(factors[0], np.zeros(len(u)), p.interface)
        state = next_state(
            p,
            before,
            point=replace(before.point, factors=factors[-1]),
            loads=p.loads["cut"],
            displacement=u,
            forces=r,
            moved=p.interface.motion(u) + np.stack([p.interface.gap, np.zeros(self.n)]),
            status=np.where(r[0] > 0, STICK, OPEN),
        )
        return certify(p, state, loads=p.loads["cut"], before=before.tangential)

    def moved(self, pair, axis, by):
        """The displacement with one contact node moved by a fraction of the length of the data."""
        u = self.u.copy()
        u[2 * self.prepared.interface.node[pair] + axis] += by * self.length
        return u

    def pushed(self, row, pair, by):
        r = self.r.copy()
        r[row, pair] += by * self.force
        return r


@pytest.fixture(scope="module")
def answer():
    return Answer(friction=0.4)


def test_the_good_answer_passes(answer):
    certificate = answer.certificate()
    assert certificate.passed
    assert certificate.worst < 1e-11


def test_equilibrium(answer):
    inside = int(np.setdiff1d(np.arange(answer.n, 80), answer.prepared.interface.node)[-1])
    u = answer.u.copy()
    u[2 * inside + 1] += 1e-3 * answer.length
    certificate = answer.certificate(u=u)
    assert certificate.equilibrium > 1e-4
    assert max(getattr(certificate, name) for name in NUMBERS[1:]) < 1e-11


def test_equilibrium_of_resultants(answer):
    """A force of the supports too many shows on the rigid motions, though every node is in balance."""
    p, r = answer.prepared, answer.r
    factors = p.model.factors()
    state = initial_state(factors[0], np.zeros(len(answer.u)), p.interface)
    external = p.K @ answer.u - p.interface.on_bodies(r)
    wrong = external.copy()
    wrong[2 * p.interface.node[answer.open[-1]] + 1] += 1e-6 * answer.force
    for given, passed in ((external, True), (wrong, False)):
        spoiled = replace(state, displacement=answer.u, forces=r, external=given)
        found = certify(p, spoiled, loads=p.loads["cut"], before=state.tangential)
        assert found.passed is passed


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_penetration(answer, size):
    """An open pair driven through the plane; it also loses equilibrium, as a node does that moves alone."""
    pair = answer.closed[1]
    certificate = answer.certificate(u=answer.moved(pair, 1, -size))
    assert certificate.penetration == pytest.approx(size, rel=1e-6)
    assert max(certificate.tension, certificate.cone) < 1e-11


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_tension(answer, size):
    certificate = answer.certificate(r=answer.pushed(0, answer.open[0], -size))
    assert certificate.tension == pytest.approx(size)
    assert certificate.penetration < 1e-11


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_cone(answer, size):
    pair = answer.slipping[0]
    certificate = answer.certificate(r=answer.pushed(1, pair, size * np.sign(answer.r[1, pair])))
    assert certificate.cone == pytest.approx(size, rel=1e-6)
    assert max(certificate.penetration, certificate.tension) < 1e-11


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_complementarity_of_gap_and_pressure(answer, size):
    """A pair that presses across a gap, and an open pair that presses."""
    lifted = answer.certificate(u=answer.moved(answer.closed[1], 1, size))
    pressing = answer.certificate(r=answer.pushed(0, answer.open[-1], size))
    for certificate in (lifted, pressing):
        assert certificate.complementarity == pytest.approx(size, rel=1e-6)
        assert max(certificate.penetration, certificate.tension, certificate.cone) < 1e-11


@pytest.mark.parametrize("size", [1e-6, 1e-3])
def test_complementarity_of_slip_and_friction(answer, size):
    """A sticking pair that slips, a slipping pair with friction to spare, friction that pushes along the slip."""
    pair = answer.stuck[0]
    assert answer.certificate(u=answer.moved(pair, 0, size)).complementarity == pytest.approx(size, rel=1e-6)
    pair = answer.slipping[0]
    spare = answer.certificate(r=answer.pushed(1, pair, -size * np.sign(answer.r[1, pair])))
    assert spare.complementarity == pytest.approx(size, rel=1e-6)
    assert spare.cone < 1e-11
    along = answer.r.copy()
    along[1, pair] *= -1.0
    assert answer.certificate(r=along).complementarity > 1e-4


@pytest.mark.parametrize("spoil", [np.nan, np.inf])
def test_what_is_not_finite_is_no_solution(answer, spoil):
    u = answer.u.copy()
    u[3] = spoil
    with np.errstate(invalid="ignore"):
        certificate = answer.certificate(u=u)
    assert not certificate.passed
    assert certificate.worst == np.inf


def test_a_body_that_has_left_is_no_solution():
    """Every number would vanish for a free body anywhere: far away is refused all the same."""
    answer = Answer(friction=0.0)
    zero = np.zeros_like(answer.r)
    far = np.zeros_like(answer.u)
    far[1::2] = 1e10 * answer.length
    assert answer.certificate(u=far, r=zero).worst == np.inf
    near = np.zeros_like(answer.u)
    near[1::2] = answer.length
    assert answer.certificate(u=near, r=zero).equilibrium > 0.1  # nothing carries the load


@pytest.mark.parametrize("far", [1e6, 1e7, 1e8])
def test_rounding_of_displacements_is_told_from_an_imbalance(far):
    """A body moved far away stays in equilibrium but for rounding; what a millionth of the load lacks is none."""
    answer = Answer(friction=0.0)
    away = answer.u.copy()
    away[1::2] += far * answer.length
    found = answer.certificate(u=away)
    assert found.rounding == 0.0 or found.equilibrium > TOLERANCE
    assert found.imbalance <= TOLERANCE
    lacking = answer.certificate(u=away, r=answer.pushed(0, answer.closed[0], 1e-5))
    assert lacking.imbalance > TOLERANCE


def test_passed_is_the_tolerance_on_the_worst():
    small = dict.fromkeys(NUMBERS, 0.0)
    for name in NUMBERS:
        assert Certificate(**small | {name: TOLERANCE}).passed
        assert not Certificate(**small | {name: 1.01 * TOLERANCE}).passed
        assert not Certificate(**small | {name: np.nan}).passed
    assert str(Certificate(**small)).count("0.0e+00") == 5
