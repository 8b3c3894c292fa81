# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield in every kind of model: a column in uniaxial stress has closed forms for all of them.

Every answer is certified, its energies balance to rounding, and the exact displacement or force comes out.
"""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.multipliers import MultiplierSolver
from tests.helpers.columns import (
    DENSITY,
    ELASTIC,
    EXPANSION,
    PRESSURE,
    SOFT,
    column,
    plastic_strain,
    strain,
    top,
)

ROUNDING = 1e-9  # of the answer: equilibrium is solved to 1e-9 of the forces
PRESSED = -2.0 * strain()
ELASTIC_STRAIN = PRESSURE / ELASTIC.E
UNLOADED = -2.0 * plastic_strain()


def solved(model, **options):
    """The solution, every increment certified and all energies in balance."""
    solution = sg.solve(model, **options)
    assert all(step.certificate.passed and step.certificate.plastic is not None for step in solution.steps)
    assert imbalance(solution) < ROUNDING
    return solution


def imbalance(solution):
    """Of work and what became of it, over the largest."""
    last, state = solution.steps[-1], solution.end.state
    work = sum(step.work for step in solution.steps)
    parts = [
        last.strain_energy,
        last.interface_energy,
        sum(step.released for step in solution.steps),
        float(state.dissipation.sum()),
        state.plastic.dissipation,
    ]
    return abs(work - sum(parts)) / max(abs(work), *map(abs, parts))


def tool(kind, **moved):
    """A flat rigid tool on the top in place of a load."""
    up = (0.0,) * (2 if kind == "3d" else 1)
    shape = sg.Plane((*up, 2.0), (*up, -1.0))
    contacts = [
        sg.Contact("up.bottom", "low.top", name="interface"),
        sg.Contact("up.top", "tool", name="tool"),
    ]
    return {"obstacles": [sg.Rigid("tool", shape, **moved)], "contacts": contacts}


def force(kind):
    """What presses on the whole top."""
    return -PRESSURE * (np.pi if kind == "axisymmetric" else 1.0)


def sideways(kind):
    """Components of a vector but the last: free, and none."""
    count = 2 if kind == "3d" else 1
    return (None,) * count, (0.0,) * count


KINDS = pytest.mark.parametrize("kind", ["axisymmetric", "3d"])


@KINDS
def test_two_bodies_that_yield(kind):
    solution = solved(column(kind))
    np.testing.assert_allclose(top(solution), PRESSED, rtol=ROUNDING)
    np.testing.assert_allclose(solution.end.state.plastic.equivalent, plastic_strain(), rtol=ROUNDING)
    np.testing.assert_allclose(solution.steps[0].contacts[0].pressure, PRESSURE, rtol=ROUNDING)
    assert any("at 50.000000%: first yield" in note for note in solution.steps[0].notes)


@pytest.mark.parametrize(
    "lower",
    [
        ELASTIC,
        sg.Orthotropic(
            E1=200.0, E2=200.0, E3=200.0, nu12=0.3, nu13=0.3, nu23=0.3, G12=200 / 2.6, G13=200 / 2.6, G23=200 / 2.6
        ),
    ],
)
@KINDS
def test_on_an_elastic_body(kind, lower):
    solution = solved(column(kind, lower=lower))
    np.testing.assert_allclose(top(solution), -strain() - ELASTIC_STRAIN, rtol=ROUNDING)


@KINDS
def test_on_a_rigid_body(kind):
    size = 6 if kind == "3d" else 3
    held = sg.Support("slab", u=(0.0,) * size)
    point = (0.5, 0.5, 0.5) if kind == "3d" else (0.0, 0.5)
    slab = sg.RigidBody("slab", "low", point)
    model = column(kind)
    kept = [support for support in model.supports if not str(support.on).startswith("low")]
    solution = solved(replace(model, supports=[*kept, held], rigid_bodies=[slab]))
    np.testing.assert_allclose(top(solution), -strain(), rtol=ROUNDING)
    np.testing.assert_allclose(
        solution.steps[0].reactions["slab"][2 if kind == "3d" else 1], -force(kind), rtol=ROUNDING
    )


@KINDS
def test_tied(kind):
    solution = solved(column(kind, friction="tied"))
    np.testing.assert_allclose(top(solution), PRESSED, rtol=ROUNDING)


@KINDS
def test_with_friction_that_nothing_slips_against(kind):
    """Both blocks widen alike: on an exact path before, in increments after first yield."""
    solution = solved(column(kind, friction=0.3, steps=[sg.Step()]))
    np.testing.assert_allclose(top(solution), PRESSED, rtol=ROUNDING)


@KINDS
def test_an_obstacle_that_moves(kind):
    none = sideways(kind)[1]
    solution = solved(column(kind, **tool(kind, u=(*none, PRESSED))))
    np.testing.assert_allclose(solution.steps[0].obstacles["tool"].force[-1], force(kind), rtol=ROUNDING)


@KINDS
def test_an_obstacle_that_a_force_drives(kind):
    free, none = sideways(kind)
    solution = solved(column(kind, **tool(kind, u=(*none, None), force=(*free, force(kind)))))
    np.testing.assert_allclose(solution.steps[0].obstacles["tool"].displacement[-1], PRESSED, rtol=ROUNDING)


@KINDS
def test_interference_that_grows_over_a_step(kind):
    """The clamped column is as long as the overlap is too long: half of the work of loads, none of them moves."""
    held = (sg.Support("up.top", u=(*sideways(kind)[0], 0.0)),)
    step = sg.Step(interference={"interface": -PRESSED}, increments=3)
    solution = solved(column(kind, loads=[], supports=held, steps=[step]))
    np.testing.assert_allclose(solution.steps[0].contacts[0].pressure, PRESSURE, rtol=ROUNDING)


@KINDS
def test_temperature_alone_yields_a_clamped_bar(kind):
    """``alpha T = sigma / E + (sigma - Y) / H``; as it cools it shrinks as an elastic bar."""
    held = (sg.Support("up.top", u=(*sideways(kind)[0], 0.0)),)
    hot = [sg.Load(block, temperature=strain() / EXPANSION, name=block) for block in ("up", "low")]
    left = 1.0 - 0.75 * ELASTIC_STRAIN / strain()
    steps = [sg.Step(increments=1), sg.Step(scale={"up": left, "low": left}, increments=1)]
    solution = solved(column(kind, loads=hot, supports=held, steps=steps))
    np.testing.assert_allclose(solution.steps[0].contacts[0].pressure, PRESSURE, rtol=ROUNDING)
    np.testing.assert_allclose(solution.steps[1].contacts[0].pressure, 0.25 * PRESSURE, rtol=ROUNDING)


@KINDS
def test_gravity(kind):
    """No closed form: the reaction is the weight, and the column at rest yields below only."""
    weight = -PRESSURE / DENSITY
    loads = [sg.Load(block, gravity=(*sideways(kind)[1], weight), name=block) for block in ("up", "low")]
    solution = solved(column(kind, loads=loads))
    np.testing.assert_allclose(solution.steps[0].reactions["floor"][-1], -2.0 * force(kind), rtol=ROUNDING)
    equivalent = solution.end.state.plastic.equivalent
    assert (equivalent > 0.0).any()
    assert (equivalent == 0.0).any()


@KINDS
def test_springs(kind):
    solution = solved(column(kind, foundations=[sg.Foundation("low.bottom", normal_stiffness=50.0)]))
    np.testing.assert_allclose(top(solution), PRESSED - PRESSURE / 50.0, rtol=ROUNDING)


@KINDS
def test_equations_move_a_top_as_one_body_as_its_spread_does(kind):
    """Friction spoils the uniform stress, so that equations and the spread of the load are two ways to one answer."""
    free = sideways(kind)[0]
    pressed = sg.Load("up.top", force=(*free, 0.7 * force(kind)), spread="displacement", name="press")
    glued = (sg.Support("low.bottom", u=(*sideways(kind)[1], None)),)
    one = solved(column(kind, loads=[pressed], supports=glued, friction=0.2))
    mesh, axis = one.model.mesh, "z" if kind == "3d" else "y"
    first, *others = (tuple(mesh.points[node].tolist()) for node in mesh.nodes_of("up.top"))
    equations = [sg.Equation([(first, axis, 1.0), (node, axis, -1.0)]) for node in others]
    spread = replace(pressed, spread="traction")
    two = solved(column(kind, loads=[spread], supports=glued, friction=0.2, equations=equations))
    assert np.ptp(top(two)) < ROUNDING
    np.testing.assert_allclose(two.steps[0].displacement, one.steps[0].displacement, atol=1e-8 * strain())


@KINDS
def test_a_body_that_first_falls_to_where_it_touches(kind):
    contact = sg.Contact("up.bottom", "low.top", interference=-0.5, name="interface")
    solution = solved(column(kind, contacts=[contact]))
    np.testing.assert_allclose(top(solution), PRESSED - 0.5, rtol=ROUNDING)


def test_a_body_that_rests_while_another_yields():
    """Nothing touches the upper block; the lower one is pressed and stays behind."""
    contact = sg.Contact("up.bottom", "low.top", interference=-0.5, name="interface")
    press = [sg.Load("low.top", pressure=PRESSURE, name="press")]
    solution = solved(column(contacts=[contact], loads=press, steps=[sg.Step(increments=2)]))
    np.testing.assert_allclose(top(solution), 0.0, atol=1e-12)
    np.testing.assert_allclose(solution.steps[0].contacts[0].gap, 0.5 + strain(), rtol=ROUNDING)


@KINDS
@pytest.mark.parametrize(
    "step",
    [{"increments": 3}, {"increments": "auto"}, {"at": (0.25, 0.75)}, {"at": 3}, {}],
    ids=["three increments", "auto", "at times", "three times", "as it comes"],
)
def test_however_a_step_is_divided(kind, step):
    """Uniaxial stress is proportional: backward Euler is exact whatever the increments are."""
    solution = solved(column(kind, steps=[sg.Step(**step)]))
    np.testing.assert_allclose(top(solution), PRESSED, rtol=ROUNDING)
    for instant in solution.steps[0].instants:
        expected = 2.0 * strain(PRESSURE * instant.factors["press"])
        if instant.displacement is not None:
            nodes = solution.model.mesh.nodes_of("up.top")
            np.testing.assert_allclose(instant.displacement[nodes, -1], -expected, rtol=ROUNDING)


def test_at_events():
    solution = solved(column(steps=[sg.Step(at="events")]))
    shown = [instant.factors["press"] for instant in solution.steps[0].instants]
    assert any(abs(factor - 0.5) < 1e-9 for factor in shown)  # first yield is an event


@KINDS
def test_unloading_leaves_plastic_strain(kind):
    steps = [sg.Step(increments=1), sg.Step(scale={"press": 0.01}, increments=2)]
    solution = solved(column(kind, steps=steps))
    np.testing.assert_allclose(top(solution), UNLOADED - 0.02 * ELASTIC_STRAIN, rtol=ROUNDING)
    assert any(note.startswith("nothing yields") for note in solution.steps[1].notes)


@KINDS
def test_cycles_after_the_first_are_elastic(kind):
    """Isotropic hardening: what has been carried once is carried elastically ever after."""
    step = sg.Step(scale={"press": [1.0, 0.1]}, repeat=3)
    solution = solved(column(kind, steps=[step]))
    np.testing.assert_allclose(top(solution), UNLOADED - 0.2 * ELASTIC_STRAIN, rtol=ROUNDING)
    assert solution.steps[0].steadiness == "shakes down"
    np.testing.assert_allclose(solution.end.state.plastic.equivalent, plastic_strain(), rtol=ROUNDING)


@KINDS
def test_a_contact_switched_off_and_on_again(kind):
    held = (sg.Support("up.top", u=(*sideways(kind)[0], PRESSED), name="press"),)
    steps = [
        sg.Step(increments=1),
        sg.Step(inactive=["interface"], scale={}),
        sg.Step(active=["interface"], scale={}),
    ]
    solution = solved(column(kind, loads=[], supports=held, steps=steps))
    np.testing.assert_allclose(solution.steps[1].contacts[0].pressure, 0.0, atol=1e-12)
    np.testing.assert_allclose(solution.steps[2].contacts[0].pressure, PRESSURE, rtol=ROUNDING)


@KINDS
def test_a_support_that_lets_go(kind):
    held = (sg.Support("up.top", u=(*sideways(kind)[0], PRESSED), name="press"),)
    steps = [sg.Step(increments=1), sg.Step(release=["press"], scale={}), sg.Step(hold=["press"], scale={})]
    light = [sg.Load("up.top", pressure=0.01, name="rest")]  # that the block has a place when it is let go
    model = column(kind, loads=light, supports=held, steps=steps)
    solution = solved(model)
    np.testing.assert_allclose(solution.steps[0].contacts[0].pressure, PRESSURE, rtol=ROUNDING)
    np.testing.assert_allclose(top(solution, 1), UNLOADED - 2.0 * strain(0.01), rtol=ROUNDING)
    np.testing.assert_allclose(top(solution, 2), top(solution, 1), rtol=ROUNDING)


def test_friction_that_is_lowered():
    """The upper block flows sideways once friction holds it less; the certificate refers to the new law."""
    drag = sg.Load("up.top", traction=(0.3, 0.0), name="drag")
    press = sg.Load("up.top", pressure=PRESSURE, name="press")
    end = sg.Support("up.right", u=(0.0, None), name="stop")
    steps = [
        sg.Step(scale={"press": 1.0, "drag": 0.0}, increments=2),
        sg.Step(scale={"drag": 1.0}, increments=2),
        sg.Step(friction={"interface": 0.05}, scale={}),
    ]
    model = column("plane strain", loads=[press, drag], supports=(end,), friction=0.5, steps=steps)
    model = replace(model, supports=[support for support in model.supports if support.on != "up.left"])
    solution = sg.solve(model)
    assert all(step.certificate.passed for step in solution.steps)
    pair = solution.steps[-1].contacts[0]
    assert (np.abs(pair.traction) <= 0.05 * pair.pressure * (1.0 + 1e-9)).all()
    assert any("slip at once" in note for note in solution.steps[-1].notes)


@pytest.mark.parametrize("kind", ["plane strain", "plane stress"])
def test_thickness_multiplies_forces_alone(kind):
    one, three = solved(column(kind)), solved(column(kind, thickness=3.0))
    np.testing.assert_allclose(three.steps[0].displacement, one.steps[0].displacement, atol=1e-9 * strain())
    size = three.end.state.plastic.dissipation
    assert size == pytest.approx(3.0 * one.end.state.plastic.dissipation, rel=1e-9)


def test_planes_of_symmetry_stand_for_the_other_half():
    """Half of a column that friction holds below, and the whole of it."""
    glued = (sg.Support("low.bottom", u=(0.0, None), name="glue"),)
    half = solved(column("plane strain", supports=glued, friction=0.2, cells=(2, 2)))
    whole_mesh = sg.join(
        {
            "up": sg.rectangle(x=np.linspace(-1.0, 1.0, 5), y=np.linspace(1.0, 2.0, 3)),
            "low": sg.rectangle(x=np.linspace(-1.0, 1.0, 5), y=np.linspace(0.0, 1.0, 3)),
        }
    )
    middle = [sg.Support((0.0, 2.0), u=(0.0, None))]
    model = replace(
        half.model,
        mesh=whole_mesh,
        supports=[sg.Support("low.bottom", u=(None, 0.0), name="floor"), *glued, *middle],
    )
    whole = solved(model)
    assert top(whole).min() == pytest.approx(top(half).min(), rel=1e-8)
    assert whole.end.state.plastic.dissipation == pytest.approx(2.0 * half.end.state.plastic.dissipation, rel=1e-8)


def test_another_factor_of_the_loads_is_the_model_with_that_load():
    prepared = sg.prepare(column(friction=0.3))
    for factor in (0.4, 0.8, 1.2):
        solution = prepared.solve(loads={"press": factor})
        stress = factor * PRESSURE
        np.testing.assert_allclose(top(solution), -2.0 * strain(stress), rtol=ROUNDING)
        assert solution.steps[0].certificate.passed


@pytest.mark.parametrize("family", ["hexahedron", "hexahedron20", "tetra10"])
def test_a_slab_in_plane_strain_is_the_same_in_space(family):
    """Two blocks between walls, so that nothing moves along y, with friction that slips: the plane's answer.

    Hexahedra of a slab one cell thick are its quadrilaterals; others agree within what cells differ by.
    """
    glued = (sg.Support("low.bottom", u=(0.0, None), name="glue"),)
    flat = solved(column("plane strain", supports=glued, friction=0.1, cells=(2, 2)))
    x = np.linspace(0.0, 1.0, 3)
    blocks = {name: sg.box(x=x, y=[0.0, 0.5], z=z + x, cells=family) for name, z in (("up", 1.0), ("low", 0.0))}
    held = [sg.Support("low.bottom", u=(0.0, None, 0.0))]
    for block in blocks:
        held += [sg.Support(f"{block}.left", u=(0.0, None, None))]
        held += [sg.Support(f"{block}.{side}", u=(None, 0.0, None)) for side in ("front", "back")]
    deep = solved(
        sg.Model(
            sg.join(blocks),
            bodies=[sg.Body(block, SOFT) for block in blocks],
            supports=held,
            loads=[sg.Load("up.top", pressure=PRESSURE, name="press")],
            contacts=[sg.Contact("up.bottom", "low.top", friction=0.1, name="interface")],
            steps=[sg.Step(increments=1)],
        )
    )
    bound = 1e-8 if family == "hexahedron" else 0.05
    assert top(deep).mean() == pytest.approx(top(flat).mean(), rel=bound)
    assert deep.end.state.plastic.dissipation == pytest.approx(0.5 * flat.end.state.plastic.dissipation, rel=bound)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "given"),
    [
        ("axisymmetric", {}),
        ("axisymmetric", {"friction": 0.3}),
        ("3d", {"friction": 0.3}),
        ("3d", {"friction": "tied"}),
        ("axisymmetric", {"lower": ELASTIC}),
        ("3d", {"foundations": [sg.Foundation("low.bottom", normal_stiffness=50.0)]}),
        ("3d", {"steps": [sg.Step(increments=2), sg.Step(scale={"press": 0.3}, increments=1)]}),
    ],
    ids=["alone", "friction", "friction in space", "tied", "elastic", "springs", "unloaded"],
)
def test_iterated_bodies_answer_as_condensed_ones(kind, given):
    """Contact by multipliers, bodies by multigrid, a new hierarchy for every tangent."""
    model = column(kind, **given)
    one, two = solved(model), solved(model, backend="iterative")
    assert two.backend == "iterative"
    for here, there in zip(one.steps, two.steps, strict=True):
        size = np.abs(here.displacement).max()
        np.testing.assert_allclose(there.displacement, here.displacement, atol=1e-7 * size)
        np.testing.assert_allclose(there.contacts[0].pressure, here.contacts[0].pressure, atol=1e-7 * PRESSURE)


def test_iterated_tangents_start_from_the_answer_before(monkeypatch):
    """Multipliers of the last tangents hardly change: their rounds are few, where from rest they are as many each."""
    counted = []
    original = MultiplierSolver.solve_near

    def counting(self, *given):
        answer = original(self, *given)
        counted.append(answer.trace[0].iterations)
        return answer

    monkeypatch.setattr(MultiplierSolver, "solve_near", counting)
    glued = (sg.Support("low.bottom", u=(0.0, None), name="glue"),)
    solved(column("plane strain", supports=glued, friction=0.2), backend="iterative")
    assert len(counted) >= 4
    assert counted[-1] < counted[0]  # Newton's method makes those from rest few, too
