# SPDX-License-Identifier: BSD-3-Clause
"""A law that nobody has, as a test of the design: its bound, its parameters, and its name among `law.friction.LAWS`.

Every method takes the bound; decks, check, archives and restarts take the parameters, and no file is changed for it.

Friction is a quadratic function of the normal force, ``F(p) = mu p - mu^2 p^2 / (4 L)`` up to its largest value L at
``p = 2 L / mu``, and L beyond: asperities that share the load bear less and less more.
"""

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import strategies as st

import signorini as sg
from signorini.arrays import Array, BoolArray
from signorini.checks import number
from signorini.cli.main import main
from signorini.deck.load import read
from signorini.deck.write import write_deck
from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.history import follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.solve import solve_contact
from signorini.law.bound import Bound, FrictionBound
from signorini.law.friction import LAWS, FrictionLaw
from signorini.law.states import OPEN, STICK
from signorini.meshing.plane import rectangle
from signorini.model.mesh import join
from signorini.solution.results import SLIP
from tests.helpers.contact_samples import for_all

SEEDS = st.integers(0, 10**6)
DIRECTIONS = st.sampled_from([2, 3])


@dataclass(frozen=True, kw_only=True, eq=False)
class QuadraticBound(Bound):
    """Friction mu, (n,), at the smallest normal forces, and the most there is, (n,) forces."""

    friction: Array
    limit: Array

    def at(self, p: Array) -> Array:
        share = np.minimum(self.friction * p / (2.0 * self.limit), 1.0)
        return self.limit * share * (2.0 - share)

    def tangent(self, p: Array) -> tuple[Array, Array]:
        slope = self.friction * (1.0 - np.minimum(self.friction * p / (2.0 * self.limit), 1.0))
        return slope, self.at(p) - slope * p

    @property
    def steepest(self) -> Array:
        return self.friction

    def among(self, kept: BoolArray) -> "QuadraticBound":
        return QuadraticBound(friction=self.friction[kept], limit=self.limit[kept])


@dataclass(frozen=True)
class QuadraticFriction(FrictionLaw):
    """Friction at the smallest pressures, and the largest traction, force per area: the keys of a deck."""

    friction: float
    limit: float

    def __post_init__(self):
        object.__setattr__(self, "friction", number(self.friction, ("friction",), least=0.0))
        object.__setattr__(self, "limit", number(self.limit, ("limit",), above=0.0))

    @staticmethod
    def bound(parameters, area):
        return QuadraticBound(friction=parameters["friction"], limit=parameters["limit"] * area)


@pytest.fixture(autouse=True)
def entered(monkeypatch):
    monkeypatch.setitem(LAWS, "quadratic", QuadraticFriction)


def posed(seed, directions, pairs=6, *, motions=0, press=1.0):
    """A random body, pressed, with a quadratic bound at every pair."""
    rng = np.random.default_rng((seed, directions))
    size = directions * pairs
    Q, _ = np.linalg.qr(rng.normal(size=(size, size)))
    W = (Q * np.append(np.ones(motions), rng.uniform(0.05, 0.95, size - motions))) @ Q.T
    b = rng.normal(size=size)
    b[:pairs] -= press
    bound = QuadraticBound(friction=rng.uniform(0.1, 0.8, pairs), limit=rng.uniform(0.05, 0.5, pairs))
    return ContactProblem.of(W=(W + W.T) / 2, b=b, friction=bound, motions=Q[:, :motions], scale=1.0)


@for_all(examples=30, seed=SEEDS, directions=DIRECTIONS)
def test_it_is_solved_and_certified_in_the_plane_and_in_space(seed, directions):
    problem = posed(seed, directions)
    answer = solve_contact(problem)
    assert answer.solved, answer.message
    assert certify(problem, answer.y) <= 1e-10
    # the law, written out: what presses has no gap, friction is what p bears and opposes the slip where there is any
    (gap, *slip), (p, *friction) = answer.h, answer.r
    most, size, moved = problem.friction.at(p), np.linalg.norm(friction, axis=0), np.linalg.norm(slip, axis=0)
    assert (gap * p == 0.0).all()
    assert (size <= most * (1.0 + 1e-9)).all()
    slides = (answer.state != OPEN) & (moved > 1e-6)
    np.testing.assert_allclose(size[slides], most[slides], rtol=1e-9)
    np.testing.assert_allclose((np.array(slip) * friction).sum(axis=0)[slides], -(moved * most)[slides], rtol=1e-6)
    assert not moved[answer.state == STICK].any()


