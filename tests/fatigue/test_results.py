# SPDX-License-Identifier: BSD-3-Clause
"""Criteria along solved histories: beams with closed forms, contacts, archives, and requests that are refused."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.half_planes import equal_half_planes

LIFE = {"strength": 900.0, "strength_exponent": -0.1, "ductility": 0.3, "ductility_exponent": -0.6}
REVERSED = sg.Step(name="reversed", scale={"bend": [-1.0, 1.0]}, repeat=2)


def beam(**fields):
    """A beam of height 2 under a moment that is reversed: ``sigma_xx = 100 y``, on its lower side 100 at most."""
    return sg.Model(
        sg.rectangle(width=4.0, nx=4, y=np.linspace(-1.0, 1.0, 5), cells="quad8"),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Elastic(E=1e5, nu=0.25))],
        supports=[sg.Support("left", u=(0, None)), sg.Support((0.0, 0.0), u=(None, 0))],
        loads=[sg.Load("right", traction=(sg.Formula("100 * y"), 0.0), name="bend")],
        **{"steps": [REVERSED], **fields},
    )


@pytest.fixture(scope="module")
def bent():
    return sg.solve(beam())


def test_a_beam_on_its_side_and_below(bent):
    """The surface, at a depth of L / 2, and on the mean down to 2 L: sigma falls from 100 by 100 a unit of depth."""
    for distance, average, size in ((0.0, "point", 100.0), (0.3, "point", 85.0), (0.3, "line", 70.0)):
        found = bent.fatigue(sg.fatigue.SWT(**LIFE), where="bottom", distance=distance, average=average)
        np.testing.assert_allclose(found.parameter, size**2 / 1e5, rtol=1e-9)
        np.testing.assert_allclose(found.amplitude, size / 1e5, rtol=1e-9)
        np.testing.assert_allclose(found.plane, np.tile([1.0, 0, 0], (9, 1)), atol=1e-6)
        assert np.array_equal(found.points[:, 1], np.full(9, -1.0))
        life = 2.0 * found.life
        np.testing.assert_allclose(900.0**2 / 1e5 * life**-0.2 + 270.0 * life**-0.7, size**2 / 1e5, rtol=1e-9)


def test_gradients_on_the_sides_of_a_beam(bent):
    """sigma_xx is 100 y at most, so that its slope into the beam is what it is on the side with the opposite sign."""
    history = bent.stress_history(("bottom", "top"))
    np.testing.assert_allclose(history.gradient, -history.stress, atol=1e-6)
    assert bent.stress_history("block").gradient.shape == (0, 3, 6)


def test_limits_of_a_beam(bent):
    for kind in (sg.fatigue.Crossland, sg.fatigue.DangVan):
        found = bent.fatigue(kind(bending_limit=200.0, torsion_limit=130.0), where=("bottom", "top"))
        expected = (100.0 / np.sqrt(3.0) if kind is sg.fatigue.Crossland else 50.0) + kind(
            bending_limit=200.0, torsion_limit=130.0
        ).slope * 100.0 / 3.0
        np.testing.assert_allclose(found.parameter, expected / 130.0, rtol=1e-9)
        assert not found.planes
        assert not found.lives


def test_a_whole_body_is_worst_on_its_sides(bent):
    found = bent.fatigue(sg.fatigue.FatemiSocie(yield_stress=300.0), where="block")
    assert len(found.parameter) == len(bent.model.mesh.points)
    assert abs(found.points[found.worst, 1]) == 1.0
    assert found.lives is False


def test_what_a_model_asks_for_is_in_its_archive(tmp_path):
    asked = [sg.Fatigue(sg.fatigue.SWT(**LIFE), where="bottom"), sg.Fatigue(sg.fatigue.SWT(), where="block")]
    solution = sg.solve(beam(fatigue=asked))
    assert [len(result.node) for result in solution.fatigue_results] == [9, len(solution.model.mesh.points)]
    solution.write(tmp_path / "kept.h5")
    again = sg.load(tmp_path / "kept.h5")
    assert again.fatigue_results[0].request == asked[0]
    np.testing.assert_array_equal(again.fatigue_results[0].life, solution.fatigue_results[0].life)
    np.testing.assert_array_equal(
        again.fatigue_results[1].parameter, again.fatigue(sg.fatigue.SWT(), where="block").parameter
    )


def test_what_is_not_known_afterwards_is_a_note(monkeypatch):
    """A solution is never lost for a criterion that cannot be answered."""
    monkeypatch.setattr("signorini.engine.recovery._AGREEMENT_TOL", -1.0)
    asked = sg.Fatigue(sg.fatigue.SWT(), where="bottom")
    solution = sg.solve(beam(fatigue=asked, steps=[sg.Step(name="bend", increments=2)]))
    assert solution.solved
    assert solution.fatigue_results == ()
    assert any(note.startswith("fatigue[0].steps: displacements on the way of 'bend'") for note in solution.last.notes)


def test_ruiz_of_partial_slip():
    """F1 and F2 from the results of the contact itself, and 0 where it sticks."""
    steps = [
        sg.Step(name="press", scale={"press": 1.0}),
        sg.Step(name="cycles", scale={"pull": [0.7, -0.7]}, repeat=2),
    ]
    solution = sg.solve(equal_half_planes(steps, spacing=0.2, size=6.0))
    found = solution.fatigue(sg.fatigue.Ruiz())
    contact, instants = solution.contact("contact"), solution.last.instants
    friction = np.max([abs(instant.contacts[0].traction) for instant in instants if instant.load_factor >= 1.5], axis=0)
    np.testing.assert_array_equal(found.node, contact.node)
    np.testing.assert_allclose(found.amplitude, friction * 0.5 * contact.slip_range, atol=1e-18)
    history = solution.stress_history("contact")
    upper = [
        history.bodies.index("upper") + list(history.node[np.array(history.bodies) == "upper"]).index(n)
        for n in contact.node
    ]
    x, y, xy = (history.stress[upper][..., k] for k in (0, 1, 3))
    t = contact.tangents
    along = t[:, :1] ** 2 * x + t[:, 1:] ** 2 * y + 2.0 * t[:, :1] * t[:, 1:] * xy
    np.testing.assert_allclose(found.stress, along.max(axis=1), atol=1e-12)
    # F2 is that of a moment: at ends of straight parts, and at a thousand places between two of them
    pulled = [instant.contacts[0].traction for instant in instants if instant.load_factor >= 1.5 - 1e-12]
    assert len(pulled) == along.shape[1]
    moments, fine = np.arange(len(pulled)), np.linspace(0.0, len(pulled) - 1, 1000 * (len(pulled) - 1) + 1)
    for k in range(len(contact.node)):
        q, s = np.interp(fine, moments, np.array(pulled)[:, k]), np.interp(fine, moments, along[k])
        product = (abs(q) * np.maximum(s, 0.0)).max() * 0.5 * contact.slip_range[k]
        assert product <= found.parameter[k] * (1.0 + 1e-12)
        assert found.parameter[k] <= product * (1.0 + 1e-5)
    bound = found.amplitude * np.maximum(found.stress, 0.0)
    assert (found.parameter <= bound * (1.0 + 1e-12)).all()
    assert (found.parameter < 0.999 * bound).any()  # friction and stress are not largest at once everywhere
    assert (found.amplitude[abs(contact.points[:, 0]) < 0.3] == 0.0).all()
    assert 0.5 < abs(found.points[found.worst, 0]) / 1.2 < 1.0


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (
            {"where": "botom"},
            "fatigue[0].where: unknown contact, boundary, node set or body 'botom'; did you mean 'bottom'",
        ),
        ({}, "fatigue[0].where: there is no contact; expected a boundary, a node set or a body"),
        ({"where": "bottom", "steps": "bend"}, "fatigue[0].steps: unknown step 'bend'. Known: reversed"),
    ],
)
def test_requests_for_what_is_not_there(request_, message):
    with pytest.raises(sg.InputError) as refused:
        beam(fatigue=sg.Fatigue(sg.fatigue.SWT(), **request_))
    assert str(refused.value).startswith(message)


def test_requests_that_make_no_sense(bent):
    refused = {
        "distance: is -1; expected a number >= 0": {"distance": -1},
        "average: unknown average 'mean'. Known: line, point": {"average": "mean"},
        "where: is 3; expected a name or a list of them": {"where": 3},
    }
    for message, asked in refused.items():
        with pytest.raises(sg.InputError) as found:
            sg.Fatigue(sg.fatigue.SWT(), **asked)
        assert str(found.value) == message
    with pytest.raises(sg.InputError, match="criterion: is 'SWT'; expected a fatigue criterion"):
        sg.Fatigue("SWT")
    with pytest.raises(sg.InputError, match="distance: is given, and Ruiz's parameters are those of the surface"):
        sg.Fatigue(sg.fatigue.Ruiz(), distance=1.0)
    with pytest.raises(sg.InputError, match="distance: leaves the body: point 1 at"):
        bent.fatigue(sg.fatigue.SWT(), where="bottom", distance=4.5)
    with pytest.raises(sg.InputError, match="distance: goes along normals"):
        bent.fatigue(sg.fatigue.SWT(), where="block", distance=0.1)


def test_lives_of_bodies_that_are_not_isotropic():
    wood = sg.Orthotropic(E1=1e4, E2=1e3, E3=1e3, nu12=0.3, nu13=0.3, nu23=0.3, G12=1e3)
    solution = sg.solve(replace(beam(), bodies=[sg.Body("block", wood)]))
    assert solution.fatigue(sg.fatigue.SWT(), where="bottom").parameter.max() > 0.0
    with pytest.raises(sg.InputError, match="constants of a life, and 'block' is not isotropic"):
        solution.fatigue(sg.fatigue.SWT(**LIFE), where="bottom")
