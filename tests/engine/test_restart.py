# SPDX-License-Identifier: BSD-3-Clause
"""A history that goes on from the end of another is the whole one, through a file too; what does not fit is refused."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

import signorini as sg
from signorini.cli import main
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.spheres import equal_spheres

FIRST = [sg.Step(name="press"), sg.Step(name="off", scale={"cut": 0.4})]
SECOND = [sg.Step(name="again", scale={"cut": [0.9, 0.2]})]


def cylinder(steps, **changes):
    return zhu_cylinder(refine=2, steps=steps, **changes)


def block(steps, **changes):
    """A block on a floor beside a wall, held at two points that can let go."""
    given = {
        "bodies": [sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        "supports": [
            sg.Support((0, 1), u=(0.004, None), name="grip"),
            sg.Support((1, 1), u=(None, 0), name="rest"),
        ],
        "loads": [sg.Load("right", traction=(2.0, 0.5), name="pull"), sg.Load("top", pressure=5.0, name="press")],
        "contacts": [
            sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=0.5, name="floor"),
            sg.Contact("right", sg.Plane((2.003, 0), (-1, 0)), friction=0.2, name="wall"),
        ],
    }
    return sg.Model(sg.rectangle(width=2.0, height=1.0, nx=6, ny=3), **(given | changes), steps=steps)


def cube(steps, facets=0):
    return sg.Model(
        sg.box(x=np.linspace(0, 1, 4), y=np.linspace(0, 1, 4), z=np.linspace(0, 1, 3)),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[
            sg.Support((0, 0, 1), u=(0.003, None, None), name="grip"),
            sg.Support((1, 0, 1), u=(0, 0, None)),
            sg.Support((1, 1, 1), u=(0, 0, None), name="wire"),
        ],
        loads=[sg.Load("top", pressure=5.0, name="press"), sg.Load("top", traction=(1.5, 0.5, 0), name="pull")],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=0.4, name="floor", facets=facets)],
        steps=steps,
    )


def different(one: Any, two: Any, path: str = "") -> Iterator[str]:
    """Where two results are not the same to the last bit; names of steps and loads counted from 1 may differ."""
    if is_dataclass(one):
        for part in fields(one):
            if part.name == "first":
                yield from first_yield(getattr(one, part.name), getattr(two, part.name), path)
            elif part.name not in ("name", "load_factor", "notes"):
                yield from different(getattr(one, part.name), getattr(two, part.name), f"{path}.{part.name}")
    elif isinstance(one, np.ndarray):
        if not np.array_equal(one, two, equal_nan=one.dtype.kind == "f"):
            yield path
    elif isinstance(one, tuple):
        assert len(one) == len(two), path
        for i, pair in enumerate(zip(one, two, strict=True)):
            yield from different(*pair, f"{path}[{i}]")
    elif isinstance(one, Mapping):
        assert set(one) == set(two), path
        for key in one:
            yield from different(one[key], two[key], f"{path}[{key}]")
    elif one != two and not (one != one and two != two):
        yield path


def first_yield(one: float | None, two: float | None, path: str) -> Iterator[str]:
    """Where load factors of first yield, which count the steps of a run, are not at the same part of a step."""
    apart = (one is None) != (two is None)
    if apart or (one is not None and two is not None and abs((one - two) - round(one - two)) > 1e-14):
        yield f"{path}.first"


def some(names, values, **size):
    return st.dictionaries(st.sampled_from(names), st.sampled_from(values), **size)


ANY_STEP = st.builds(
    sg.Step,
    scale=st.none() | some(("press", "pull", "grip"), [0.0, 0.25, 0.5, 1.0, -0.5]),
    friction=some(("floor", "wall"), [0.05, 0.3, 0.8, "stick"], max_size=1),
    interference=some(("floor", "wall"), [0.0, 0.002, 0.004], max_size=1),
    inactive=st.sampled_from([(), (), ("wall",), ("floor",)]),
    release=st.sampled_from([(), (), ("grip",), ("rest",)]),
    increments=st.sampled_from([None, None, 1, 3]),
    at=st.sampled_from([(), (0.5,)]),
)
BACK = st.sampled_from(
    [
        sg.Step(scale={}, active=["floor", "wall"]),
        sg.Step(scale={"grip": 0.7}, hold=["grip"]),
        sg.Step(scale={}, restore=["rest"], increments=2),
    ]
)


@pytest.mark.slow
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_a_history_cut_anywhere_goes_on_to_the_last_bit(tmp_path_factory: pytest.TempPathFactory, data) -> None:
    """Everything that steps change is carried: the steps behind a cut are those of the whole, bit by bit."""
    first = sg.Step(scale={"press": 0.5, "pull": 0.2, "grip": 0.3}, release=["rest"])
    steps = [first, *data.draw(st.lists(ANY_STEP | BACK, min_size=1, max_size=3))]
    cut = data.draw(st.integers(1, len(steps) - 1))
    try:
        whole = sg.solve(block(steps), raise_on_failure=False)
    except sg.InputError:
        assume(False)  # a body that nothing holds
    assume(len(whole.steps) >= cut and whole.steps[cut - 1].finished)
    event(f"cut after {cut} of {len(steps)}, {whole.status}")
    path = tmp_path_factory.mktemp("cut") / "state.npz"
    sg.solve(block(steps[:cut])).save_state(path)
    after = sg.solve(block(steps[cut:]), start=path, raise_on_failure=False)
    assert after.status == whole.status
    assert list(different(whole.steps[cut:], after.steps)) == []


@pytest.mark.slow
@pytest.mark.parametrize(("facets", "backend"), [(0, "auto"), (8, "auto"), (0, "iterative")])
def test_a_history_in_space_goes_on_to_the_last_bit(facets, backend) -> None:
    steps = [
        sg.Step(scale={"press": 1.0, "pull": 0.3, "grip": 0.5}),
        sg.Step(scale={}, friction={"floor": 0.2}, release=["grip"]),
        sg.Step(hold=["grip"], interference={"floor": 0.001}, scale={"pull": -0.4, "grip": 1.0}, increments=2),
        sg.Step(scale={"pull": 0.1}),
    ]
    whole = sg.solve(cube(steps, facets), backend=backend)
    for cut in (1, 3):
        before = sg.solve(cube(steps[:cut], facets), backend=backend)
        after = sg.solve(cube(steps[cut:], facets), start=before, backend=backend)
        assert list(different(whole.steps[cut:], after.steps)) == []


def bearing(steps, friction=0.3):
    """A cylinder tied onto a plate that a support lifts and lowers, pressed on a plane."""
    round_body = sg.half_disk(radius=8.0, contact_length=4.0, contact_spacing=1.0)
    plate = sg.rectangle(width=20.0, height=3.0, nx=8, ny=2, origin=(-10.0, 8.0))
    return sg.Model(
        sg.join({"roller": round_body, "plate": plate}),
        bodies=[sg.Body("roller", sg.Elastic(E=1000.0, nu=0.3)), sg.Body("plate", sg.Elastic(E=3000.0, nu=0.3))],
        supports=[
            sg.Support("plate.top", u=(0, -0.5), name="lower"),
        ],
        loads=[sg.Load("roller.cut", force=(20.0, -100.0), name="press")],
        contacts=[
            sg.Contact("roller.cut", "plate.bottom", friction="tied", name="glue"),
            sg.Contact("roller.arc", sg.Plane((0, 0), (0, 1)), friction=friction, name="floor"),
        ],
        steps=steps,
    )


def ball(steps, facets=0, friction=0.3):
    model = equal_spheres(approach=0.4, n=2)
    moved = [
        replace(support, name="lower") if support.u[2] not in (None, 0.0) else support for support in model.supports
    ]
    contact = replace(model.contacts[0], friction=friction, facets=facets)
    return replace(model, supports=moved, contacts=[contact], steps=steps)


def rising(names, least=0.003):
    """Factors that mostly rise by far: later steps close pairs that the first ones leave out."""
    return st.builds(
        lambda factors, changes: [
            sg.Step(scale=dict.fromkeys(names, factor), **change)
            for factor, change in zip(np.cumprod(factors) * least, changes, strict=True)
        ],
        st.lists(st.sampled_from([1.5, 3.0, 10.0, 40.0, 0.2]), min_size=4, max_size=4),
        st.lists(st.sampled_from([{}, {}, {"increments": 2}, {"at": (0.5,)}]), min_size=4, max_size=4),
    )


REACHING = {
    "cylinder": (cylinder, ["cut"], "auto"),
    "tied": (bearing, ["lower", "press"], "auto"),
    "ball": (ball, ["lower"], "auto"),
    "facets": (lambda steps: ball(steps, facets=8), ["lower"], "auto"),
    "iterated": (lambda steps: cylinder([replace(step, increments=2) for step in steps]), ["cut"], "iterative"),
}


def assert_cut(kind, steps, cut) -> bool:
    """The steps before a cut and those behind it are the whole history's; whether pairs were added behind it."""
    model, _, backend = REACHING[kind]
    whole = sg.solve(model(steps), backend=backend, raise_on_failure=False)
    if len(whole.steps) < cut or not whole.steps[cut - 1].finished:
        return False
    first = sg.solve(model(steps[:cut]), backend=backend)
    after = sg.solve(model(steps[cut:]), start=first, backend=backend, raise_on_failure=False)
    assert after.status == whole.status
    assert list(different(whole.steps[:cut], first.steps)) == []
    assert list(different(whole.steps[cut:], after.steps)) == []
    return bool(whole.end.near.sum() > first.end.near.sum())


