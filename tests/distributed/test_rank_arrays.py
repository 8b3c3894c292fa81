"""Arrays whose entries are on ranks: NumPy's words for them mean what they mean for arrays that are here."""

import copy
import json

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

from signorini.arrays import ArrayElsewhere, elsewhere, operand
from signorini.distributed.columns import ColumnsOnRanks
from signorini.distributed.rank_arrays import Cut, Remembered
from tests.distributed.test_on_ranks import on_ranks, with_ranks
from tests.helpers.fake_ranks import RanksInTurn

SIZE, RANKS = 11, 3


@pytest.fixture
def cut():
    """Entries on three ranks as they come, the middle one of which has none."""
    owner = np.random.default_rng(1).permutation(np.arange(SIZE) % 2) * 2
    return Cut(RanksInTurn(RANKS), SIZE, lambda numbers: owner[numbers], lambda rank: np.flatnonzero(owner == rank))


def two(cut):
    x, y = np.random.default_rng(2).standard_normal((2, SIZE))
    return x, y, cut.of(x), cut.of(y)


def test_arithmetic_is_that_of_arrays(cut):
    x, y, a, b = two(cut)
    chosen = np.arange(SIZE) % 3 == 0
    for here, there in (
        (2.0 * x - y, 2.0 * a - b),
        (x - 3.0, a - 3.0),
        (y - x, y - a),
        (np.abs(x), np.abs(a)),
        (np.where(chosen, x, 0.0), np.where(chosen, a, 0.0)),
        (np.where(x > 0.0, x, y), np.where(a > 0.0, a, b)),
    ):
        assert isinstance(there, ArrayElsewhere)
        np.testing.assert_array_equal(there.whole(), here)
    assert a @ b == pytest.approx(x @ y, rel=1e-14)
    assert y @ a == pytest.approx(x @ y, rel=1e-14)
    assert np.abs(a).sum() == pytest.approx(np.abs(x).sum(), rel=1e-14)


def test_sums_are_the_same_every_time(cut):
    _, _, a, b = two(cut)
    assert {a @ b for _ in range(5)} == {a @ b}


def test_what_is_asked_of_all_entries_is_answered_by_all(cut):
    x, _, a, _ = two(cut)
    assert len(a) == SIZE
    assert a.max() == x.max()
    assert a.max(initial=7.0) == 7.0
    assert np.isfinite(a).all()
    assert a.any()
    assert not (0.0 * a).any()
    torn = x.copy()
    torn[4] = np.nan
    assert not np.isfinite(cut.of(torn)).all()
    assert np.isnan(cut.of(torn).max())


def test_some_entries_are_fetched_and_put_by_their_numbers(cut):
    x, _, a, _ = two(cut)
    table = np.array([[3, 0], [10, 3]])
    np.testing.assert_array_equal(a[table], x[table])
    np.testing.assert_array_equal(a[x > 0.0], x[x > 0.0])
    np.testing.assert_array_equal(a[:5], x[:5])
    assert a[4] == x[4]
    put = cut.spread(np.array([9, 2]), np.array([5.0, -1.0]))
    np.testing.assert_array_equal(np.flatnonzero(put), [2, 9])
    assert put[9] == 5.0
    assert (np.argmax(a), np.argmin(a)) == (x.argmax(), x.argmin())
    assert (np.argmax(put > 0.0), np.argmin(np.isfinite(put))) == (9, 0)  # of equal ones the first


def test_whatever_else_is_asked_is_given_all_of_it(cut):
    x, y, a, b = two(cut)
    matrix = sp.random_array((4, SIZE), density=0.5, rng=np.random.default_rng(0), format="csr")
    np.testing.assert_array_equal(matrix @ a, matrix @ x)
    np.testing.assert_array_equal(np.concatenate([a, b]), np.concatenate([x, y]))
    np.testing.assert_array_equal(np.ones((2, SIZE)) @ a, np.ones((2, SIZE)) @ x)
    np.testing.assert_array_equal(copy.deepcopy(a), x)
    assert not a.whole().flags.writeable


def test_columns_are_a_table(cut):
    """Sums, products and rows of arrays side by side, of none too; and zeros like an array are where it is."""
    x, y, a, b = two(cut)
    weights, rows = np.array([[2.0, 0.0], [-1.0, 3.0]]), np.array([9, 2, 9])
    for here, there in (
        (np.stack([x, y], axis=1), ColumnsOnRanks(cut, [a, b])),
        (np.zeros((SIZE, 0)), ColumnsOnRanks(cut, [])),
    ):
        w = weights[: here.shape[1], : here.shape[1]]
        assert there.shape == here.shape
        np.testing.assert_array_equal(there, here)
        np.testing.assert_array_equal(there[rows], here[rows])
        np.testing.assert_allclose(there @ w, here @ w, rtol=0, atol=1e-15)
        np.testing.assert_allclose(there @ w.sum(axis=1), here @ w.sum(axis=1), rtol=0, atol=1e-15)
        assert isinstance(there @ w.sum(axis=1), ArrayElsewhere)
        for values in (x, a):
            np.testing.assert_allclose(there.T @ values, here.T @ x, rtol=1e-13)
        np.testing.assert_allclose(there.T @ (there @ w), here.T @ (here @ w), rtol=1e-13, atol=1e-14)
        np.testing.assert_array_equal(2.0 * there - there, here)
        np.testing.assert_array_equal(there[:, 1:], here[:, 1:])
    table, kept = ColumnsOnRanks(cut, [a, b]), ColumnsOnRanks(cut, [a, b])
    table[:, 1:] += kept[:, :1]
    np.testing.assert_array_equal(table, np.stack([x, y + x], axis=1))
    np.testing.assert_array_equal(kept, np.stack([x, y], axis=1))
    assert isinstance(np.zeros_like(a), ArrayElsewhere)
    assert not np.zeros_like(a).any()


