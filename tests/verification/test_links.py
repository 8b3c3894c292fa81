# SPDX-License-Identifier: BSD-3-Clause
"""Equations and rigid bodies: against Lagrange multipliers, moved loads, equivalent models; balance and work."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import signorini as sg
from signorini.deck import read
from signorini.deck.write import write_deck
from signorini.engine.examine import examine
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.fem.stiffness import stiffness

ELASTIC = sg.Elastic(E=100.0, nu=0.3)
LEFT = sg.Support("left", u=(0, 0))


def plate(**given):
    """A block, fixed on the left."""
    mesh = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    return sg.Model(mesh, **{"bodies": [sg.Body("block", ELASTIC)], "supports": [LEFT]} | given)


def brick(**given):
    mesh = sg.box(x=[0, 0.5, 1], y=[0, 1], z=[0, 1, 2])
    supports = [sg.Support("bottom", u=(0, 0, 0))]
    return sg.Model(mesh, **{"bodies": [sg.Body("block", ELASTIC)], "supports": supports} | given)


def by_multipliers(model, C):
    """Displacements under ``C u = 0`` from the saddle point problem of the whole, dense."""
    found = examine(model)
    K = stiffness(found.space, model).toarray()
    held = np.zeros(len(K), bool)
    held[found.space.dofs(model.mesh.nodes_of("left")).ravel()] = True
    free, C = ~held, np.asarray(C.todense())[:, ~held]
    f = sum(found.loads.values())[free]
    n, m = free.sum(), len(C)
    A = np.block([[K[np.ix_(free, free)], C.T], [C, np.zeros((m, m))]])
    u = np.zeros(len(K))
    u[free] = np.linalg.lstsq(A, np.concatenate([f, np.zeros(m)]), rcond=None)[0][:n]
    return found.space.at_nodes(u)


@pytest.mark.parametrize("seed", range(6))
def test_any_equations_are_those_of_lagrange(seed):
    """Random ones: chains, dofs in several of them, some that follow from others, some on held dofs."""
    rng = np.random.default_rng(seed)
    numbers = range(1, 16)
    equations = []
    for _ in range(rng.integers(3, 9)):
        nodes = rng.choice(numbers, size=rng.integers(2, 5), replace=False)
        terms = [(int(node), "xy"[rng.integers(2)], float(rng.choice([-2.0, -1.0, 0.5, 1.0]))) for node in nodes]
        equations.append(sg.Equation(terms))
    again = [replace(e, terms=[(on, axis, 3.0 * c) for on, axis, c in e.terms]) for e in equations[:2]]
    force = sg.Load("right", force=(1.0, -2.0))
    model = plate(loads=[force], equations=[*equations, *again])
    entries = [(row, 2 * (on - 1) + "xy".index(axis), c) for row, e in enumerate(equations) for on, axis, c in e.terms]
    rows, columns, values = zip(*entries, strict=True)
    C = sp.csr_array((values, (rows, columns)), shape=(len(equations), model.mesh.points.size))
    step = solve(model).last
    np.testing.assert_allclose(step.displacement, by_multipliers(model, C), atol=1e-10)
    assert step.certificate.passed
    assert step.work == pytest.approx(step.strain_energy, rel=1e-9)


def test_an_equation_passes_forces_on():
    """The right edge hangs on one free node: the load there is the load on the edge; the support feels it."""
    sets = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    mesh = sg.Mesh(
        points=np.vstack([sets.points, [[9.0, 9.0]]]), cells=sets.cells, bodies=sets.bodies,
        boundaries=sets.boundaries, nodes={"hook": [len(sets.points)]},
    )  # fmt: skip
    hung = [sg.Equation([("right", axis, 1.0), ("hook", axis, -1.0)]) for axis in "xy"]
    given = {"bodies": [sg.Body("block", ELASTIC)], "equations": hung}
    pulled = solve(sg.Model(mesh, supports=[LEFT], loads=[sg.Load("hook", force=(3.0, 1.0))], **given)).last
    held = solve(plate(loads=[sg.Load("right", force=(3.0, 1.0), spread="displacement")])).last
    np.testing.assert_allclose(pulled.displacement[:-1], held.displacement, atol=1e-12)
    np.testing.assert_allclose(pulled.external[-1], [3.0, 1.0])
    moved = sg.Support("hook", u=tuple(pulled.displacement[-1]), name="move")
    driven = solve(sg.Model(mesh, supports=[LEFT, moved], **given)).last
    np.testing.assert_allclose(driven.reactions["move"], [3.0, 1.0], rtol=1e-9)
    np.testing.assert_allclose(driven.reactions["left"], [-3.0, -1.0], rtol=1e-9)


def test_what_a_support_holds_another_term_gives():
    """u_1 = 2 u_2 with u_1 driven moves u_2 by half; the reaction there has the other's force in it."""
    single = sg.Equation([((2.0, 1.0), "y", 1.0), ((1.0, 1.0), "y", -2.0)])
    up = sg.Support((2.0, 1.0), u=(None, 0.1), name="up")
    step = solve(plate(supports=[LEFT, up], equations=[single])).last
    points = plate().mesh.points
    at = {tuple(point): u for point, u in zip(points, step.displacement, strict=True)}
    assert at[1.0, 1.0][1] == pytest.approx(0.05)
    # virtual work: the driving force does all of it
    assert 0.5 * step.reactions["up"][1] * 0.1 == pytest.approx(step.strain_energy)


