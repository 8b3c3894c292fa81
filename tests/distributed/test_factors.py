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
@pytest.mark.parametrize("how", [[], ["--twice"]])
def test_answers_do_not_depend_on_where_nodes_are_and_how_often_they_are_eliminated(cut, how):
    assert cut in WAYS
    names = ["cubes", "mortar", "several steps", "held by contact alone", "tied"]
    names += ["a rigid body that contact alone holds"]
    done = on_ranks(3, "-m", "tests.helpers.on_ranks", "--backend", "mumps", *names, "--cut", cut, *how)
    assert done.returncode == 0, done.stderr
    for found in json.loads(done.stdout).values():
        held(found)


@with_petsc
@pytest.mark.parametrize("twice", [False, True])
@pytest.mark.parametrize("name", ["cubes", "mortar", "tied", "a rigid body that contact alone holds"])
def test_factors_are_those_of_one_process(name, twice, monkeypatch):
    """What the bodies yield, condensed loads, several at once, and displacements again; factorised once or twice."""
    from signorini.distributed import factors

    monkeypatch.setattr(factors, "_WIDE", -1 if twice else np.inf)
    model = (MODELS | CONDENSED)[name]()
    one, two = (prepare(model, backend=backend).solver.condensed.response for backend in ("auto", "mumps"))
    here, there = one.factorisation, two.factorisation
    assert (there.name, there.n, there.m) == ("mumps", here.n, here.m)
    random = np.random.default_rng(2)

    def same(found, expected):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max(initial=0.0))

    same(two.compliance(), one.compliance())
    for shape in ((), (3,)):
        f, kept = random.standard_normal((here.n, *shape)), random.standard_normal((here.m, *shape))
        first, second = here.reduce(f), there.reduce(f)
        same(second.load, first.load)
        same(second.expand(kept), first.expand(kept))


def nothing(_team):
    """What ranks are asked for, to have them drop what nobody has any more."""


@with_petsc
@pytest.mark.parametrize("twice", [False, True])
def test_the_condensed_interface_stays_where_mumps_has_left_it(twice, monkeypatch):
    """MPI would copy it three times and does not take more than 2 GB; it is there as long as somebody has it."""
    from signorini.distributed import factors
    from signorini.distributed.ranks import the_team

    monkeypatch.setattr(factors, "_WIDE", -1 if twice else np.inf)
    condensed, team = prepare(cubes(2), backend="mumps").solver.condensed, the_team()
    left, X = condensed.response.left, condensed.response.compliance()
    assert not left.flags.owndata
    assert np.shares_memory(condensed.image.factor, left)
    expected, held = left.copy(), weakref.ref(team.held[max(team.held)])
    del condensed
    gc.collect()
    team.everywhere(nothing)
    assert held() is None
    np.testing.assert_array_equal(left, expected)
    np.testing.assert_array_equal(X, X.T)


@with_petsc
def test_well_posedness_and_derivatives_choose_factors():
    """With the words, the proof and the sensitivities of one process."""
    model = MODELS["the paper's cylinder"]()
    one, two = (sg.solve(model, wellposed=True, tape=True, backend=backend) for backend in ("auto", "petsc"))
    assert two.backend == "mumps"
    assert two.wellposedness.words == one.wellposedness.words
    np.testing.assert_allclose(two.sensitivities().per_cent, one.sensitivities().per_cent, rtol=1e-9, atol=1e-11)
    changes = [found.derivative(sg.displacement(60, along=(0, 1))) for found in (one, two)]
    for by in ("value", "friction", "E", "load", "gap"):
        here, there = (getattr(change, by) for change in changes)
        here, there = (
            np.concatenate([*map(np.ravel, part.values())]) if by != "value" else part for part in (here, there)
        )
        np.testing.assert_allclose(there, here, rtol=1e-8, atol=1e-10 * np.abs(here).max())
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
