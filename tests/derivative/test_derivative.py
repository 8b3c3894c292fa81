# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives against central differences of the whole program."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.derivative.functionals import value
from tests.derivative.rig import STEPS, rig
from tests.engine.test_bonds import bonded_bar


def with_body(model, body, **changed):
    bodies = list(model.bodies)
    bodies[body] = replace(bodies[body], material=replace(bodies[body].material, **changed))
    return replace(model, bodies=bodies)


def with_load(model, number, factor):
    loads = list(model.loads)
    load = loads[number]
    given = (
        {"temperature": load.temperature * factor}
        if load.temperature
        else {"traction": tuple(factor * part for part in load.traction)}
    )
    loads[number] = replace(load, **given)
    return replace(model, loads=loads)


def with_contact(model, **changed):
    return replace(model, contacts=[replace(model.contacts[0], **changed)])


def with_support(model, factor):
    first, *others = model.supports
    return replace(model, supports=[replace(first, u=(None, factor * first.u[1])), *others])


PARAMETERS = {
    "friction.joint": (lambda m, q: with_contact(m, friction=0.35 + q), 1e-6),
    "interference.joint": (lambda m, q: with_contact(m, interference=q), 1e-8),
    "load.pull": (lambda m, q: with_load(m, 0, 1.0 + q), 1e-5),
    "load.heat": (lambda m, q: with_load(m, 1, 1.0 + q), 1e-5),
    "support.down": (lambda m, q: with_support(m, 1.0 + q), 1e-5),
    "E.pad": (lambda m, q: with_body(m, 0, E=2000.0 + q), 2e-2),
    "E.block": (lambda m, q: with_body(m, 1, E=900.0 + q), 1e-2),
    "nu.pad": (lambda m, q: with_body(m, 0, nu=0.3 + q), 1e-5),
    "nu.block": (lambda m, q: with_body(m, 1, nu=0.25 + q), 1e-5),
    "expansion.block": (lambda m, q: with_body(m, 1, expansion=2e-4 + q), 1e-9),
}


