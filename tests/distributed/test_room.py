# SPDX-License-Identifier: BSD-3-Clause
"""Memory on ranks is asked for before it is taken: too little is refused by name, in one message of all of them."""

import pytest

import signorini as sg
from signorini.gallery.cubes import cubes
from tests.distributed.test_on_ranks import HOUSE, on_ranks, with_petsc, with_ranks

PLENTY, LITTLE = 1e15, 1e3


@with_petsc
@pytest.mark.parametrize("backend", ["petsc", "mumps"])
def test_a_model_that_does_not_fit_is_refused_before_it_is_cut(backend, monkeypatch):
    from signorini.distributed import room, stiffness

    monkeypatch.setattr(room, "available_memory", lambda: LITTLE)
    monkeypatch.setattr(stiffness, "owners", lambda *_: pytest.fail("a mesh was cut"))
    words = f"^back end '{backend}', for 162 unknowns, takes about .* GB on a machine with 1 rank, and 1e-06 GB"
    with pytest.raises(sg.InputError, match=words):
        sg.solve(cubes(2), backend=backend)


@with_petsc
def test_factors_that_do_not_fit_are_analysed_but_not_made(monkeypatch):
    """MUMPS says what it will take; dense matrices of the pairs count too."""
    from signorini.distributed import factors, room

    called, petsc = [], factors._petsc
    monkeypatch.setattr(factors, "_petsc", lambda name, *given: (called.append(name), petsc(name, *given)))
    sg.solve(cubes(2), backend="mumps")
    assert called.index("MatCholeskyFactorSymbolic") < called.index("MatCholeskyFactorNumeric")
    called.clear()
    answers = iter([PLENTY])
    monkeypatch.setattr(room, "available_memory", lambda: next(answers, LITTLE))
    words = "^back end 'mumps', for the factor of .* unknowns and dense matrices of 27 of the contacts, takes about"
    with pytest.raises(sg.InputError, match=words):
        sg.solve(cubes(2), backend="mumps")
    assert "MatCholeskyFactorSymbolic" in called
    assert "MatCholeskyFactorNumeric" not in called


SHORT = """
from signorini.cli import main
from signorini.distributed import ranks, room

def little():
    return {little} if ranks.the_team().rank == 1 else {plenty}

room.available_memory = little
raise SystemExit(main(["run", {deck!r}, "--backend", {backend!r}, "-o", {out!r}, "--quiet"]))
"""


@with_ranks
@pytest.mark.slow
def test_ranks_of_which_one_is_short_of_memory_end_with_one_message(tmp_path):
    """By wrong input's exit code; what ranks of one machine take is added up."""
    script, deck = tmp_path / "script.py", str(HOUSE / "examples" / "block_drag.toml")
    given = {"deck": deck, "out": str(tmp_path / "out"), "backend": "mumps", "plenty": PLENTY, "little": LITTLE}
    script.write_text(SHORT.format(**given))
    done = on_ranks(2, str(script))
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("on a machine with 2 ranks") == 1
    assert done.stderr.count("signorini:") == 1