@pytest.mark.parametrize("cells", ["quad", "quad8", "triangle"])
def test_a_rigid_edge_that_cannot_turn_is_one_that_moves_in_one_piece(cells):
    mesh = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2, cells=cells)
    model = replace(plate(), mesh=mesh)
    rigid = sg.RigidBody("head", on="right", point=(5.0, 5.0))
    head = [sg.Support("head", u=(None, None, 0.0)), LEFT]
    pull = sg.Load("head", force=(1.0, 2.0, 0.0), name="f")
    one = solve(replace(model, supports=head, rigid_bodies=[rigid], loads=[pull]))
    two = solve(replace(model, loads=[sg.Load("right", force=(1.0, 2.0), spread="displacement")]))
    np.testing.assert_allclose(one.last.displacement, two.last.displacement, atol=1e-12)


def test_a_rigid_body_balances_forces_and_moments_and_works():
    load = sg.Load("head", force=(0.3, -1.0, 0.5), name="f")
    model = plate(rigid_bodies=[sg.RigidBody("head", on="right", point=(3.0, 1.5))], loads=[load])
    step = solve(model).last
    head, points = step.rigid_bodies["head"], model.mesh.points
    own = model.mesh.nodes_of("right")
    lever = points[own] - (3.0, 1.5)
    turned = head.rotation * np.column_stack([-lever[:, 1], lever[:, 0]])
    np.testing.assert_allclose(step.displacement[own], head.displacement + turned, atol=1e-14)
    np.testing.assert_allclose(step.reactions["left"], [-0.3, 1.0], atol=1e-12)
    assert step.work == pytest.approx(0.5 * (0.3 * head.displacement[0] - head.displacement[1] + 0.5 * head.rotation))
    assert abs(step.energy_defect) < 1e-12
    # driven by that motion, it needs that force; its point may be another one
    u = (*head.displacement, head.rotation)
    driven = replace(model, loads=(), supports=[LEFT, sg.Support("head", u=u, name="drive")])
    np.testing.assert_allclose(solve(driven).last.reactions["drive"], [0.3, -1.0, 0.5], rtol=1e-9)
    shift = np.array([1.0, -2.0])
    moment = 0.5 - (shift[0] * -1.0 - shift[1] * 0.3)
    elsewhere = replace(
        model,
        rigid_bodies=[sg.RigidBody("head", on="right", point=(4.0, -0.5))],
        loads=[replace(load, force=(0.3, -1.0, moment))],
    )
    np.testing.assert_allclose(solve(elsewhere).last.displacement, step.displacement, atol=1e-12)


