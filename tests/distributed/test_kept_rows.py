"""Arrays of a history that ranks keep by rows: to whoever asks they are what they were, and so is the archive."""

import copy
import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.arrays import stored
from signorini.distributed import kept_rows
from signorini.distributed.kept_rows import RowsKept, put_away
from signorini.engine.step_parts import kept_by_ranks
from signorini.gallery.cubes import cubes
from signorini.output.archive import read_archive, write_archive
from signorini.output.checkpoint import read_checkpoint, write_checkpoint
from signorini.output.dataclasses_json import digest
from tests.distributed.test_on_ranks import on_ranks, with_ranks
from tests.helpers.fake_ranks import RanksInTurn


@pytest.mark.parametrize("rows", [0, 1, 2, 7])
def test_every_rank_has_a_share_and_all_together_the_array(rows):
    team, array = RanksInTurn(3), np.arange(3.0 * rows).reshape(rows, 3)
    kept = RowsKept.of(team, array)
    sizes = [len(own[kept._number]) for own in team.kept_by_rank]
    assert sum(sizes) == rows
    assert max(sizes) - min(sizes) <= 1
    assert digest(kept) == digest(array)
    found = kept.whole()
    assert not found.flags.writeable
    np.testing.assert_array_equal(found, array)
    for sent in (pickle.loads(pickle.dumps(kept)), copy.deepcopy(kept)):
        np.testing.assert_array_equal(sent, array)
    assert list(team.away) == [kept]
    kept.come_home()
    team.kept_by_rank.clear()
    np.testing.assert_array_equal(kept.whole(), array)


def several():
    """Increments whose displacements are kept, and a second step."""
    steps = [sg.Step(increments=3, at="events"), sg.Step(increments=1, scale={"upper.top": 0.5})]
    return replace(cubes(2), steps=steps)


@pytest.mark.parametrize("compress", [False, True])
def test_an_archive_is_the_same_byte_by_byte_wherever_arrays_are(compress, monkeypatch, tmp_path):
    monkeypatch.setattr(kept_rows, "_WORTH", 256)
    history = sg.solve(several())
    team = RanksInTurn(3)
    monkeypatch.setattr(kept_rows, "several_ranks", lambda: team)
    (step, *others), (shot, *rest) = history.steps, history.steps[0].instants
    away = replace(shot, displacement=put_away(shot.displacement))
    names = ("displacement", "external")
    away = replace(step, instants=(away, *rest), **{name: put_away(getattr(step, name)) for name in names})
    assert isinstance(stored(away, "external"), RowsKept)
    assert "external=array(" in repr(away)
    for name, steps in (("one", history.steps), ("two", (away, *others))):
        write_archive(replace(history, steps=steps), tmp_path / name, compress=compress)
    one, two = (read_archive(tmp_path / name) for name in ("one", "two"))
    for a, b in zip(one.steps, two.steps, strict=True):
        for name in names:
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    write_checkpoint(replace(history.end, state=kept_by_ranks(history.end.state)), tmp_path / "state.npz")
    np.testing.assert_array_equal(read_checkpoint(tmp_path / "state.npz").state.external, history.end.state.external)
    np.testing.assert_array_equal(one.steps[0].instants[0].displacement, two.steps[0].instants[0].displacement)
    if not compress:
        assert len((tmp_path / "one").read_bytes()) == len((tmp_path / "two").read_bytes())


KEEPING = """
import json
from dataclasses import replace
from pathlib import Path
import numpy as np
import signorini as sg
from signorini.arrays import stored
from signorini.distributed import kept_rows
from signorini.distributed.kept_rows import RowsKept
from signorini.distributed.ranks import the_team
from signorini.output.archive import read_archive
from tests.distributed.test_kept_rows import several

def kept(team):
    return sum(own.nbytes for own in team.held.values() if isinstance(own, np.ndarray))

kept_rows._WORTH = 256
with sg.ranks() as first:
    if first:
        team, one = the_team(), sg.solve(several())
        two = sg.solve(several(), backend={backend!r})
        sizes = team.everywhere(kept)
        two.write({out!r})
        read = read_archive(Path({out!r}))
        names = "displacement", "external"
        away = all(isinstance(stored(of, name), RowsKept) for of in (*two.steps, two.end.state) for name in names)
        step = sg.Step(increments=1, scale={{"upper.top": 0.7}})
        ends = [sg.solve(replace(several(), steps=[step]), start=found.end) for found in (one, two)]
        deformed = [shot.deformed for step in two.steps for shot in step.instants]
if first:
    apart, same = 0.0, True
    for a, b, c in zip(one.steps, two.steps, read.steps, strict=True):
        apart = max(apart, float(np.abs(a.displacement - b.displacement).max()))
        same = same and np.array_equal(b.displacement, c.displacement) and np.array_equal(b.external, c.external)
        for s, t in zip(b.instants, c.instants, strict=True):
            same = same and (not s.deformed or np.array_equal(s.displacement, t.displacement))
    apart = max(apart, float(np.abs(ends[0].last.displacement - ends[1].last.displacement).max()))
    print(json.dumps([away, sizes, sum(deformed), apart, same]))
"""


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("backend", ["petsc", "mumps"])
def test_ranks_keep_what_a_history_has_gone_through(backend, tmp_path):
    """Half of it each on two; archives have all of it, and so has who asks when they have been let go."""
    script = tmp_path / "script.py"
    script.write_text(KEEPING.format(out=str(tmp_path / "out.h5"), backend=backend))
    done = on_ranks(2, str(script))
    assert done.returncode == 0, done.stderr
    away, sizes, deformed, apart, same = json.loads(done.stdout)
    assert away
    assert deformed >= 3
    assert sizes[0] > 0
    assert abs(sizes[0] - sizes[1]) <= 0.1 * sizes[0]
    assert apart < 1e-8
    assert same
