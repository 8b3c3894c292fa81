"""Bodies on the ranks of MPI have the answers of bodies that are factorised; where PETSc is not installed, why not."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import signorini as sg
from signorini.cli import main
from signorini.distributed import ranks
from signorini.gallery.cubes import cubes
from signorini.gallery.sliding import dragged_cylinder
from tests.helpers.on_ranks import MODELS, WAYS
from tests.helpers.rank_files import assert_whole, sources

HOUSE = Path(__file__).parents[2]
missing = [name for name in ("petsc4py", "mpi4py") if importlib.util.find_spec(name) is None]
with_petsc = pytest.mark.skipif(bool(missing), reason=f"not installed: {', '.join(missing)}")
with_ranks = pytest.mark.skipif(
    bool(missing) or shutil.which("mpiexec") is None, reason=f"not installed: {', '.join(missing) or 'mpiexec'}"
)
LIMIT = 1800  # seconds that a run of several ranks may take


def on_ranks(number, *arguments):
    """What a Python of several ranks leaves behind; OpenMPI asks whether root and few cores are meant."""
    allowed = {f"OMPI_{name}": "1" for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM")}
    few = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    paths = {"PYTHONPATH": os.pathsep.join([str(HOUSE / "src"), str(HOUSE)])}
    return subprocess.run(
        ["mpiexec", "-n", str(number), sys.executable, *arguments],
        capture_output=True,
        text=True,
        timeout=LIMIT,
        env=os.environ | allowed | few | paths,
        cwd=HOUSE,
        check=False,
    )


def hold(found, backend="petsc"):
    assert found["back ends"] == ["multifrontal", backend]
    assert found["passed"]
    assert found["states"] == 0
    assert max(found["pressure"], found["traction"], found["displacement"]) <= 1e-8


@with_petsc
@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_same_answers_on_one_rank(name):
    from tests.helpers.on_ranks import compared

    hold(compared(name))


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("number", [2, 3, 4])
def test_same_answers_on_several(number):
    """All models in one run, which starts its ranks once."""
    done = on_ranks(number, "-m", "tests.helpers.on_ranks")
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    assert answers.keys() == MODELS.keys()
    for found in answers.values():
        hold(found)


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("cut", WAYS)
def test_answers_do_not_depend_on_where_nodes_and_pairs_are(cut):
    """Three ranks: cuts that METIS would not make, and pairs that are not shared evenly."""
    names = ["cubes", "mortar", "several steps", "held by contact alone"]
    done = on_ranks(3, "-m", "tests.helpers.on_ranks", *names, "--cut", cut)
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    assert list(answers) == names
    for found in answers.values():
        hold(found)


@with_ranks
@pytest.mark.slow
def test_the_command_line_writes_the_same_results(tmp_path, capsys):
    """From a deck, by two ranks, fields by both of them; and of a wrong deck one message and exit code 2 of all."""
    deck = HOUSE / "examples" / "zhu_cylinder_frictionless.toml"
    done = on_ranks(2, "-m", "signorini", "run", str(deck), "--backend", "petsc", "-o", str(tmp_path / "ranks"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("back end petsc") == 1
    assert main(["run", str(deck), "-o", str(tmp_path / "one"), "--quiet"]) == 0
    assert main(["diff", str(tmp_path / "one"), str(tmp_path / "ranks"), "--tolerance", "1e-8"]) == 0
    index, whole = tmp_path / "ranks" / "solution.pvtu", tmp_path / "one" / "solution.vtu"
    assert len(sources(index)) == 2
    assert_whole(index, whole, 1e-7)
    capsys.readouterr()
    (tmp_path / "wrong.toml").write_text(deck.read_text().replace("friction = 0.0", "friction = -1.0"))
    for words, said in (
        (["run", str(tmp_path / "wrong.toml"), "--backend", "petsc"], "friction"),
        (["run", str(deck), "--backend", "petsc", "--colour"], "--colour"),
    ):
        done = on_ranks(2, "-m", "signorini", *words)
        assert done.returncode == 2
        assert done.stderr.count(said) == 1


@with_ranks
@pytest.mark.slow
def test_the_command_line_judges_fatigue_on_ranks(tmp_path, capsys):
    """On a path from event to event, whose stresses ranks see on the way: the same worst places, files, and rows.

    Planes are found to 1e-6 radians, at which parameters are flat, and their terms are not.
    """
    deck, one = HOUSE / "examples" / "fretting_fatigue.toml", tmp_path / "one"
    assert main(["run", str(deck), "-o", str(one), "--quiet"]) == 0
    worst = told_of_fatigue(one)
    for number in (2, 3):
        folder = tmp_path / f"{number} ranks"
        done = on_ranks(number, "-m", "signorini", "run", str(deck), "--backend", "mumps", "-o", str(folder))
        assert done.returncode == 0, done.stderr
        assert main(["diff", str(one), str(folder), "--tolerance", "1e-6"]) == 0
        assert len(sources(folder / "solution.pvtu")) == number
        assert_whole(folder / "solution.pvtu", one / "solution.vtu", 1e-7)
        assert told_of_fatigue(folder) == worst
    capsys.readouterr()


def told_of_fatigue(folder):
    """What a summary says of fatigue: how much was looked at, where it is worst, and parameters in seven digits."""
    told = json.loads((folder / "summary.json").read_text())["fatigue"]
    worst = [[entry["worst"][key] for key in ("body", "node", "at")] for entry in told]
    sizes = [[entry["places"], entry["moments"], f"{entry['worst']['parameter']:.6e}"] for entry in told]
    return worst, sizes


@with_ranks
@pytest.mark.slow
def test_messages_of_an_iteration_are_counted():
    """On two ranks each has one beside it; what the pairs ask of a sum, conjugate gradients take three."""
    done = on_ranks(2, "-m", "benchmarks.ranks_on_paper", "--one", "4", "3")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    exchanges = found["halo"]  # on two levels: product, smoothing before and after, residual, down and up
    assert len(found["levels"]) == 2
    assert 5 <= exchanges <= 8
    assert found["messages"] >= exchanges
    assert 3 <= found["sums"] <= 4.5
    assert found["bytes"] >= exchanges * 8 * 3  # a node at least
    assert found["held"] > 12 * 27 * found["unknowns"] / 2


DYING = """
import signorini as sg
from signorini.cli import main
from signorini.distributed import parts, ranks
from signorini.iterative import solve