@pytest.mark.slow
@pytest.mark.parametrize("kind", REACHING)
def test_loads_that_reach_farther_change_no_bit_of_the_steps_before(kind) -> None:
    """Pairs are chosen by what was imposed so far, whatever follows: of one body, of tied ones, in space, iterated."""
    steps = [sg.Step(scale=dict.fromkeys(REACHING[kind][1], factor)) for factor in (0.01, 0.012, 1.0, 0.3)]
    assert assert_cut(kind, steps, 2)


@pytest.mark.slow
@pytest.mark.parametrize("kind", REACHING)
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_histories_that_reach_farther_and_farther_go_on_to_the_last_bit(kind, data) -> None:
    steps = data.draw(rising(REACHING[kind][1]))
    farther = assert_cut(kind, steps, data.draw(st.integers(1, len(steps) - 1)))
    event("farther" if farther else "no farther")


@pytest.mark.parametrize("what", [{"interference": {"fit": 0.02}}, {"friction": {"fit": 0.05}}, {"inactive": ["fit"]}])
def test_nothing_that_a_step_has_set_is_forgotten(what) -> None:
    """A hub shrunk on a shaft, then pulled: the second run names the pull alone."""
    mesh = sg.join(
        {
            "shaft": sg.rectangle(width=20.0, height=80.0, nx=4, ny=16, origin=(0, -20)),
            "hub": sg.rectangle(width=20.0, height=40.0, nx=4, ny=10, origin=(20, 0)),
        }
    )

    def fit(*steps):
        return sg.Model(
            mesh,
            kind="axisymmetric",
            bodies=[sg.Body(name, sg.Elastic(E=210e3, nu=0.3)) for name in ("shaft", "hub")],
            supports=[sg.Support("hub.top", u=(None, 0)), sg.Support("shaft.top", u=(None, 0.2), name="pull")],
            loads=[sg.Load("hub.right", pressure=20.0, name="squeeze")],
            contacts=[sg.Contact("hub.left", "shaft.right", friction=0.15, name="fit")],
            steps=steps,
        )

    shrink, pull = sg.Step(scale={"pull": 0, "squeeze": 1}, **what), sg.Step(scale={"pull": 1.0})
    whole, before = sg.solve(fit(shrink, pull)), sg.solve(fit(shrink))
    after = sg.solve(fit(pull), start=before)  # 'squeeze' is not named and stays
    assert list(different(whole.last, after.last)) == []
    assert after.last.factors == {"squeeze": 1.0, "pull": 1.0}
    with pytest.raises(sg.InputError, match="no step's scale names 'squeeze': it would never act"):
        sg.solve(fit(pull))


