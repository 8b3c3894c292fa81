"""Natural modes: against closed forms, against one another, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.mass import mass_matrix
from signorini.fem.space import make_space
from signorini.vibration import eigen
from tests.helpers.families import FAMILIES, KINDS, MIXED, block

STEEL = sg.Elastic(E=200.0, nu=0.3, density=2.0)


def blocks(*, cells="quad", friction=0.3, compliance=0.0, n=6):
    """A block on a block, pressed together on a base that is held."""
    parts = {
        "lower": sg.rectangle(width=1.0, height=0.5, nx=n, ny=n // 2, cells=cells),
        "upper": sg.rectangle(width=1.0, height=0.5, origin=(0.0, 0.5), nx=n, ny=n // 2, cells=cells),
    }
    return sg.Model(
        sg.join(parts),
        kind="plane stress",
        bodies=[sg.Body(name, STEEL) for name in parts],
        supports=[sg.Support("lower.bottom", u=(0, 0))],
        loads=[sg.Load("upper.top", pressure=1.0)],
        contacts=[
            sg.Contact(
                "upper.bottom",
                "lower.top",
                friction=friction,
                normal_compliance=compliance,
                tangential_compliance=compliance,
            )
        ],
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("family", [*FAMILIES, *MIXED])
def test_mass_is_exact_for_rigid_motions(family, kind):
    mesh = block(family, crooked=0.03)
    model = sg.Model(mesh, kind=kind, bodies=[sg.Body("block", STEEL)])
    space = make_space(mesh, kind=kind)
    M, points = mass_matrix(space, model), mesh.points
    finer = make_space(mesh, kind="axisymmetric")  # the higher quadrature
    for u in (np.ones(len(points)), *points.T):
        found = u @ M[::2, ::2] @ u
        exact = 0.0
        for cells, volumes in zip(finer.blocks, finer.volumes, strict=True):
            at = np.einsum("qk,mki->mqi", cells.values, points[cells.cells])
            own = np.einsum("qk,mk->mq", cells.values, u[cells.cells])
            ring = 2.0 * np.pi * at[..., 0] if kind == "axisymmetric" else 1.0
            exact += STEEL.density * float((volumes * ring * own**2).sum())
        assert found == pytest.approx(exact, rel=2e-6)  # the other quadrature is not exact on bent cells
    used = space.dofs(space.used_nodes).ravel()
    assert np.linalg.eigvalsh(M[used][:, used].toarray()).min() > 0.0


@pytest.mark.parametrize(
    ("mesh", "kind", "count"),
    [
        (sg.rectangle(width=2.0, nx=4, ny=2), "plane strain", 3),
        (sg.rectangle(x=[0.0, 0.5, 1.0], y=[0.0, 1.0]), "axisymmetric", 1),
        (sg.rectangle(width=2.0, nx=14, ny=14), "plane strain", 3),
        (sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]), "3d", 6),
    ],
)
def test_bodies_that_nothing_holds_have_their_rigid_motions(mesh, kind, count):
    model = sg.Model(mesh, kind=kind, bodies=[sg.Body(name, STEEL) for name in mesh.bodies])
    modes = sg.natural_modes(model, count + 2)
    assert (modes.squares[:count] == 0.0).all()
    assert (modes.squares[count:] > 0.0).all()
    assert modes.missed == 0
    assert modes.residuals.max() < 1e-8


@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_a_stuck_joint_is_a_tie_is_one_body(cells):
    one = sg.rectangle(width=1.0, height=1.0, nx=6, ny=6, cells=cells)
    whole = sg.Model(
        one, kind="plane stress", bodies=[sg.Body("block", STEEL)], supports=[sg.Support("bottom", u=(0, 0))]
    )
    exact = sg.natural_modes(whole, 5).squares
    solution = sg.solve(blocks(cells=cells))
    stuck = sg.natural_modes(solution, 5)
    tied = sg.natural_modes(sg.solve(blocks(cells=cells, friction="tied")), 5, joint="open")
    if cells == "quad":
        assert stuck.squares == pytest.approx(exact, rel=1e-9)
    else:  # pairs are at corners: middles of edges may part
        assert stuck.squares == pytest.approx(exact, rel=5e-3)
    assert tied.squares == pytest.approx(stuck.squares, rel=1e-9)


def test_fewer_constraints_never_raise_a_mode():
    solution = sg.solve(blocks())
    stuck, slipping, apart = (
        sg.natural_modes(solution, 8, joint=joint).squares for joint in ("stuck", "slipping", "open")
    )
    assert (stuck >= slipping * (1 - 1e-9)).all()
    assert (slipping >= apart * (1 - 1e-9)).all()
    assert stuck[0] > 1.1 * slipping[0]
    assert (apart[:3] == 0.0).all()  # the upper block is free


def test_pairs_that_a_step_opens_hold_nothing():
    model = blocks()
    lifted = replace(
        model,
        supports=[*model.supports, sg.Support("upper.top", u=(0.0, 0.01), name="lift")],
        loads=[],
        steps=[sg.Step(name="lift")],
    )
    solution = sg.solve(lifted)
    stuck, apart = (sg.natural_modes(solution, 4, joint=joint).squares for joint in ("stuck", "open"))
    assert stuck == pytest.approx(apart, rel=1e-12)
    drawn = sg.natural_modes(lifted, 4).squares  # as drawn the blocks touch
    assert drawn[0] > 1.1 * stuck[0]


def test_compliance_of_a_contact_is_a_spring():
    """A nearly rigid block on a compliant bed: its mass on the springs of the bed."""
    c = 0.01
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
        kind="plane stress",
        bodies=[sg.Body("block", replace(STEEL, E=1e7))],
        loads=[sg.Load("top", pressure=1.0)],
        contacts=[
            sg.Contact(
                "bottom",
                sg.Plane(point=(0, 0), normal=(0, 1)),
                friction=0.5,
                normal_compliance=c,
                tangential_compliance=c,
            )
        ],
    )
    solution = sg.solve(model)
    # up and down: k / m = (A / c) / (rho A h); to and fro with the rotation, by a 2 x 2 eigenvalue problem
    k, m, J = 2.0 / c, 4.0, 4.0 * (4.0 + 1.0) / 12.0
    bed = 2.0 * (0.25 * 1.0**2 + 0.5 * 0.5**2) / c  # areas of its 5 nodes times their levers squared
    turn = bed + 0.25 * k  # springs along are half a height below the centre
    slipping = sg.natural_modes(solution, 3, joint="slipping").squares
    assert slipping[0] == 0.0
    assert slipping[1:] == pytest.approx([bed / J, k / m], rel=1e-4)
    coupled = np.linalg.eigvals(np.array([[k / m, 0.5 * k / m], [0.5 * k / J, turn / J]]))
    found = sg.natural_modes(solution, 3).squares
    assert found[[0, 2]] == pytest.approx(np.sort(coupled), rel=1e-4)
    assert found[1] == pytest.approx(k / m, rel=1e-4)


@pytest.mark.parametrize(("unloading", "slope"), [(None, 80.0), (400.0, 400.0)])
def test_a_closure_is_the_spring_of_its_line(unloading, slope):
    """A nearly rigid block on a gasket: up and down on the line that its pressure is on, or on that back from there."""
    gasket = sg.Closure([(0.0, 0.0), (0.1, 1.0), (0.15, 5.0)], unloading=unloading)
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
        kind="plane stress",
        bodies=[sg.Body("block", replace(STEEL, E=1e7))],
        supports=[sg.Support("left", u=(0.0, None)), sg.Support("right", u=(0.0, None))],
        loads=[sg.Load("top", pressure=2.0)],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), closure=gasket)],
    )
    found = sg.natural_modes(sg.solve(model), 2, joint="slipping").squares
    assert np.abs(found / (slope / STEEL.density) - 1.0).min() < 1e-3  # pressure per length over mass per area


def test_a_rigid_body_has_the_mass_of_its_cells():
    mesh = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    model = sg.Model(
        sg.join({"a": mesh, "b": sg.rectangle(width=2.0, height=1.0, origin=(0.0, 1.0), nx=4, ny=2)}),
        kind="plane stress",
        bodies=[sg.Body("a", replace(STEEL, E=2.0, density=1e-9)), sg.Body("b", STEEL)],
        rigid_bodies=[sg.RigidBody("weight", on="b", point=(1.0, 1.0))],
        supports=[sg.Support("a.bottom", u=(0, 0)), sg.Support("weight", u=(0.0, None, 0.0))],
        contacts=[sg.Contact("b.bottom", "a.top", friction="tied")],
        loads=[sg.Load("weight", force=(0.0, -1.0, 0.0))],
    )
    solution = sg.solve(model)
    spring = -1.0 / solution.last.displacement[model.mesh.nodes_of("b.top"), 1].mean()
    assert sg.natural_modes(model, 1).squares == pytest.approx(spring / 4.0, rel=1e-6)


def test_a_mode_that_lanczos_misses_is_counted(monkeypatch):
    """Of a square plate with double frequencies, one of a pair is taken away from what was found."""
    mesh = sg.rectangle(width=1.0, height=1.0, nx=14, ny=14)
    model = sg.Model(mesh, kind="plane stress", bodies=[sg.Body("block", STEEL)])
    found = sg.natural_modes(model, 6)
    assert found.missed == 0
    whole = eigen._some

    def without_one(inverse, count):
        squares, vectors = whole(inverse, count + 1)
        return np.delete(squares, 4), np.delete(vectors, 4, axis=1)

    monkeypatch.setattr(eigen, "_some", without_one)
    with pytest.raises(sg.SolveFailed, match=r"modes of the stuck joint are not certified: .* 1 missed"):
        sg.natural_modes(model, 6)


def test_shapes_that_are_none_fail_their_certificate(monkeypatch):
    model = blocks(n=4)
    whole = eigen._all

    def bent(inverse):
        squares, vectors = whole(inverse)
        vectors[:, 0] += 1e-2 * vectors[:, 1]
        return squares, vectors

    monkeypatch.setattr(eigen, "_all", bent)
    with pytest.raises(sg.SolveFailed, match="not certified"):
        sg.natural_modes(model, 3)


def test_shapes_are_in_units_of_mass_and_forces_project_on_them():
    modes = sg.natural_modes(sg.solve(blocks()), 4)
    products = np.einsum("aij,bij->ab", modes.shapes, modes.forces)
    assert products == pytest.approx(np.eye(4), abs=1e-9)
    assert modes.frequencies == pytest.approx(np.sqrt(modes.squares) / (2.0 * np.pi))


def wrong(**changes):
    return lambda: sg.natural_modes(replace(blocks(n=2), **changes), 2)


BODIES = [sg.Body("lower", STEEL), sg.Body("upper", replace(STEEL, density=0.0))]


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (wrong(bodies=BODIES), "body[1]: 'upper' has no density; modes need one in its material"),
        (lambda: sg.natural_modes(blocks(n=2), 0), "number: is 0; expected a whole number >= 1 and <= 1000"),
        (lambda: sg.natural_modes(blocks(n=2), 900), "number: is 900; the model has 12 modes"),
        (
            lambda: sg.natural_modes(blocks(n=2), 2, joint="closed"),
            "joint: unknown state of the joints 'closed'. Known: open, slipping, stuck",
        ),
        (
            wrong(
                contacts=[sg.Contact("upper.bottom", "tool", friction=0.1)],
                obstacles=[
                    sg.Rigid("tool", sg.Plane(point=(0.0, 0.5), normal=(0.0, 1.0)), u=(0.0, None), force=(None, 1.0))
                ],
                loads=[],
            ),
            "obstacle[0]: 'tool' has no mass and may move; modes need it driven in every direction",
        ),
    ],
)
def test_what_has_no_modes_is_named(ask, words):
    with pytest.raises(sg.InputError) as error:
        ask()
    assert str(error.value) == words


def test_sides_that_slide_far_are_refused():
    small = blocks(n=2)
    far = replace(small, contacts=[replace(small.contacts[0], sliding="finite")])
    with pytest.raises(sg.InputError, match=r'contact\[0\].sliding: is "finite"; modes know pairs that stay'):
        sg.natural_modes(far, 2)


def test_ties_compliances_and_stuck_pairs_agree_in_space():
    """A stuck joint of two bricks in space is one brick; a little compliance lowers its modes a little."""

    def bricks(**law):
        parts = {name: sg.box(x=[0.0, 0.5, 1.0], y=[0.0, 0.5, 1.0], z=z) for name, z in PARTS.items()}
        return sg.Model(
            sg.join(parts),
            bodies=[sg.Body(name, STEEL) for name in parts],
            supports=[sg.Support("lower.bottom", u=(0.0, 0.0, 0.0))],
            contacts=[sg.Contact("upper.bottom", "lower.top", **law)],
        )

    one = sg.box(x=[0.0, 0.5, 1.0], y=[0.0, 0.5, 1.0], z=[0.0, 0.5, 1.0])
    (name,) = one.bodies
    whole = sg.Model(one, bodies=[sg.Body(name, STEEL)], supports=[sg.Support("bottom", u=(0.0, 0.0, 0.0))])
    exact = sg.natural_modes(whole, 4).squares
    assert sg.natural_modes(bricks(friction=0.3), 4).squares == pytest.approx(exact, rel=1e-9)
    assert sg.natural_modes(bricks(friction="tied"), 4, joint="open").squares == pytest.approx(exact, rel=1e-9)
    soft, softer = (
        sg.natural_modes(bricks(friction=0.3, normal_compliance=c, tangential_compliance=c), 4).squares
        for c in (1e-5, 2e-5)
    )
    assert (softer < soft).all()
    assert (soft < exact).all()
    assert exact - softer == pytest.approx(2.0 * (exact - soft), rel=1e-2)  # first order in the compliance


PARTS = {"lower": [0.0, 0.5], "upper": [0.5, 1.0]}


def test_a_joint_that_parts_fails_its_certificate(monkeypatch):
    """Shapes of the open joint are no modes of the stuck one."""
    solution = sg.solve(blocks(n=4))
    apart = sg.natural_modes(solution, 6, joint="open")
    whole = eigen._all

    def loose(inverse):
        squares, vectors = whole(inverse)
        leaders = inverse.shifted.bodies.constraints.leaders
        vectors[:, 0] = apart.shapes[4].ravel()[leaders]
        return squares, vectors

    monkeypatch.setattr(eigen, "_all", loose)
    with pytest.raises(sg.SolveFailed, match=r"residual \d\.\de-1\d, .* parting 1\.0e\+00, none missed"):
        sg.natural_modes(solution, 1)