def test_a_rigid_face_in_space_turns_about_every_axis():
    force, moment = np.array([1.0, -2.0, 0.5]), np.array([0.2, 0.3, -0.4])
    point = np.array([0.2, 0.7, 3.0])
    load = sg.Load("head", force=(*force, *moment), name="f")
    model = brick(rigid_bodies=[sg.RigidBody("head", on="top", point=tuple(point))], loads=[load])
    step = solve(model).last
    head, own = step.rigid_bodies["head"], model.mesh.nodes_of("top")
    expected = head.displacement + np.cross(head.rotation, model.mesh.points[own] - point)
    np.testing.assert_allclose(step.displacement[own], expected, atol=1e-13)
    reaction = step.external[model.mesh.nodes_of("bottom")]
    about = np.cross(model.mesh.points[model.mesh.nodes_of("bottom")] - point, reaction)
    np.testing.assert_allclose(reaction.sum(axis=0), -force, atol=1e-10)
    np.testing.assert_allclose(about.sum(axis=0), -moment, atol=1e-10)
    half = 0.5 * (force @ head.displacement + moment @ head.rotation)
    assert step.work == pytest.approx(half)
    assert step.strain_energy == pytest.approx(half)
    driven = sg.Support("head", u=(*head.displacement, *head.rotation), name="drive")
    again = solve(replace(model, loads=(), supports=[*model.supports, driven])).last
    np.testing.assert_allclose(again.reactions["drive"], [*force, *moment], rtol=1e-8)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_rigid_block_presses_like_a_very_stiff_one(friction):
    """A meshed body that is rigid, free to sink and to tilt under a force and a moment."""
    base = sg.rectangle(width=4.0, height=1.0, nx=8, ny=2)
    tool = sg.rectangle(width=2.0, height=0.5, nx=4, ny=1, origin=(1.0, 1.0))
    force = (0.1 if friction else 0.0, -1.0, 0.05)
    guide = [] if friction else [sg.Support("tool", u=(0.0, None, None), name="guide")]
    mesh = sg.join({"base": base, "iron": tool})
    meshed = sg.Model(
        mesh,
        bodies=[sg.Body("base", ELASTIC), sg.Body("iron", ELASTIC)],
        supports=[sg.Support("base.bottom", u=(0, 0)), *guide],
        rigid_bodies=[sg.RigidBody("tool", on="iron", point=(2.0, 1.5))],
        loads=[sg.Load("tool", force=force, name="push")],
        contacts=[sg.Contact("iron.bottom", "base.top", friction=friction)],
        steps=[sg.Step(path="exact" if friction else None)],
    )
    found = solve(meshed)
    own = mesh.bodies["iron"]
    cells = mesh.cells["quad"][own]
    head, step = found.last.rigid_bodies["tool"], found.last
    lever = mesh.points[np.unique(cells)] - (2.0, 1.5)
    turned = head.rotation * np.column_stack([-lever[:, 1], lever[:, 0]])
    np.testing.assert_allclose(step.displacement[np.unique(cells)], head.displacement + turned, atol=1e-12)
    contact, forces = step.contacts[0], step.contacts[0].forces
    np.testing.assert_allclose(forces.sum(axis=0), [-force[0], 1.0], atol=1e-9)
    arm = contact.points - (2.0, 1.5)
    assert (arm[:, 0] * forces[:, 1] - arm[:, 1] * forces[:, 0]).sum() == pytest.approx(-force[2], abs=1e-9)
    # a stiff tool instead: the answers meet as it gets stiffer
    stiff = replace(
        meshed,
        bodies=[sg.Body("base", ELASTIC), sg.Body("iron", sg.Elastic(E=1e9, nu=0.3))],
        rigid_bodies=[sg.RigidBody("tool", on="iron.top", point=(2.0, 1.5))],
    )
    other = solve(stiff).last.contacts[0]
    np.testing.assert_allclose(other.pressure, contact.pressure, atol=1e-5 * contact.pressure.max())


def test_half_a_rigid_head_on_a_plane_of_symmetry():
    """A support holds nodes of the rigid body itself: what is left of its motion is what it allows."""
    half = sg.rectangle(width=1.0, height=1.0, nx=2, ny=2)
    body = [sg.Body("block", ELASTIC)]
    model = sg.Model(
        half,
        bodies=body,
        supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(0, 0))],
        rigid_bodies=[sg.RigidBody("head", on="top", point=(0.3, 2.0))],
        loads=[sg.Load("head", force=(0.0, -1.0, 0.0), name="push")],
    )
    head = solve(model).last.rigid_bodies["head"]
    assert abs(head.rotation) > 1e-3
    assert abs(head.displacement[0] + head.rotation) < 1e-14  # x of the one node on the plane is held, 1 below
    whole = replace(model, rigid_bodies=[sg.RigidBody("head", on="block", point=(0.3, 2.0))], loads=())
    whole = replace(
        whole, supports=[sg.Support("left", u=(0, None)), sg.Support("head", u=(None, 0.1, None), name="up")]
    )
    found = solve(whole).last.rigid_bodies["head"]
    np.testing.assert_allclose([*found.displacement, found.rotation], [0.0, 0.1, 0.0], atol=1e-15)