def outputs(model):
    """Every kind of output, in the middle of the side where it is at a node; the last ones at the end of a step."""
    bottom = model.mesh.nodes_of("pad.bottom")
    middle = int(bottom[len(bottom) // 2])
    top = int(model.mesh.nodes_of("pad.left")[-1])
    return {
        "peak": sg.pressure("joint").peak,
        "mean": sg.pressure("joint").mean(),
        "traction": sg.traction("joint")[middle],
        "gap": sg.gap("joint")[int(bottom[0])],
        "motion": sg.motion("joint")[int(bottom[-1])],
        "force": sg.force("joint", along=(0.3, 1.0)),
        "moment": sg.moment("joint", about=(0.2, 1.5)),
        "half-width": sg.halfwidth("joint"),
        "dissipation": sg.dissipation(),
        "displacement": sg.displacement(top, along=(1.0, 0.0)),
        "stress": sg.stress("pad", middle, "xx"),
        "friction when pulled": sg.force("joint", along=(1.0, 0.0), of="friction").after(2),
    }


def differences(model, parameter):
    change, step = PARAMETERS[parameter]
    found = []
    for q in (step, -step):
        view = sg.solve(change(model, q), tape=True)._taped.view
        found.append({name: value(output, view) for name, output in outputs(model).items()})
    return {name: (found[0][name] - found[1][name]) / (2.0 * step) for name in found[0]}


@pytest.fixture(scope="module")
def solved():
    model = rig()
    solution = sg.solve(model, tape=True)
    return model, solution, {name: solution.derivative(output) for name, output in outputs(model).items()}


def moved(model, factor):
    """The sides of the pad and the top of the block bent, whose held and loaded sides stay."""
    x, y = model.mesh.points.T
    bent = np.column_stack([0.1 * np.sin(2.0 * y) * y * (2.0 - y), 0.05 * np.cos(1.5 * x) * y * (2.0 - y)])
    return replace(model, mesh=replace(model.mesh, points=model.mesh.points + factor * bent)), bent


def check(model, derivatives, parameter):
    found = differences(model, parameter)
    size = {"interference": 1e-2, "E": 1e3, "expansion": 1e-4}.get(parameter.partition(".")[0], 1.0)
    for name, derivative in derivatives.items():
        lost = abs(derivative.by(parameter) - found[name]) * size
        assert lost <= 1e-7 * max(abs(found[name]) * size, abs(derivative.value)), name


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_the_derivative_is_that_of_the_whole_program(solved, parameter):
    model, _, derivatives = solved
    check(model, derivatives, parameter)


@pytest.fixture(scope="module")
def ring():
    model = rig("axisymmetric")
    solution = sg.solve(model, tape=True)
    return model, {name: solution.derivative(output) for name, output in outputs(model).items()}


@pytest.mark.parametrize("parameter", ["friction.joint", "support.down", "E.block", "nu.pad"])
def test_a_ring_has_the_same_derivatives(ring, parameter):
    check(*ring, parameter)


def test_friction_that_is_lowered_under_load():
    """Pairs slip at that load, at once; what derivatives of the step before ask for is from before that."""
    oiled = sg.Step(name="oiled", scale={"pull": 1.0}, friction={"joint": 0.1}, path="exact")
    model = rig(steps=(*STEPS[:2], oiled))
    model = replace(model, supports=[replace(model.supports[0], u=(0.0, -0.02)), model.supports[1]])
    solution = sg.solve(model, tape=True)
    assert len(solution.tape.legs) == 4
    derivatives = {name: solution.derivative(output) for name, output in outputs(model).items()}
    wanted = sum(step.dissipation for step in solution.steps)
    assert derivatives["dissipation"].value == pytest.approx(wanted, rel=1e-10)
    check(model, derivatives, "load.pull")
    check(model, derivatives, "interference.joint")


@pytest.mark.parametrize("parameter", ["interference.joint", "E.block", "E.pad", "load.pull"])
def test_a_load_carries_a_body_until_it_touches(parameter):
    """Where it is then, the pair that touches tells, and with it where pairs begin to stick."""
    model = rig(steps=[sg.Step(scale={"pull": 1.0, "heat": 0.5}, path="exact")])
    model = replace(
        model,
        supports=[sg.Support("pad.left", u=(0.0, None)), model.supports[1]],
        loads=[sg.Load("pad.top", traction=(2.0, -20.0), name="pull"), model.loads[1]],
        contacts=[replace(model.contacts[0], interference=-0.01)],
    )
    solution = sg.solve(model, tape=True)
    assert "approaches" in solution.steps[0].notes[0]
    change, step = PARAMETERS[parameter]
    if parameter == "interference.joint":
        change, step = lambda m, q: with_contact(m, interference=-0.01 + q), 1e-7
    views = [sg.solve(change(model, q), tape=True)._taped.view for q in (step, -step)]
    for output in outputs(model).values():
        if output.load_factor is None:
            high, low = (value(output, view) for view in views)
            derivative = solution.derivative(output)
            size = max(abs(derivative.value), 1e-6) * (1e-3 if parameter.startswith("E") else 1.0)
            assert derivative.by(parameter) == pytest.approx((high - low) / (2.0 * step), rel=1e-6, abs=1e-6 * size)


def test_the_shape_of_bodies_is_a_parameter(solved):
    model, _, derivatives = solved
    found, step = [], 2e-6
    for q in (step, -step):
        view = sg.solve(moved(model, q)[0], tape=True)._taped.view
        found.append({name: value(output, view) for name, output in outputs(model).items()})
    for name, derivative in derivatives.items():
        wanted = (found[0][name] - found[1][name]) / (2.0 * step)
        sides = derivative.shape_sides(moved(model, 0.0)[1])  # two, as the block was straight
        lost = abs(0.5 * sum(sides) - wanted)
        assert lost <= 1e-6 * max(abs(wanted), abs(derivative.value)), (name, lost, wanted)
    with pytest.raises(sg.InputError, match="a motion of some node"):
        derivatives["peak"].shape(np.zeros(2))


def test_outputs_are_those_of_the_solution(solved):
    model, solution, derivatives = solved
    contact = solution.contact("joint")
    middle = int(model.mesh.nodes_of("pad.bottom")[3])
    found = {name: derivative.value for name, derivative in derivatives.items()}
    assert found["peak"] == pytest.approx(contact.pressure.max(), rel=1e-12)
    assert found["traction"] == pytest.approx(contact.traction[contact.node == middle][0], rel=1e-12)
    assert found["force"] == pytest.approx((contact.normal_force + contact.tangential_force) @ [0.3, 1.0], rel=1e-12)
    assert found["moment"] == pytest.approx(contact.moment((0.2, 1.5)), rel=1e-12)
    assert found["dissipation"] == pytest.approx(sum(step.dissipation for step in solution.steps), rel=1e-10)
    stress = solution.stress("pad")
    assert found["stress"] == pytest.approx(stress.stress[stress.nodes == middle][0, 0], rel=1e-10)


def test_gaps_node_by_node_add_up_to_an_interference(solved):
    derivatives = solved[2]
    for derivative in derivatives.values():
        gap, together = derivative.gap["joint"], derivative.interference["joint"]
        assert -gap.sum() == pytest.approx(together, rel=1e-9, abs=1e-12 * np.abs(gap).max())


def test_a_profile_is_the_sum_of_its_products_with_gaps(solved):
    _, _, derivatives = solved
    derivative = derivatives["force"]
    gaps = derivative.gap["joint"]
    profile = np.cos(np.arange(len(gaps)))
    assert derivative.profile("joint", profile) == pytest.approx(gaps @ profile, rel=1e-9)
    assert derivative.profile_sides("joint", profile) == pytest.approx((gaps @ profile,) * 2, rel=1e-9)
    for wrong, what in (
        (profile[1:], f"change: has {len(gaps) - 1} components, .* expected a list of {len(gaps)} numbers"),
        (0.0 * profile, "change: is 0 everywhere; expected a profile that changes some gap"),
    ):
        with pytest.raises(sg.InputError, match=what):
            derivative.profile("joint", wrong)


@pytest.mark.parametrize("parameter", ["friction", "interference"])
def test_forwards_is_backwards(solved, parameter):
    _, solution, derivatives = solved
    tangent = solution.tangent(**{parameter: "joint"})
    for name in ("peak", "force", "dissipation", "motion"):
        derivative = derivatives[name]
        size = abs(derivative.value)
        assert tangent.of(derivative.output) == pytest.approx(derivative.by(f"{parameter}.joint"), abs=1e-11 * size)


def test_a_tangent_has_the_fields_of_the_contact(solved):
    model, solution, _ = solved
    step = 1e-6
    low, high = (sg.solve(with_contact(model, friction=0.35 + q)).contact("joint") for q in (-step, step))
    tangent = solution.tangent(friction="joint").contact("joint")
    assert np.array_equal(tangent.node, low.node)
    for name in ("pressure", "traction", "gap"):
        wanted = (getattr(high, name) - getattr(low, name)) / (2.0 * step)
        assert getattr(tangent, name) == pytest.approx(wanted, abs=1e-6 * max(1.0, np.abs(wanted).max()))


def test_a_derivative_says_how_far_it_holds(solved):
    """Up to there the sequence of events stays; beyond, another takes its place, as the words say."""
    model, _, derivatives = solved

    def sequence(friction):
        changed = sg.solve(with_contact(model, friction=friction))
        return [(event.what, event.nodes) for step in changed.steps for event in step.events]

    holds = derivatives["peak"].holds("friction.joint")
    assert holds.low < 0.0 < holds.high
    for end, words in zip((holds.low, holds.high), holds.ends, strict=True):
        assert sequence(0.35 + 0.9 * end) == sequence(0.35)
        assert sequence(0.35 + 1.15 * end) != sequence(0.35), words
        assert words.startswith("node ")


@pytest.fixture(scope="module")
def ending_at_an_event(solved):
    """The same pulled until a pair has used up its friction, and not farther."""
    model, solution, _ = solved
    slips = next(event for event in solution.steps[1].events if event.what == "slips")
    press, pull = model.steps[:2]
    part = slips.load_factor - 1.0
    pull = replace(pull, scale={"pull": part, "heat": 0.5 + 0.5 * part})
    return replace(model, steps=[press, pull]), int(slips.nodes[0])


@pytest.mark.parametrize("parameter", ["friction.joint", "load.pull"])
def test_at_an_event_a_derivative_has_two_sides(ending_at_an_event, parameter):
    model, node = ending_at_an_event
    change, step = PARAMETERS[parameter]
    solution = sg.solve(model, tape=True)
    views = [sg.solve(change(model, q), tape=True)._taped.view for q in (-step, 0.0, step)]
    for output in (sg.pressure("joint").peak, sg.motion("joint")[node]):
        derivative = solution.derivative(output)
        below, here, above = (value(output, view) for view in views)
        size = max(abs(above - here), abs(here - below)) / step
        wanted = ((here - below) / step, (above - here) / step)
        assert derivative.sides(parameter) == pytest.approx(wanted, abs=1e-5 * size)
        with pytest.raises(sg.InputError, match=rf"node {node + 1} of 'joint' slips at load factor 2: .* two sides"):
            derivative.by(parameter)
        holds = derivative.holds(parameter)
        assert 0.0 in (holds.low, holds.high)
        assert solution.derivative(output.after(1)).sides(parameter) == pytest.approx(
            (solution.derivative(output.after(1)).by(parameter),) * 2
        )


def test_at_an_event_a_shape_has_two_sides(ending_at_an_event):
    model, node = ending_at_an_event
    points, step = model.mesh.points, 1e-6
    motion = points @ np.array([[0.3, 0.2], [-0.1, 0.4]])
    derivative = sg.solve(model, tape=True).derivative(sg.pressure("joint").peak)

    def peak(part):
        mesh = replace(model.mesh, points=points + part * step * motion)
        return sg.solve(replace(model, mesh=mesh), tape=True).derivative(derivative.output).value

    wanted = [way * (4.0 * peak(0.5 * way) - 3.0 * derivative.value - peak(way)) / step for way in (-1.0, 1.0)]
    assert derivative.shape_sides(motion) == pytest.approx(wanted, rel=1e-6)
    with pytest.raises(sg.InputError, match=rf"node {node + 1} of 'joint' slips at load factor 2: .* two sides"):
        derivative.shape(motion)


def test_grazing_is_refused(solved):
    _, solution, _ = solved
    point = next(point for point in solution._taped.view.points if point.at_event)
    pair = point.event.pair
    slow = point.h_rate.copy()
    slow[0, pair] *= 1e-12
    grazing = replace(point, h_rate=slow)
    with pytest.raises(sg.InputError, match="grazes its event"):
        assert grazing.event


@pytest.mark.parametrize("increments", [None, 2], ids=["path", "increments"])
def test_a_body_that_moves_freely_is_refused(increments):
    """A plate between two walls that it touches without a force, and nothing holds along the normal."""
    blocks = {"plate": (1.0, 0.5, 0.0, 1.0), "low": (1.2, 1.0, -0.1, 0.0), "up": (1.2, 1.0, -0.1, 1.5)}
    made = {
        name: sg.rectangle(width=width, height=height, nx=4, ny=1, origin=(x, y))
        for name, (width, height, x, y) in blocks.items()
    }
    held = {"low.bottom": (0.0, 0.0), "up.top": (0.0, 0.0), "plate.left": (0.0, None)}
    model = sg.Model(
        sg.join(made),
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in made],
        supports=[sg.Support(side, u=u) for side, u in held.items()],
        loads=[sg.Load("plate.right", traction=(30.0, 0.0), name="pull")],
        contacts=[
            sg.Contact("plate.bottom", "low.top", name="lower"),
            sg.Contact("plate.top", "up.bottom", name="upper"),
        ],
        steps=[sg.Step(increments=increments)],
    )
    solution = sg.solve(model, tape=True)
    with pytest.raises(sg.InputError, match="a body moves freely"):
        solution.derivative(sg.pressure("lower").peak)
    with pytest.raises(sg.InputError, match="a body moves freely"):
        solution.tangent(E="plate")


def test_a_history_without_a_tape_is_solved_again(solved):
    model, solution, derivatives = solved
    assert solution.tape is not None
    again = sg.solve(model)
    assert again.tape is None
    derivative = again.derivative(sg.pressure("joint").peak)
    assert derivative.friction["joint"] == derivatives["peak"].friction["joint"]
    assert "peak pressure of 'joint'" in repr(derivative)


def test_a_restart_goes_back_through_what_was_before(solved):
    model, _, derivatives = solved
    first = sg.solve(replace(model, steps=model.steps[:2]), tape=True)
    second = sg.solve(replace(model, steps=model.steps[2:]), start=first, tape=True)
    derivative = second.derivative(sg.pressure("joint").peak)
    assert derivative.friction["joint"] == pytest.approx(derivatives["peak"].friction["joint"], rel=1e-9)
    assert derivative.E["block"] == pytest.approx(derivatives["peak"].E["block"], rel=1e-9)
    untaped = sg.solve(replace(model, steps=model.steps[2:]), start=first.end, tape=True)
    with pytest.raises(sg.InputError, match="goes on from a history without a tape"):
        untaped.derivative(sg.pressure("joint").peak)


def test_what_derivatives_do_not_know_is_named():
    model = rig()
    block = replace(model.bodies[1], formulation="mean dilatation")
    yielding = with_body(replace(model, bodies=[model.bodies[0], block]), 1, plastic=sg.Plastic(1e4))
    with pytest.raises(sg.InputError, match="bodies that yield"):
        sg.solve(replace(model, bodies=yielding.bodies)).derivative(sg.pressure("joint").peak)
    with pytest.raises(sg.InputError, match="contacts with bonds"):
        sg.solve(bonded_bar(sg.Cohesion(5.0, opening=0.02), 0.012)).derivative(sg.pressure("bond").peak)
    solution = sg.solve(model, tape=True)
    for output, words in (
        (sg.pressure("hinge").peak, "hinge"),
        (sg.gap("joint")[9999], "no node 9999"),
        (sg.pressure("joint").peak.after(0.123), "expected one of"),
        (sg.displacement(0, along=(1.0,)), "1 components; expected 2"),
        (sg.stress("lid", 0, "xx"), "lid"),
    ):
        with pytest.raises(sg.InputError, match=words):
            solution.derivative(output)
    derivative = solution.derivative(sg.pressure("joint").peak)
    with pytest.raises(sg.InputError, match=r"kind\.name"):
        derivative.by("friction")
    with pytest.raises(sg.InputError, match="shear limit"):
        derivative.by("shear_limit.joint")