def test_rows_that_tell_columns_apart_are_far_apart(cut):
    """Of a shift and a turn, by pivots of an orthonormal basis: both ends, where the turn moves most."""
    turn = np.linspace(-1.0, 2.0, SIZE)
    found = ColumnsOnRanks(cut, [cut.of(np.ones(SIZE)), cut.of(turn)]).far_apart()
    basis = scipy.linalg.qr(np.stack([np.ones(SIZE), turn], axis=1), mode="economic")[0]
    assert set(found) == {0, SIZE - 1} == set(scipy.linalg.qr(basis.T, pivoting=True)[2][:2])


def test_at_home_it_is_an_array(cut):
    x, y, a, b = two(cut)
    for one in (a, b):
        one.come_home()
    cut.team.kept_by_rank.clear()
    np.testing.assert_array_equal(a - 2.0 * b, x - 2.0 * y)
    assert a @ b == pytest.approx(x @ y, rel=1e-14)
    assert a.max() == x.max()
    np.testing.assert_array_equal(a[[1, 2]], x[[1, 2]])


def test_what_is_remembered_is_sent_once_and_no_longer_than_it_is_there(cut):
    remembered, x = Remembered(), np.arange(float(SIZE))
    assert remembered.of(cut, x) is remembered.of(cut, x)
    before = remembered.of(cut, x)
    del x
    assert remembered.of(cut, np.ones(SIZE)) is not before
    assert len(remembered._known) == 1


def test_a_field_on_ranks_is_computed_with_there(cut):
    @elsewhere("u")
    class Data:
        def __init__(self, u):
            self.u = u

    x, _, a, _ = two(cut)
    assert operand(Data(a), "u") is a
    np.testing.assert_array_equal(Data(a).u, x)


BALANCE = """
import json
import numpy as np
import signorini as sg
from signorini.distributed.rank_arrays import ArrayOnRanks
from signorini.engine.energy import stored_energy
from signorini.engine.increments import applied, measured
from signorini.engine.prepare import prepare
from signorini.engine.reactions import reactions
from signorini.solution.state import initial_state, next_state
from tests.helpers.on_ranks import MODELS, in_increments

NAMES = "equilibrium", "rounding", "penetration", "tension", "cone", "complementarity"

def sums(prepared):
    '''What is summed of a state that nobody has solved for.'''
    random, interface, constraints = np.random.default_rng(4), prepared.interface, prepared.constraints
    factors = dict.fromkeys(prepared.model.scaled_names, 1.0)
    before = initial_state(factors, constraints.zeros, interface)
    z = random.standard_normal(constraints.transform.shape[1]) * prepared.scale.length
    u = constraints.placed(constraints.transform @ z)
    forces, moved = (random.standard_normal((interface.directions, len(interface))) for _ in range(2))
    loads = applied(prepared, before.point)[0]
    status = np.full(len(interface), 2)
    given = dict(displacement=u, forces=forces, moved=moved, status=status, point=before.point, loads=loads)
    state = next_state(prepared, before, **given)
    certificate = measured(prepared, state)
    held = constraints.support_forces(state.nodal[1] - loads)
    borne = reactions(prepared.model, prepared.space, constraints, u, held)
    balance = constraints.resultants(prepared.rigid, state.nodal[1] + constraints.foundation_forces(u))
    there = {isinstance(each, ArrayOnRanks) for each in (u, held, *state.nodal, constraints.on_free(held))}
    assert there == {prepared.backend == "petsc"} or len(constraints.dependent)
    return {
        "work": [state.work],
        "energy": [stored_energy(prepared, state)],
        "balance": balance.tolist(),
        "free": [np.abs(constraints.on_free(prepared.K @ u)).max(), np.abs(constraints.free_of(u)).sum()],
        "reactions": np.concatenate(list(borne.values())).tolist(),
        **{name: [getattr(certificate, name)] for name in NAMES},
    }

with sg.ranks() as first:
    if first:
        found = {}
        for name in ("cubes", "several steps", "coupled unknowns", "held by contact alone", "twist"):
            model = in_increments(MODELS[name]())
            alone, there = (prepare(model, backend=way) for way in ("iterative", "petsc"))
            found[name] = sums(alone), [sums(there) for _ in range(5)]
        print(json.dumps(found))
"""


@with_ranks
@pytest.mark.slow
def test_sums_are_those_of_one_process_and_have_the_same_bits_every_time(tmp_path):
    """Balance, energies, reactions and the certificate of any state, summed where its displacements are."""
    script = tmp_path / "script.py"
    script.write_text(BALANCE)
    done = on_ranks(3, str(script))
    assert done.returncode == 0, done.stderr
    for name, (alone, there) in json.loads(done.stdout).items():
        assert all(each == there[0] for each in there), name
        for what, numbers in alone.items():
            close = 1e-10 * np.abs(numbers).max(initial=0.0)
            np.testing.assert_allclose(there[0][what], numbers, rtol=0.0, atol=close, err_msg=f"{name}: {what}")
