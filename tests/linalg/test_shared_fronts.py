# SPDX-License-Identifier: BSD-3-Clause
"""What threads share of a factorisation: the same to the last bit for any number of them, and right."""

import threading
import time
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from signorini import blas_threads, cores
from signorini.cli import main
from signorini.crew import Crew, Job, shared
from signorini.errors import InputError
from signorini.linalg import NotPositiveDefinite, factorise, multifrontal, plan, schedule
from tests.helpers.lattices import dense_schur, lattice, together


def _beside(problem, *others):
    """A problem with whole bodies beside it that the interface does not touch."""
    both = together(problem, *others)
    own = range(len(problem.interface))
    return replace(both, interface=both.interface[own])


PROBLEMS = {
    "plane": lattice((31, 24)),
    "space": lattice((9, 8, 10)),
    "bodies": together(
        lattice((19, 17)), lattice((8, 9), held="none"), lattice((7, 6, 8)), lattice((6, 6), held="roller")
    ),
    "bodies without an interface": _beside(lattice((31, 24)), lattice((5, 4)), lattice((4, 3, 4))),
    "no interface": _beside(replace(lattice((31, 24)), interface=np.empty(0, dtype=np.int64)), lattice((5, 4))),
}


@pytest.fixture
def as_large(monkeypatch):
    """Small models are shared as large ones are, in tiles as small as they are."""
    monkeypatch.setattr(plan, "SHARED_WORK", 3e3)
    monkeypatch.setattr(schedule, "TILE", 7)


@pytest.mark.usefixtures("as_large")
@pytest.mark.parametrize("name", PROBLEMS)
def test_every_number_of_threads_gives_the_same_bits(name):
    p = PROBLEMS[name]
    load = np.random.default_rng(1).standard_normal(p.K.shape[0])
    found = []
    for number in (1, 2, 3, 5, 16):
        with cores.threads(number):
            factor = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal")
        found.append((factor.factor, factor.schur(), factor.reduce(load).load))
    parts = factor.plan.parts
    assert sum(part.branch for part in parts) > 4
    assert sum(not part.branch for part in parts) > 2
    for other in found[1:]:
        assert all(np.array_equal(one, two) for one, two in zip(found[0], other, strict=True))
    S = dense_schur(p.K, p.interface)
    assert np.abs(found[0][1] - S).max(initial=0.0) <= 1e-12 * np.abs(S).max(initial=0.0)
    moved = factor.reduce(load).expand(np.zeros(len(p.interface)))
    inside = np.setdiff1d(np.arange(len(load)), p.interface)
    assert np.abs((p.K @ moved - load)[inside]).max() <= 1e-9 * np.abs(load).max()