def test_it_is_neither_coulombs_law_nor_a_limit():
    """One pair of compliance 1, pressed by 1 and pulled: it slips where the pull is above F(1), between both."""
    bound = QuadraticBound(friction=np.array([0.5]), limit=np.array([0.4]))
    most = 0.5 - 0.25 / (4.0 * 0.4)
    assert most < min(0.5, 0.4)
    for pull, state in ((0.98 * most, STICK), (1.02 * most, 3)):
        problem = ContactProblem.of(
            W=np.diag([0.5, 0.5]), b=np.array([-0.5, 0.5 * pull]), friction=bound, motions=np.zeros((2, 0)), scale=1.0
        )
        answer = solve_contact(problem)
        assert answer.state.tolist() == [state]
        np.testing.assert_allclose(answer.r[:, 0], [1.0, -min(pull, most)], atol=1e-12)


@for_all(examples=15, seed=SEEDS, directions=DIRECTIONS)
def test_frozen_at_its_own_forces_it_is_trescas_law(seed, directions):
    problem = posed(seed, directions)
    answer = solve_contact(problem)
    frozen = FrictionBound.constant(problem.friction.at(answer.r[0]))
    y = answer.y.copy()
    other = ContactProblem(image=problem.image, b=problem.b, friction=frozen, scale=1.0)
    assert certify(other, y) <= 1e-9


@for_all(examples=15, seed=SEEDS, directions=DIRECTIONS)
def test_what_floats_is_solved_or_proved_to_leave(seed, directions):
    """The proof takes the steepest slope: the cone of it holds all forces that the law allows."""
    problem = posed(seed, directions, motions=1, press=0.2)
    answer = solve_contact(problem)
    pull = pulled_away(problem)
    assert (answer.outcome == "no_equilibrium") == (pull is not None and not answer.solved)
    if pull is not None:
        h, r = problem.by_pair(pull.motion), problem.half_axes
        assert (h[0] - np.linalg.norm(r * h[1:], axis=0)).min() > -1e-6
        assert not answer.solved


def test_what_needs_straight_branches_says_so():
    problem = posed(1, 3)
    with pytest.raises(InputError, match="friction: has no straight branches, which exact histories follow"):
        follow(problem, initial_state(problem, np.zeros(18), motion=np.zeros((3, 6))), problem.b)


LAW = '{ law = "quadratic", friction = 0.4, limit = 3.0 }'
PLANE = """kind = "plane strain"
[mesh]
generator = "rectangle"
x = [0, 0.5, 1, 1.5, 2]
y = [0, 0.5, 1]
[[support]]
on = "left"
u = [0, "free"]
"""
SPACE = """kind = "3d"
[mesh]
generator = "box"
x = [0, 0.5, 1, 1.5, 2]
y = [0, 0.5, 1]
z = [0, 0.5, 1]
[[support]]
on = "left"
u = [0, "free", "free"]
[[support]]
on = "front"
u = ["free", 0, "free"]
"""
REST = """
[material.rubber]
E = 100.0
nu = 0.4
[[body]]
name = "block"
material = "rubber"
[[load]]
on = "top"
pressure = 10.0
[[contact]]
nonmortar = "bottom"
plane = {{ point = {point}, normal = {normal} }}
friction = {friction}
name = "floor"
[[step]]
name = "half"
scale = {{ top = 0.5 }}
increments = {increments}
[[step]]
name = "whole"
"""


def deck(folder, friction=LAW, *, space=False, increments=4):
    """A block with a wall at its left, pressed on a floor: it spreads, and slips."""
    point, normal = ("[0, 0, 0]", "[0, 0, 1]") if space else ("[0, 0]", "[0, 1]")
    given = REST.format(point=point, normal=normal, friction=friction, increments=increments)
    path = folder / "deck.toml"
    path.write_text((SPACE if space else PLANE) + given)
    return path


@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_a_deck_names_it_and_it_is_solved_certified_and_restarted(tmp_path, space):
    path = deck(tmp_path, space=space)
    model = read(path)
    assert model.contacts[0].friction == QuadraticFriction(0.4, 3.0)
    solution = sg.solve(model)
    assert all(step.certificate.passed for step in solution.steps)
    floor = solution.contact("floor")
    size, p = np.linalg.norm(floor.shear, axis=-1), floor.pressure
    most = np.where(0.4 * p < 6.0, 0.4 * p - 0.04 * p**2 / 3.0, 3.0)
    assert (size <= most * (1.0 + 1e-9)).all()
    slips = floor.status == SLIP
    assert slips.sum() >= 2
    np.testing.assert_allclose(size[slips], most[slips], rtol=1e-8)
    # an archive holds it, and the history goes on from there as it did
    first = sg.solve(replace(model, steps=model.steps[:1]))
    first.write(tmp_path / "first.h5")
    start = sg.load(tmp_path / "first.h5")
    assert start.model.contacts[0].friction == model.contacts[0].friction
    again = sg.solve(replace(model, steps=model.steps[1:]), start=start)
    np.testing.assert_array_equal(again.contact("floor").pressure, p)
    other = [replace(model.contacts[0], friction=QuadraticFriction(0.4, 2.5))]
    with pytest.raises(InputError, match=r"has the quadratic limit 3 at node \d+ of contact 'floor'"):
        sg.solve(replace(model, contacts=other, steps=model.steps[1:]), start=start)
    # and so does a deck that is written
    write_deck(model, tmp_path / "copy.toml")
    assert read(tmp_path / "copy.toml").contacts[0] == model.contacts[0]