def test_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    before = sg.solve(cylinder(FIRST))
    model = cylinder(SECOND)
    stiffer = replace(model, bodies=[sg.Body("disk", sg.Elastic(E=300.0, nu=0.3))])
    renamed = replace(model, contacts=[replace(model.contacts[0], name="floor")])
    unloaded = replace(model, loads=[replace(model.loads[0], name="top")], steps=[sg.Step()])
    rougher = replace(model, contacts=[replace(model.contacts[0], friction=0.3)])
    tighter = replace(model, contacts=[replace(model.contacts[0], interference=0.01)])
    for wrong, message in (
        (zhu_cylinder(refine=1), r"^start: was computed on another mesh \(\d+ dofs; the model has 186\)"),
        (renamed, r"^start: has the contacts foundation; the model has floor"),
        (unloaded, r"^start: carries 'cut' at factor 0.4, which the model has not"),
        (stiffer, r"^start: is not in equilibrium in this model"),
        (
            rougher,
            r"^start: has the friction 0.4 at node 1 of contact 'foundation'; the model has the friction 0.3, ",
        ),
        (
            tighter,
            r"has the initial gap 0 at .*; the model has the initial gap -0.01, expected .*'interference'",
        ),
    ):
        with pytest.raises(sg.InputError, match=message):
            sg.solve(wrong, start=before)
    (tmp_path / "torn.npz").write_bytes(b"PK")
    with pytest.raises(sg.InputError, match="is no state that a run has written"):
        sg.solve(model, start=tmp_path / "torn.npz")
    with pytest.raises(sg.InputError, match="there is no file"):
        sg.solve(model, start=tmp_path / "none.npz")