@pytest.mark.usefixtures("as_large")
@pytest.mark.parametrize("name", ["plane", "no interface"])
@pytest.mark.parametrize("several", [50, 1])
def test_threads_share_solves_with_the_same_bits(name, several, monkeypatch):
    """Many loads by 16, and of every load the way back by branches of the tree, once the fronts above them are done."""
    monkeypatch.setattr(multifrontal, "SHARED_SOLVE", 0.0)
    p, rng = PROBLEMS[name], np.random.default_rng(2)
    factor = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal")
    loads, edge = rng.standard_normal((p.K.shape[0], several)), rng.standard_normal((len(p.interface), several))
    found, workers = [], set()
    run = multifrontal.Crew.finish

    def finish(crew, jobs):
        workers.add((crew.threads, len(jobs)))
        run(crew, jobs)

    monkeypatch.setattr(multifrontal.Crew, "finish", finish)
    for number in (1, 2, 3):
        with cores.threads(number):
            reduced = factor.reduce(loads)
            found.append((reduced.load, reduced.expand(edge)))
    times, branches = -(-several // 16), sum(part.branch for part in factor.plan.parts)
    assert branches > 4
    there, back = times, times * (1 + branches)
    assert workers == {
        (1, there),
        (1, back),
        (2, back),
        (3, back),
        (2 if times > 1 else 1, there),
        (3 if times > 1 else 1, there),
    }
    for other in found[1:]:
        assert all(np.array_equal(one, two) for one, two in zip(found[0], other, strict=True))
    for column in {0, several // 3, several - 1}:
        alone = factor.reduce(loads[:, column]).expand(edge[:, column])
        assert np.abs(found[0][1][:, column] - alone).max() <= 1e-12 * np.abs(alone).max()


@pytest.mark.usefixtures("as_large")
def test_parts_hold_every_front_once():
    p = PROBLEMS["space"]
    parts = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal").plan.parts
    ends = [part.begin for part in parts[1:]] + [parts[-1].end]
    assert [part.end for part in parts] == ends
    assert parts[0].begin == 0
    assert all(part.end - part.begin == 1 for part in parts if not part.branch)


@pytest.mark.usefixtures("as_large")
@pytest.mark.parametrize("number", [1, 3])
@pytest.mark.parametrize("place", [0.02, 0.6, 0.98])
def test_an_indefinite_matrix_names_the_same_unknown(number, place):
    p = PROBLEMS["space"]
    inside = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal").plan.order[: -len(p.interface)]
    K = p.K.copy().tolil()
    wrong = inside[int(place * len(inside))]
    K[wrong, wrong] = -1.0
    with cores.threads(number), pytest.raises(NotPositiveDefinite) as error:
        factorise(K.tocsr(), p.interface, nodes=p.nodes, backend="multifrontal")
    assert error.value.dof == wrong
    assert threading.active_count() == 1


@pytest.mark.parametrize("number", [1, 2, 5])
def test_jobs_wait_for_what_they_need_and_the_first_failure_counts(number):
    """Of jobs that fail the first one is told, whichever thread comes to it first; what needs it is not begun."""
    slow, done = threading.Event(), []

    def fail(name: str) -> None:
        raise ValueError(name)

    jobs = [
        Job(lambda: slow.wait(0.05)),
        Job(lambda: fail("second"), needs=(0,)),
        Job(lambda: fail("third")),
        Job(lambda: done.append("behind"), needs=(1,)),
    ]
    with Crew(number) as crew, pytest.raises(ValueError, match="second"):
        crew.finish(jobs)
    assert not done
    with Crew(number) as crew:
        crew.finish([Job(partial(done.append, i), needs=(i - 1,) if i else ()) for i in range(20)])
    assert done == list(range(20))


@pytest.mark.parametrize("number", [1, 2, 3])
def test_what_is_shared_inside_goes_to_the_same_threads(number):
    """Never do more work than were asked for, BLAS's included, and inside the same number is asked for."""
    working, most, lock = 0, 0, threading.Lock()

    def work(value: int) -> tuple[int, int, bool]:
        nonlocal working, most
        with lock:
            working += 1
            most = max(most, working)
        time.sleep(0.002)
        with lock:
            working -= 1
        return value, cores.number_of_threads(), number == 1 or {get() for _, get in blas_threads._found} <= {1}

    def inside(value: int) -> list[tuple[int, int, bool]]:
        return shared([partial(work, 10 * value + i) for i in range(7)], worth=True)

    with cores.threads(number):
        found = shared([partial(inside, value) for value in range(5)], worth=True)
    assert found == [[(10 * value + i, number, True) for i in range(7)] for value in range(5)]
    assert most == number
    assert threading.active_count() == 1


@pytest.mark.usefixtures("as_large")
@pytest.mark.parametrize("name", PROBLEMS)
def test_tasks_hold_all_the_work_and_need_earlier_ones(name):
    p = PROBLEMS[name]
    made = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal").plan
    found = schedule.tasks(made)
    assert all(needed < number for number, task in enumerate(found) for needed in task.needs)
    assert sum(task.work for task in found) == pytest.approx(made.flops, rel=1e-12)


@pytest.mark.parametrize("number", [0, -1, 1.5, True, "2"])
def test_wrong_numbers_of_threads_are_named(number):
    with pytest.raises(InputError, match="expected a whole number, at least 1"), cores.threads(number):
        pass


@pytest.mark.parametrize(
    ("said", "number"), [("3", 3), ("3,2", 3), (" 4 ", 4), ("many", None), ("0", None), ("", None)]
)
def test_the_environment_says_how_many(said, number, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", said)
    assert cores.number_of_threads() == (number or cores.physical_cores())


@pytest.mark.parametrize(("given", "code"), [("2", 0), ("0", 2)])
def test_the_command_line_takes_a_number(given, code, tmp_path, capsys):
    asked = ["run", "examples/block_drag.toml", "-o", str(tmp_path / "out"), "--quiet", "--threads", given]
    assert main(asked) == code
    assert ("threads = 0; expected a whole number, at least 1" in capsys.readouterr().err) == (code == 2)