def line_of(path, words):
    return next(i for i, line in enumerate(path.read_text().splitlines(), start=1) if words in line)


@pytest.mark.parametrize(
    ("friction", "said"),
    [
        ('{ law = "quadratic", friction = 0.4, limit = -3 }', "friction.limit: is -3; expected a number > 0"),
        ('{ law = "quadratic", friction = 0.4 }', "friction: has no 'limit'; expected it"),
        ('{ law = "quadratic", mu = 1, limit = 3 }', "friction.mu: unknown key. Known: friction, limit"),
        ('{ law = "cubic" }', "friction.law: unknown law of friction 'cubic'. Known: quadratic, tabular"),
        (f"{LAW}\nadhesion = 1.0", "adhesion: is given, but friction has a law of its own, quadratic"),
    ],
)
def test_what_is_wrong_of_it_is_refused_with_line_and_key(tmp_path, friction, said):
    path = deck(tmp_path, friction)
    with pytest.raises(InputError) as error:
        read(path)
    line = line_of(path, "adhesion" if "adhesion" in friction else "friction =")
    assert str(error.value) == f"{path}:{line}: contact[0].{said}"


def test_what_only_coulombs_law_has_is_refused(tmp_path):
    model = read(deck(tmp_path))
    change, path = replace(model.steps[1], friction={"floor": 0.2}), replace(model.steps[1], path="exact")
    with pytest.raises(InputError, match=r"friction\.floor: is given, but friction has a law of its own, quadratic"):
        replace(model, steps=[model.steps[0], change])
    with pytest.raises(InputError, match="but the friction of contact 'floor' has no straight branches to follow"):
        replace(model, steps=[model.steps[0], path])


def test_check_and_the_summary_say_it(tmp_path, capsys):
    assert main(["check", str(deck(tmp_path))]) == 0
    assert "quadratic friction, friction 0.4, limit 3" in capsys.readouterr().out
    assert main(["run", str(deck(tmp_path)), "-o", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    expected = {"law": "quadratic", "friction": 0.4, "limit": 3.0}
    assert summary["steps"][-1]["contacts"][0]["friction"] == expected
    assert main(["plot", str(tmp_path / "out"), "--what", "contact"]) == 0


def blocks(*names):
    """Blocks beside each other, "new" with the new law and "old" with Coulomb's, each pressed on the floor."""
    friction = {"new": QuadraticFriction(0.4, 3.0), "old": 0.3}
    mesh = join({name: rectangle(width=2.0, nx=4, ny=2, origin=(5.0 * (name == "old"), 0.0)) for name in names})
    return sg.Model(
        mesh,
        kind="plane strain",
        bodies=[sg.Body(name, sg.Elastic(E=100.0, nu=0.4)) for name in names],
        supports=[sg.Support(f"{name}.left", u=(0, None)) for name in names],
        loads=[sg.Load(f"{name}.top", pressure=10.0) for name in names],
        contacts=[
            sg.Contact(f"{name}.bottom", sg.Plane((0, 0), (0, 1)), friction=friction[name], name=name) for name in names
        ],
        steps=[sg.Step(increments=4)],
    )


def test_a_contact_has_it_beside_another_with_coulombs_law():
    both = sg.solve(blocks("new", "old"))
    for name in ("new", "old"):
        alone, beside = sg.solve(blocks(name)).contact(name), both.contact(name)
        np.testing.assert_allclose(beside.pressure, alone.pressure, rtol=1e-9)
        np.testing.assert_allclose(beside.traction, alone.traction, rtol=1e-9, atol=1e-9)
        assert (beside.status == SLIP).any()


def test_where_a_support_holds_all_its_pairs_a_body_in_space_moves_alone():
    """The law of no pair at all knows its directions too."""
    model = sg.Model(
        sg.box(x=[0, 1], y=[0, 1], z=[0, 1]),
        kind="3d",
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.4))],
        supports=[sg.Support("left", u=(0, 0, 0)), sg.Support("bottom", u=(None, None, 0))],
        loads=[sg.Load("right", pressure=1.0)],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, -1), (0, 0, 1)), friction=QuadraticFriction(0.4, 3.0))],
        steps=[sg.Step(increments=1), sg.Step(scale={"right": 2.0})],
    )
    solution = sg.solve(model)
    assert solution.solved
    assert not solution.last.contacts[0].traction.any()
