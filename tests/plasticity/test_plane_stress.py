# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield in plane stress: no stress across, closed forms of a square and of a beam, exact tangents."""

import numpy as np
import pytest

import signorini as sg
from signorini.engine.prepare import prepare
from signorini.plasticity.measure import full_strains
from signorini.reference.plasticity import YieldingBeam

E, NU, Y, H = 200.0, 0.3, 1.0, 20.0


def steel(*, hardening=H, backstresses=(), expansion=0.0):
    plastic = sg.Plastic(Y, hardening=hardening, backstresses=backstresses)
    return sg.Elastic(E=E, nu=NU, plastic=plastic, expansion=expansion)


def square(material, tractions, *, cells="quad", thickness=1.0, loads=(), steps=({"x": 1.0, "y": 1.0},), **step):
    return sg.Model(
        sg.rectangle(width=1.0, height=1.0, nx=2, ny=2, cells=cells),
        kind="plane stress",
        thickness=thickness,
        bodies=[sg.Body("block", material)],
        supports=[sg.Support("left", u=(0.0, None)), sg.Support("bottom", u=(None, 0.0))],
        loads=[
            sg.Load("right", traction=(tractions[0], 0.0), name="x"),
            sg.Load("top", traction=(0.0, tractions[1]), name="y"),
            *loads,
        ],
        steps=[sg.Step(scale=scale, increments=1, **step) for scale in steps],
    )


def corner(solution):
    """Displacements of the corner (1, 1): the mean strains of the square."""
    return solution.steps[-1].displacement[np.argmax(solution.model.mesh.points.sum(axis=1))]


@pytest.mark.parametrize("cells", ["triangle", "quad", "triangle6", "quad8"])
@pytest.mark.parametrize("thickness", [1.0, 0.1])
def test_a_square_in_uniaxial_and_in_biaxial_tension(cells, thickness):
    stress = 1.5
    flow = (stress - Y) / H
    one = corner(sg.solve(square(steel(), (stress, 0.0), cells=cells, thickness=thickness)))
    np.testing.assert_allclose(one, [stress / E + flow, -NU * stress / E - flow / 2], rtol=1e-9)
    both = corner(sg.solve(square(steel(), (stress, stress), cells=cells, thickness=thickness)))
    np.testing.assert_allclose(both, [(1 - NU) * stress / E + flow / 2] * 2, rtol=1e-9)


def test_kinematic_hardening_reverses_below_the_yield_stress():
    model = square(
        steel(hardening=0.0, backstresses=[(H, 0.0)]), (1.5, 0.0), steps=[{"x": 1.0, "y": 0.0}, {"x": -0.6, "y": 0.0}]
    )
    stress = -0.9
    flow = (stress + Y) / H  # Prager: the back stress follows the plastic strain, and the yield stress stays
    np.testing.assert_allclose(corner(sg.solve(model))[0], stress / E + flow, atol=1e-9 * 1.5 / H)


def test_heat_strains_a_body_that_yields_freely():
    heat = sg.Load("block", temperature=10.0, name="heat")
    model = square(steel(expansion=1e-4), (1.5, 0.0), loads=[heat], steps=[{"x": 1.0, "y": 0.0, "heat": 1.0}])
    flow = (1.5 - Y) / H
    expected = [1.5 / E + flow + 1e-3, -NU * 1.5 / E - flow / 2 + 1e-3]
    np.testing.assert_allclose(corner(sg.solve(model)), expected, rtol=1e-9)


def test_a_beam_bends_to_one_and_a_half_times_the_moment_of_first_yield():
    height, length, rows = 1.0, 0.5, 16
    beam = YieldingBeam(height=height, E=E, nu=NU, yield_stress=Y)
    curvature = 4.0 * beam.yield_curvature
    mesh = sg.rectangle(width=length, height=height, nx=1, ny=rows, cells="quad8", origin=(0.0, -height / 2))
    end = mesh.points[np.isclose(mesh.points[:, 0], length)]
    turned = [sg.Support(tuple(at), u=(-curvature * length * at[1], None)) for at in end.tolist()]
    model = sg.Model(
        mesh,
        kind="plane stress",
        bodies=[sg.Body("block", steel(hardening=0.0))],
        supports=[sg.Support("left", u=(0.0, None)), sg.Support((0.0, 0.0), u=(None, 0.0)), *turned],
        steps=[sg.Step(increments=8)],
    )
    reactions = sg.solve(model).steps[-1].reactions
    moment = -sum(reactions[support.label][0] * y for support, (_, y) in zip(turned, end, strict=True))
    assert beam.limit == pytest.approx(1.5 * beam.first_yield)
    assert moment == pytest.approx(beam.moment(curvature), rel=2e-3)
    assert moment > 1.45 * beam.first_yield


@pytest.mark.parametrize("backstresses", [(), [(30.0, 0.0)]])
def test_the_tangent_is_that_of_the_forces_and_nothing_presses_across(backstresses):
    model = square(steel(backstresses=backstresses), (1.0, 1.0))
    bodies = prepare(model).yielding
    rng = np.random.default_rng(3)
    u = rng.normal(size=bodies.space.number_of_dofs) * 2e-2
    old = bodies.respond(u, bodies.untouched(), bodies.cold()).state
    heat = bodies.cold()._replace(swelling=np.full(len(bodies.body), 1e-3))
    u = u + rng.normal(size=len(u)) * 2e-2
    response = bodies.respond(u, old, heat)
    assert response.points.yields.all()
    rows, way, h = bodies.rows(), rng.normal(size=len(u)), 1e-6
    rows.data = bodies.softening(response)
    ahead, behind = (bodies.respond(u + sign * h * way, old, heat).state.forces for sign in (1.0, -1.0))
    np.testing.assert_allclose(rows @ way, (ahead - behind) / (2 * h), atol=1e-6 * np.abs(rows @ way).max())
    strain = full_strains(bodies, u, response.state.strain, heat)
    np.testing.assert_allclose(strain[:, 2], response.points.strain[:, 2], rtol=1e-10, atol=1e-14)
    G, K = E / 2 / (1 + NU), E / 3 / (1 - 2 * NU)
    volume = strain[:, :3].sum(axis=1)
    across = K * (volume - heat.swelling) + 2 * G * (strain[:, 2] - volume / 3 - response.state.strain[:, 2])
    assert np.abs(across).max() < 1e-10 * Y


def test_collapse_in_plane_stress_is_named_with_its_load():
    solution = sg.solve(square(steel(hardening=0.0), (1.25, 0.0)), raise_on_failure=False)
    assert solution.status == "no_equilibrium"
    assert "bodies flow plastically at 80.0" in solution.message  # a bound from above