def test_a_rigid_body_in_an_axisymmetric_model_moves_along_the_axis():
    mesh = sg.rectangle(width=1.0, height=1.0, nx=2, ny=2)
    model = sg.Model(
        mesh,
        kind="axisymmetric",
        bodies=[sg.Body("block", ELASTIC)],
        supports=[sg.Support("bottom", u=(0, 0))],
        rigid_bodies=[sg.RigidBody("head", on="top", point=(0.0, 1.0))],
        loads=[sg.Load("head", force=(0.0, -1.0, 0.0), name="push")],
    )
    step = solve(model).last
    top = step.displacement[mesh.nodes_of("top")]
    np.testing.assert_allclose(top[:, 0], 0.0, atol=1e-15)
    np.testing.assert_allclose(top[:, 1], step.rigid_bodies["head"].displacement[1])
    assert step.reactions["bottom"][1] == pytest.approx(1.0)


def test_what_nothing_holds_is_named_with_the_rigid_body():
    with pytest.raises(InputError, match=r"body 'block' can .* while rigid body 'head' can .*no support or contact"):
        examine(plate(supports=[], rigid_bodies=[sg.RigidBody("head", on="right", point=(0.0, 0.0))]))


def test_contradictions_and_mistakes_are_named():
    up = sg.Support("right", u=(None, 0.1), name="up")
    with pytest.raises(InputError, match=r"equation\[0\]: contradicts the supports.*'up'"):
        examine(plate(supports=[LEFT, up], equations=[sg.Equation([("right", "y", 1.0), ((0.0, 0.0), "y", 1.0)])]))
    agreed = sg.Equation([((2.0, 0.0), "y", 1.0), ((2.0, 1.0), "y", -1.0)])
    examine(plate(supports=[LEFT, up], equations=[agreed]))
    for terms, words in (
        ([("right", "z", 1.0)], r"equation\[0\]\.terms\[0\]: 'z' is no direction here; expected one of x, y"),
        ([("right", "x", 1.0), ("top", "x", 1.0)], r"has 3 nodes; expected 1 or 5"),
        ([(77, "x", 1.0)], "there is no node 77"),
        ([("rihgt", "x", 1.0)], "did you mean 'right'"),
    ):
        with pytest.raises(InputError, match=words):
            examine(plate(equations=[sg.Equation(terms)]))
    with pytest.raises(InputError, match=r"terms\[0\]\[2\]: is 0"):
        sg.Equation([("right", "x", 0.0)])
    head = sg.RigidBody("head", on="right", point=(0.0, 0.0))
    with pytest.raises(InputError, match="has 2 components; expected 3, one for each of x, y, rotation"):
        plate(rigid_bodies=[head], supports=[LEFT, sg.Support("head", u=(0, 0))])
    with pytest.raises(InputError, match="expected a name of its own"):
        plate(rigid_bodies=[head, head])


def test_a_deck_says_the_same(tmp_path):
    model = plate(
        rigid_bodies=[sg.RigidBody("head", on="right", point=(3.0, 1.5))],
        equations=[
            sg.Equation([((1.0, 1.0), "y", 1.0), (4, "y", -1.5), ("head", "rotation", 0.25)], name="lever"),
        ],
        loads=[sg.Load("head", force=(0.3, -1.0, 0.5), name="f")],
    )
    write_deck(model, tmp_path / "deck.toml")
    again = read(tmp_path / "deck.toml")
    assert again.rigid_bodies == model.rigid_bodies
    assert again.equations == model.equations
    np.testing.assert_array_equal(solve(again).last.displacement, solve(model).last.displacement)
    sg.solve(model).write(tmp_path / "s.h5")
    np.testing.assert_array_equal(sg.load(tmp_path / "s.h5").last.external, solve(model).last.external)
