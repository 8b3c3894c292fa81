# SPDX-License-Identifier: BSD-3-Clause
"""Friction in space that depends on the direction, and cones of facets, in models: pair by pair as their laws say."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import signorini as sg
from benchmarks.space_peers import cube_on_block
from signorini.deck.write import write_deck
from signorini.engine.increments import measured
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve, solve_prepared
from signorini.errors import InputError
from signorini.gallery.cubes import cubes
from signorini.meshing.solid import box
from signorini.model.mesh import join
from signorini.output.dataclasses_json import from_plain, to_plain

AXIS = (0.8, 0.6, 0.0)


def rubbing(model, friction, axis=AXIS, facets=0, **changes):
    """The model with one kind of friction at its contact."""
    (contact,) = model.contacts
    return replace(model, contacts=[replace(contact, friction=friction, friction_axis=axis, facets=facets)], **changes)


def sharp(contact, friction, facets):
    """Every slipping pair carries what dissipates most; none carries more than its section holds."""
    mu, r = np.asarray(friction), contact.traction / np.maximum(contact.pressure, 1e-300)[:, None]
    on = contact.closed
    angle = 2.0 * np.pi * np.arange(facets or 7200) / (facets or 7200)
    rim = mu * np.column_stack([np.cos(angle), np.sin(angle)])
    power = -(r * contact.slip).sum(axis=1)
    most = (rim @ contact.slip.T).max(axis=0)
    slips = contact.status == "slip"
    assert slips.any()
    np.testing.assert_allclose(power[slips], most[slips], rtol=1e-6 if not facets else 1e-10)
    outward = np.column_stack([np.cos(angle + 0.5 * angle[1]), np.sin(angle + 0.5 * angle[1])])
    assert ((r[on] / mu) @ outward.T).max() <= (np.cos(0.5 * angle[1]) if facets else 1.0) + 1e-9


@pytest.mark.parametrize("facets", [0, 8])
@pytest.mark.parametrize("model", [cubes(3), cubes(3, 4)], ids=["match", "mortar"])
def test_pairs_obey_the_ellipse_and_the_polygon_in_it(model, facets):
    step = solve(rubbing(model, (0.1, 0.3), facets=facets)).last
    contact = step.contacts[0]
    assert np.abs(contact.tangents[:, 0] - AXIS).max() < 1e-12
    sharp(contact, (0.1, 0.3), facets)
    assert step.certificate.facets == facets
    assert ("facets" in str(step.certificate)) == bool(facets) == any("8 facets" in note for note in step.notes)


def test_a_block_that_slides_as_a_whole_is_braked_across_the_direction_in_which_it_slides():
    """All pairs slip alike: the resultant is P (m_1^2 s_1, m_2^2 s_2) / |m s|, which does not oppose the sliding s."""
    far = cubes(1)
    aside = np.array([0.6, 0.5, 0.0])
    model = replace(far, supports=[far.supports[0], replace(far.supports[1], u=tuple(aside * 1e4 - (0, 0, 0.01)))])
    contact = solve(rubbing(model, (0.01, 0.03), axis=(1, 0, 0))).last.contacts[0]
    scaled = np.array([0.01, 0.03]) * aside[:2]
    expected = -contact.normal_force[2] * np.array([0.01, 0.03]) * scaled / np.linalg.norm(scaled)
    np.testing.assert_allclose(contact.tangential_force[:2], expected, rtol=1e-5)


def test_two_equal_coefficients_are_one_and_many_facets_the_exact_cone():
    model = cubes(3, 4)
    exact = solve(model).last.contacts[0]
    same = solve(rubbing(model, (0.3, 0.3))).last.contacts[0]
    many = solve(rubbing(model, 0.3, facets=256)).last.contacts[0]
    np.testing.assert_allclose(same.shear, exact.shear, atol=1e-10 * exact.pressure.max())
    np.testing.assert_allclose(many.shear, exact.shear, atol=0.02 * 0.3 * exact.pressure.max())


@pytest.mark.parametrize("facets", [0, 4])
def test_the_direction_of_friction_turns_with_the_model(facets):
    model = rubbing(cubes(3, 4), (0.1, 0.3), facets=facets)
    Q = Rotation.from_rotvec([0.3, -0.5, 1.1]).as_matrix()
    turned = replace(
        rubbing(model, (0.1, 0.3), axis=tuple(Q @ AXIS), facets=facets),
        mesh=replace(model.mesh, points=model.mesh.points @ Q.T),
        supports=[replace(held, u=tuple(Q @ np.array(held.u))) for held in model.supports],
    )
    one, two = (solve(each).last.contacts[0] for each in (model, turned))
    np.testing.assert_allclose(two.shear, one.shear @ Q.T, atol=1e-8 * one.pressure.max())


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
@pytest.mark.parametrize("facets", [0, 4])
def test_half_a_model_gives_what_the_whole_one_gives(axis, facets):
    """Tangents on the plane of symmetry go across it and along it, wherever the axis points."""
    whole = cube_on_block(4, 6, 1)
    parts = {
        "cube": box(x=np.linspace(0, 1, 5), y=np.linspace(0.5, 1, 3), z=np.linspace(0, 1, 5)),
        "block": box(x=np.linspace(-0.5, 1.5, 7), y=np.linspace(0.5, 1.5, 4), z=np.linspace(-1, 0, 2)),
    }
    walls = [sg.Support(f"{name}.front", u=(None, 0.0, None)) for name in parts]
    half = replace(whole, mesh=join(parts), supports=[*whole.supports, *walls])
    one, two = (
        solve(rubbing(model, (0.05, 0.3), axis=axis, facets=facets)).last.contacts[0] for model in (whole, half)
    )
    here = np.array([np.argmin(np.linalg.norm(one.points - point, axis=1)) for point in two.points])
    np.testing.assert_allclose(two.shear, one.shear[here], atol=1e-9 * one.pressure.max())


def test_the_certificate_sees_a_section_that_is_not_the_contacts():
    """An answer for one section is none for another: friction off the ellipse, off its direction, off the polygon."""
    laws = [((0.3, 0.3), 0), ((0.2, 0.3), 0), ((0.3, 0.3), 8), ((0.2, 0.3), 4)]
    prepared = [prepare(rubbing(cubes(3), friction, facets=facets)) for friction, facets in laws]
    for own in prepared:
        end = solve_prepared(own).end
        for other in prepared:
            interface = replace(own.interface, anisotropy=other.interface.anisotropy, facets=other.interface.facets)
            state = end.state
            found = measured(replace(own, interface=interface), state, state.tangential - state.increment)
            worst = max(found.cone, found.complementarity)
            assert worst <= 1e-8 if other is own else worst > 1e-4


def test_a_step_and_a_changed_model_turn_the_friction_of_a_contact_into_another():
    model = rubbing(cubes(3), 0.3)
    direct = solve(rubbing(model, (0.1, 0.3))).last.contacts[0]
    stepped = solve(replace(model, steps=[replace(model.steps[0], friction={"contact": (0.1, 0.3)})])).last.contacts[0]
    changed = solve_prepared(prepare(model).changed(friction={"contact": (0.1, 0.3)})).last.contacts[0]
    for other in (stepped, changed):
        np.testing.assert_allclose(other.traction, direct.traction, atol=1e-12 * direct.pressure.max())


def test_cones_survive_decks_and_archives(tmp_path: Path):
    model = rubbing(cubes(2), (0.1, 0.3), facets=8)
    write_deck(model, tmp_path / "deck.toml")
    assert sg.read(tmp_path / "deck.toml").contacts == model.contacts
    arrays = {}

    def keep(name, array, _):
        arrays[name] = array
        return name

    assert from_plain(to_plain(model.contacts, "contacts", keep), arrays.__getitem__) == model.contacts


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"axis": (0, 0, 1)}, r"contact\[0\].friction_axis: runs along the normal of node"),
        ({"walls": True}, r"contact\[0\].friction_axis: is oblique to the plane of symmetry across y"),
        ({"backend": "iterative"}, r"contact\[0\]: two coefficients and facets need the condensed interface"),
    ],
)
def test_directions_that_do_not_fit_are_refused(options, message):
    model = rubbing(cubes(2), (0.1, 0.3), axis=options.get("axis", AXIS))
    if options.get("walls"):
        walls = [sg.Support(f"{name}.front", u=(None, 0.0, None)) for name in ("lower", "upper")]
        pressed = replace(model.supports[1], u=(0.018, 0.0, -0.01))
        model = replace(model, supports=[model.supports[0], pressed, *walls])
    with pytest.raises(InputError, match=message):
        prepare(model, backend=options.get("backend", "auto"))