answered = 0

def dies(*asked):
    global answered
    answered += 1
    if ranks.the_team().rank == 1 and answered == 6:
        raise RuntimeError("the room is dark")
    return solve.solve_iteratively(*asked)

parts.solve_iteratively = dies
raise SystemExit(main(["run", {deck!r}, "--backend", "petsc", "-o", {out!r}, "--quiet"]))
"""


@with_ranks
@pytest.mark.slow
def test_a_rank_that_fails_ends_all_and_leaves_finished_steps(tmp_path):
    from signorini.output.folder import read_results

    script = tmp_path / "script.py"
    script.write_text(DYING.format(deck=str(HOUSE / "examples" / "block_drag.toml"), out=str(tmp_path / "out")))
    done = on_ranks(2, str(script))
    assert done.returncode != 0
    assert "signorini: rank 1 failed: RuntimeError: the room is dark" in done.stderr
    history = read_results(tmp_path / "out")
    assert len(history.steps) >= 1
    assert history.steps[0].certificate.passed


ASKING = """
import signorini as sg
from signorini.distributed.ranks import the_team

def nothing(team, *piece):
    pass

def asked():
    team = the_team()
    for rank in range(team.size):
        team.everywhere(nothing)
        yield rank

with sg.ranks() as first:
    if first:
        the_team().everywhere(nothing, pieces=asked())
"""


@with_ranks
@pytest.mark.slow
def test_pieces_that_ask_ranks_end_all(tmp_path):
    """Others wait for their piece: they neither take the question for it nor wait for ever."""
    script = tmp_path / "script.py"
    script.write_text(ASKING)
    done = on_ranks(2, str(script))
    assert done.returncode != 0
    said = "RuntimeError: internal error: ranks are asked for 'nothing' while they are asked something else; expected "
    assert f"signorini: rank 0 failed: {said}" in done.stderr


def _nothing(team, *given):
    del team, given


def _asking(team):
    team.everywhere(_nothing)


@with_petsc
def test_ranks_that_are_asked_something_are_asked_nothing_else():
    """By pieces and by what they do, on one rank too; and they may be asked again afterwards."""
    team = ranks.Team(ranks.the_team().comm)
    words = r"^internal error: ranks are asked for '_nothing' while they are asked something else; expected pieces that"
    with pytest.raises(RuntimeError, match=words):
        team.everywhere(_nothing, pieces=(team.everywhere(_nothing) for _ in range(1)))
    with pytest.raises(RuntimeError, match=words):
        team.everywhere(_asking)
    assert team.everywhere(_nothing, pieces=[3]) == [None]


def yielding():
    model = cubes(2)
    soft = [replace(body, material=replace(body.material, plastic=sg.Plastic(1.0))) for body in model.bodies]
    return replace(model, bodies=[replace(body, formulation="mean dilatation") for body in soft])


def worn():
    model = cubes(2)
    return replace(model, contacts=[replace(model.contacts[0], wear=sg.Wear(1e-6))])


REFUSED = {
    r"body\[0\]\.material: back end 'petsc' does not know bodies that yield \('lower'\); expected elastic": yielding,
    r"contact\[0\]\.wear: back end 'petsc' does not know sides that wear": worn,
    r"contact\[0\]\.sliding: back end 'petsc' does not know contacts that slide far": lambda: dragged_cylinder(
        stroke=0.4, spacing=0.4
    ),
}


@with_petsc
@pytest.mark.parametrize("words", REFUSED)
def test_what_ranks_do_not_know_is_refused_by_name(words, monkeypatch):
    """Before anything is cut."""
    from signorini.distributed import stiffness

    monkeypatch.setattr(stiffness, "owners", lambda *_: pytest.fail("a mesh was cut"))
    with pytest.raises(sg.InputError, match=words):
        sg.solve(REFUSED[words](), backend="petsc")


def test_a_back_end_that_there_is_not_is_told_beside_those_of_ranks():
    with pytest.raises(
        sg.InputError, match=r"^unknown back end 'petcs'; did you mean 'petsc'\? Known: .*mumps, .*petsc"
    ):
        sg.solve(cubes(1), backend="petcs")


def test_a_machine_without_petsc_is_told(monkeypatch, capsys):
    """In one line, before a model is looked at, and with the page that says how to install it."""
    monkeypatch.setitem(sys.modules, "petsc4py", None)
    monkeypatch.setattr(ranks, "the_team", ranks.the_team.__wrapped__)
    words = r"^back ends 'petsc' and 'mumps' need petsc4py and mpi4py \(.*petsc4py.*\); docs/distributed\.md says"
    with pytest.raises(sg.InputError, match=words), sg.ranks():
        pytest.fail("there are no ranks")
    for backend in ranks.ON_RANKS:
        assert main(["run", "nowhere.toml", "--backend", backend]) == 2
        said = capsys.readouterr().err
        assert said.startswith("signorini: back ends 'petsc' and 'mumps' need petsc4py and mpi4py")
        assert said.count("\n") == 1