def test_supports_that_prescribe_otherwise_are_refused() -> None:
    before = sg.solve(block([sg.Step()]))
    grip, rest = (replace(support) for support in block([sg.Step()]).supports)
    moved = block([sg.Step()], supports=[replace(grip, u=(0.005, None)), rest])
    words = r"has moved node 22 by 0.004 in x, where support 'grip' prescribes 0.005; expected"
    with pytest.raises(sg.InputError, match=words):
        sg.solve(moved, start=before)


def test_the_command_line_goes_on(tmp_path: Path) -> None:
    deck = (Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml").read_text()
    deck = deck[: deck.index("[[step]]")]
    for name, factors in (("one", "0.5"), ("two", "1.0"), ("whole", "[0.5, 1.0]")):
        (tmp_path / f"{name}.toml").write_text(f"{deck}\n[[step]]\nscale = {{ cut = {factors} }}\n")
    run = ["run", "--quiet", "-o"]
    assert main([*run, str(tmp_path / "a"), str(tmp_path / "one.toml")]) == 0
    assert main([*run, str(tmp_path / "b"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "a")]) == 0
    assert main([*run, str(tmp_path / "c"), str(tmp_path / "whole.toml")]) == 0
    pressures = []
    for name in "bc":
        rows = (tmp_path / name / "contact.csv").read_text().splitlines()
        column = rows[0].split(",").index("pressure")
        pressures.append([float(row.split(",")[column]) for row in rows[1:]])
    np.testing.assert_allclose(*pressures, rtol=0, atol=1e-9)
    assert main([*run, str(tmp_path / "d"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "one.toml")]) == 2


@pytest.mark.slow
def test_the_command_line_goes_on_with_bodies_that_have_yielded(tmp_path: Path) -> None:
    """What is let go after a restart is what is let go in one run, to the last digit of every file."""
    example = (Path(__file__).parents[2] / "examples" / "indentation.toml").read_text()
    deck, *steps = example.replace("increments = 40", "increments = 6").replace("= 20\n", "= 3\n").split("[[step]]")
    for name, parts in (("press", steps[:1]), ("leave", steps[1:]), ("whole", steps)):
        (tmp_path / f"{name}.toml").write_text("[[step]]".join([deck, *parts]))
    run = ["run", "--quiet", "-o"]
    assert main([*run, str(tmp_path / "a"), str(tmp_path / "press.toml")]) == 0
    assert main([*run, str(tmp_path / "b"), str(tmp_path / "leave.toml"), "--from", str(tmp_path / "a")]) == 0
    assert main([*run, str(tmp_path / "c"), str(tmp_path / "whole.toml")]) == 0
    later, whole = (json.loads((tmp_path / name / "summary.json").read_text())["steps"][-1] for name in "bc")
    assert whole["plastic"]["max_equivalent_strain"] > 0.005
    begins = [part["plastic"].pop("first_yield") for part in (later, whole)]  # counted from where each run begins
    assert begins[1] - begins[0] == pytest.approx(1.0, abs=1e-12)
    assert later["plastic"] == whole["plastic"]
    after, both = ((tmp_path / name / "contact.csv").read_text().splitlines()[1:] for name in "bc")
    assert [row.partition(",")[2] for row in after] == [row.partition(",")[2] for row in both if row[:2] == "2,"]
    hard = deck.replace("yield_stress = 600", "yield_stress = 700")
    (tmp_path / "hard.toml").write_text("[[step]]".join([hard, steps[1]]))
    assert main([*run, str(tmp_path / "d"), str(tmp_path / "hard.toml"), "--from", str(tmp_path / "a")]) == 2


STEEL = sg.Plastic([(0.0, 20.0), (0.01, 24.0)], hardening=10.0, backstresses=[(500.0, 20.0)])


def yielding(steps, plastic=STEEL, formulation=None, **changes):
    """The block of a material that yields under the loads of the steps."""
    bodies = [sg.Body("block", sg.Elastic(E=1000.0, nu=0.3, plastic=plastic), formulation)]
    loads = [sg.Load("right", traction=(6.0, 1.5), name="pull"), sg.Load("top", pressure=30.0, name="press")]
    supports = [sg.Support((0, 1), u=(0, None)), sg.Support((1, 1), u=(None, 0), name="rest")]
    return block(steps, bodies=bodies, loads=loads, supports=supports, **changes)


CYCLE = [
    sg.Step(scale={"press": 1.0, "pull": 0.1}, increments=4),
    sg.Step(scale={"press": 0.3, "pull": 1.0}),
    sg.Step(scale={"press": 1.1, "pull": -1.0}, increments=3),
    sg.Step(scale={"press": 0.0, "pull": 0.0}),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("through", "formulation"),
    [("memory", None), ("state", None), ("archive", None), ("memory", "incompatible"), ("archive", "incompatible")],
)
def test_bodies_that_have_yielded_go_on_to_the_last_bit(through, formulation, tmp_path):
    whole = sg.solve(yielding(CYCLE, formulation=formulation))
    assert whole.steps[0].yielding.first is not None
    assert whole.steps[2].plastic.dissipation > 0.0
    cut = sg.solve(yielding(CYCLE[:2], formulation=formulation))
    if through == "state":
        cut.save_state(tmp_path / "state.npz")
        start = tmp_path / "state.npz"
    elif through == "archive":
        cut.write(tmp_path / "cut.h5")
        start = sg.load(tmp_path / "cut.h5")
        for one, two in zip(start.steps, cut.steps, strict=True):
            assert not list(different(one, two))
    else:
        start = cut
    rest = sg.solve(yielding(CYCLE[2:], formulation=formulation), start=start)
    for one, two in zip(whole.steps[2:], rest.steps, strict=True):
        assert not list(different(one, two))
    assert not list(different(whole.end.state, rest.end.state))


def test_bodies_without_contact_go_on(tmp_path):
    steps = [sg.Step(scale={"pull": 0.5}), sg.Step(scale={"pull": 1.0}, increments=3)]

    def bar(steps):
        return sg.Model(
            sg.rectangle(width=2.0, nx=2),
            bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3, plastic=STEEL))],
            supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))],
            loads=[sg.Load("right", traction=(26.0, 0.0), name="pull")],
            steps=steps,
        )

    whole, cut = sg.solve(bar(steps)), sg.solve(bar(steps[:1]))
    cut.save_state(tmp_path / "state.npz")
    rest = sg.solve(bar(steps[1:]), start=tmp_path / "state.npz")
    assert whole.last.yielding.largest > 0.0
    assert not list(different(whole.last, rest.last))


@pytest.mark.parametrize(
    ("plastic", "words"),
    [
        (None, "that yields at 20, 24 at 0.01, hardening 10, 1 backstress; in the model it does not yield"),
        (sg.Plastic(20.0), "hardening 10, 1 backstress; in the model it yields at 20, expected the same law"),
        (replace(STEEL, backstresses=[(500.0, 21.0)]), "1 backstress; in the model its law is another, expected"),
    ],
)
def test_a_start_whose_bodies_yield_otherwise_is_refused(plastic, words):
    start = sg.solve(yielding(CYCLE[:1]))
    with pytest.raises(sg.InputError) as refused:
        sg.solve(yielding(CYCLE[1:], plastic=plastic), start=start)
    assert words in str(refused.value)
    with pytest.raises(sg.InputError, match="that does not yield; in the model it yields at 20"):
        sg.solve(yielding(CYCLE[1:]), start=sg.solve(yielding(CYCLE[:1], plastic=None)))
