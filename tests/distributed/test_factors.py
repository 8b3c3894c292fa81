"""Bodies that all ranks factorise by MUMPS: whatever needs the condensed interface has the answers of one process."""

import gc
import json
import weakref

import numpy as np
import pytest

import signorini as sg
from signorini.engine.prepare import prepare
from signorini.gallery.cubes import cubes
from tests.distributed.test_on_ranks import hold, on_ranks, with_petsc, with_ranks
from tests.helpers.on_ranks import CONDENSED, MODELS, WAYS


def held(found):
    """The same paths beside the same answers."""
    hold(found, "mumps")
    assert found["paths"][0] == found["paths"][1]


@with_petsc
@pytest.mark.parametrize("name", CONDENSED)
def test_what_needs_the_condensed_interface_is_factorised_by_itself(name):
    from tests.helpers.on_ranks import compared

    held(compared(name))


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 2, 3])
def test_same_answers_and_paths_as_one_process(number):
    """All models that ranks iterate on, and those that ask for the condensed interface."""
    done = on_ranks(number, "-m", "tests.helpers.on_ranks", "--backend", "mumps", *MODELS, *CONDENSED)
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    assert answers.keys() == (MODELS | CONDENSED).keys()
    assert ["exact"] in [found["paths"][0] for found in answers.values()]
    for found in answers.values():
        held(found)


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("cut", ["scattered nodes", "the contact on one"])
def test_answers_do_not_depend_on_where_nodes_are(cut):
    assert cut in WAYS
    names = ["cubes", "mortar", "several steps", "held by contact alone", "tied"]
    done = on_ranks(3, "-m", "tests.helpers.on_ranks", "--backend", "mumps", *names, "--cut", cut)
    assert done.returncode == 0, done.stderr
    for found in json.loads(done.stdout).values():
        held(found)


@with_petsc
@pytest.mark.parametrize("name", ["cubes", "mortar", "a rigid body that contact alone holds"])
def test_factors_are_those_of_one_process(name):
    """Condensed stiffness or compliance, condensed loads, several at once, and displacements again."""
    model = (MODELS | CONDENSED)[name]()
    here, there = (prepare(model, backend=backend).solver.condensed.factorisation for backend in ("auto", "mumps"))
    assert (there.name, there.n, there.m) == ("mumps", here.n, here.m)
    random = np.random.default_rng(2)

    def same(found, expected):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())

    same(there.schur(), here.schur())
    for shape in ((), (3,)):
        f, kept = random.standard_normal((here.n, *shape)), random.standard_normal((here.m, *shape))
        one, two = here.reduce(f), there.reduce(f)
        same(two.load, one.load)
        same(two.expand(kept), one.expand(kept))


def nothing(_team):
    """What ranks are asked for, to have them drop what nobody has any more."""


@with_petsc
def test_the_condensed_interface_stays_where_mumps_has_left_it():
    """MPI would copy it three times and does not take more than 2 GB; it is there as long as somebody has it."""
    from signorini.distributed.ranks import the_team

    factors = prepare(cubes(2), backend="mumps").solver.condensed.factorisation
    S, team = factors.schur(), the_team()
    assert S is team.held[max(team.held)].made.condensed
    assert not S.flags.owndata
    expected = S.copy()
    held = weakref.ref(team.held[max(team.held)])
    del factors
    gc.collect()
    team.everywhere(nothing)
    assert held() is None
    np.testing.assert_array_equal(S, expected)
    np.testing.assert_array_equal(S, S.T)


@with_petsc
def test_well_posedness_and_derivatives_choose_factors():
    """With the words, the proof and the sensitivities of one process."""
    model = MODELS["the paper's cylinder"]()
    one, two = (sg.solve(model, wellposed=True, tape=True, backend=backend) for backend in ("auto", "petsc"))
    assert two.backend == "mumps"
    assert two.wellposedness.words == one.wellposedness.words
    np.testing.assert_allclose(two.sensitivities().per_cent, one.sensitivities().per_cent, rtol=1e-9, atol=1e-11)
    places = [found.derivative(sg.pressure(model.contacts[0].label).peak).nodes for found in (one, two)]
    np.testing.assert_allclose(places[1], places[0], rtol=0, atol=1e-9 * np.abs(places[0]).max())


@with_petsc
def test_a_hinge_is_named_as_by_one_process():
    points = [[0, 0], [1, 0], [1, 1], [0, 1], [2.1, 1.2], [2, 2.3], [0.9, 1.8]]
    cells = {"quad": [[0, 1, 2, 3], [2, 4, 5, 6]]}
    mesh = sg.Mesh(points=points, cells=cells, bodies={"block": [0, 1]}, boundaries={"bottom": [[0, 1]]})
    model = sg.Model(
        mesh, bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))], supports=[sg.Support("bottom", u=(0, 0))]
    )
    with pytest.raises(sg.InputError, match=r"body 'block' has no stiffness against some motion of node .* \(a hinge"):
        prepare(model, backend="mumps")


@with_petsc
def test_petsc_without_mumps_is_told(monkeypatch):
    from signorini.distributed import refusals

    monkeypatch.setattr(refusals, "has_mumps", lambda: False)
    words = "back end 'mumps' needs a PETSc that was built with MUMPS; expected one"
    with pytest.raises(sg.InputError, match=words):
        sg.solve(cubes(2), backend="mumps")
