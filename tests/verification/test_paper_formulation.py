# SPDX-License-Identifier: BSD-3-Clause
"""The paper's formulation, literally, against the one formulation with the interface compliance 1/E."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from signorini import lcp
from signorini.engine.paper import formulate, solve_literally
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.gallery.blocks import dragged_block
from signorini.gallery.cylinder import FORCE, E, zhu_cylinder
from signorini.gallery.press_fit import press_fit
from signorini.model.step import Step


def held_by_contact_alone(friction=0.4):
    """Pressed and pushed at once on a rough plane, no support at all."""
    return replace(dragged_block(friction=friction), steps=[Step(name="both")])


MODELS = {
    "cylinder, mu 0": (functools.partial(zhu_cylinder, friction=0.0), E),
    "cylinder, mu 0.4": (functools.partial(zhu_cylinder, friction=0.4), E),
    "two bodies": (functools.partial(press_fit, friction=0.2), 1000.0),
    "held by contact alone": (held_by_contact_alone, 100.0),
}


def compliant(model, E_n, E_tau):
    contacts = [replace(c, normal_compliance=1 / E_n, tangential_compliance=1 / E_tau) for c in model.contacts]
    return replace(model, contacts=contacts)


@pytest.mark.slow
@pytest.mark.parametrize("tangential", [1.0, 0.3, 20.0])
@pytest.mark.parametrize("factor", [1.0, 10.0, 100.0, 1e3])
@pytest.mark.parametrize("name", MODELS)
def test_both_formulations_agree(name, factor, tangential):
    make, modulus = MODELS[name]
    model = make()
    E_n, E_tau = factor * modulus, tangential * factor * modulus
    literal = solve_literally(formulate(model, E_n=E_n, E_tau=E_tau))
    assert literal.solved, literal.message
    step = solve(compliant(model, E_n, E_tau)).last
    (contact,) = step.contacts
    size = contact.pressure.max()
    # the condition number grows with the penalty, and so may the rounding
    rounding = 1e-15 * literal.condition * size + 1e-11 * size
    np.testing.assert_allclose(literal.pressure, contact.pressure, rtol=0, atol=rounding)
    np.testing.assert_allclose(literal.traction, contact.traction, rtol=0, atol=rounding)
    u = np.abs(step.displacement).max()
    np.testing.assert_allclose(literal.displacement, step.displacement, rtol=0, atol=u * rounding / size)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_the_lcp_is_the_papers(friction):
    """Its M and q, solved by another method, give the tractions of the law: f = U u_c + V lambda, nu = -f."""
    formulation = formulate(zhu_cylinder(friction=friction), E_n=10 * E, E_tau=5 * E)
    problem = formulation.problem
    found = lcp.solve(formulation.M, formulation.q, method=lcp.Lemke(covering=problem.covering))
    assert found.solved
    _, P = problem.recover(found.z)
    tau, n = P.T
    f = np.column_stack([tau + friction * n, -tau + friction * n, n])
    nu = (formulation.M @ found.z + formulation.q).reshape(-1, 3)
    np.testing.assert_allclose(nu, -f, rtol=0, atol=1e-10 * np.abs(P).max())
    multipliers = found.z.reshape(-1, 3)
    assert multipliers.min() >= 0
    np.testing.assert_allclose(multipliers * nu, 0.0, atol=1e-10)
    # opposite slips at once leave the tractions alone: the paper's law does not see them
    both = np.tile([1.0, 1.0, 0.0], len(P))
    np.testing.assert_allclose(formulation.M @ both, 0.0, atol=1e-9 * np.abs(formulation.M).max())


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_a_penalty_too_large_is_said_not_hidden(friction):
    model = zhu_cylinder(friction=friction)
    answer = solve_literally(formulate(model, E_n=1e14 * E, E_tau=1e14 * E))
    assert not answer.solved
    assert not answer.certificate.passed
    assert answer.condition > 1e14
    assert "condition number of K_c" in answer.message or "was not solved" in answer.message
    # the same law without the penalty's conditioning is no trouble
    step = solve(compliant(model, 1e14 * E, 1e14 * E)).last
    assert step.certificate.passed
    np.testing.assert_allclose(step.contacts[0].normal_force[1], FORCE / 2, rtol=1e-10)


def test_the_loss_of_accuracy_grows_with_the_penalty():
    conditions = [
        solve_literally(formulate(zhu_cylinder(friction=0.0), E_n=10.0**k * E, E_tau=10.0**k * E)).condition
        for k in (2, 6, 10)
    ]
    np.testing.assert_allclose(np.diff(np.log10(conditions)), 4.0, atol=0.1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction": "stick"}, r"contact\[0\]: the paper's law has a finite friction and its own penalties"),
        ({"normal_compliance": 1.0}, r"contact\[0\]: the paper's law has a finite friction and its own penalties"),
    ],
)
def test_what_the_paper_does_not_have(change, message):
    model = zhu_cylinder()
    model = replace(model, contacts=[replace(model.contacts[0], **change)])
    with pytest.raises(InputError, match=message):
        formulate(model, E_n=1.0, E_tau=1.0)


@pytest.mark.parametrize("penalties", [(0.0, 1.0), (1.0, -1.0), (np.nan, 1.0)])
def test_penalties_are_positive(penalties):
    with pytest.raises(InputError, match="expected a number > 0"):
        formulate(zhu_cylinder(), E_n=penalties[0], E_tau=penalties[1])
