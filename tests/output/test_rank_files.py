"""Files of bodies that ranks write are together what one process writes, whatever the cut."""

import errno
from dataclasses import replace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.distributed import ranks as all_ranks
from signorini.distributed.partition import owners
from signorini.engine.examine import examine
from signorini.gallery.sectors import SECTORS, ring_on_pads
from signorini.output import by_rows
from signorini.output import rank_files as module
from signorini.output.dat import write_dat
from signorini.output.fields import Fields
from signorini.output.folder import write_folder
from signorini.output.frd import write_frd
from signorini.output.rank_files import FieldsOnRanks, fields_on_ranks
from signorini.output.series import write_state
from tests.fem.test_cyclic import fan
from tests.helpers.fake_ranks import RanksInTurn
from tests.helpers.on_ranks import MODELS as ON_RANKS
from tests.helpers.on_ranks import in_increments
from tests.helpers.rank_files import all_prints, assert_whole, differing, sources

RANKS = 3


def solved(name, team, monkeypatch, model=None):
    """A history whose mesh is cut among ranks, as if they had solved it."""
    model = in_increments(MODELS[name]() if model is None else model)
    examined = examine(model)
    monkeypatch.setattr(all_ranks, "several_ranks", lambda: team)
    history = replace(sg.solve(model, backend="multifrontal"), backend="petsc")
    team.owners[history.model.mesh] = owners(examined.space, examined.interface.B, team.size)
    return history


def sector_with_axis():
    """A sixth of a disk, whose tip is a node of both sides."""
    return sg.Model(
        fan(1),
        bodies=[sg.Body("disc", sg.Elastic(E=200.0, nu=0.3, density=2.0))],
        supports=[sg.Support("rim", u=(0.0, 0.0))],
        loads=[sg.Load("disc", centrifugal=0.5)],
        cyclic_symmetries=[sg.CyclicSymmetry("start", "end", sectors=SECTORS)],
        steps=[sg.Step(increments=1)],
    )


MODELS = ON_RANKS | {"a sector on a pad": lambda: ring_on_pads(whole=False), "a sector with its axis": sector_with_axis}
WRITTEN = [
    *("held by contact alone", "mortar", "several steps", "coupled unknowns", "twist"),
    *("a sector", "a sector on a pad", "a sector with its axis"),
]


@pytest.mark.parametrize("name", WRITTEN)
def test_files_of_ranks_are_together_the_file_of_one_process(name, tmp_path, monkeypatch):
    """Points and cells with all their arrays: averages at nodes take in the cells of other ranks."""
    team = RanksInTurn(RANKS)
    history = solved(name, team, monkeypatch)
    history.write(tmp_path / "whole.vtu")
    ranks = fields_on_ranks(history)
    names = write_state(Fields(history.model), history.last, tmp_path, "parts", ranks=ranks)
    assert names[-1] == "parts.pvtu"
    files = sources(tmp_path / "parts.pvtu")
    assert len(files) >= 2
    assert files == [tmp_path / file for file in names[:-1]]
    assert_whole(tmp_path / "parts.pvtu", tmp_path / "whole.vtu")


@pytest.mark.parametrize("name", WRITTEN)
def test_files_of_text_are_those_of_one_process_row_by_row(name, tmp_path, monkeypatch):
    """However many rows are asked for at a time; the first process recovers nothing of all nodes."""
    history = solved(name, RanksInTurn(RANKS), monkeypatch)
    prints, fields, ranks = (
        all_prints(history.model, len(history.steps)),
        Fields(history.model),
        fields_on_ranks(history),
    )
    folders = [tmp_path / way for way in ("whole", "rows", "ranks")]
    for folder, rows, of in zip(folders, (1 << 16, 7, 7), (fields, fields, ranks), strict=True):
        folder.mkdir()
        monkeypatch.setattr(by_rows, "_AT_ONCE", rows)
        write_frd(history, of, folder / "x.frd")
        write_dat(history, of, prints, folder / "x.dat")
    for file in ("x.frd", "x.dat"):
        whole, rows, of_ranks = (folder / file for folder in folders)
        assert whole.read_bytes() == rows.read_bytes()
        assert not differing(whole, of_ranks)


def test_paraview_reads_the_index(tmp_path, monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    history = solved("held by contact alone", RanksInTurn(RANKS), monkeypatch)
    history.write(tmp_path / "whole.vtu")
    whole = pyvista.read(tmp_path / "whole.vtu")
    write_state(Fields(history.model), history.last, tmp_path, "parts", ranks=fields_on_ranks(history))
    read = pyvista.read(tmp_path / "parts.pvtu")
    assert read.n_cells == whole.n_cells
    assert sorted(read.array_names) == sorted(whole.array_names)
    assert read.bounds == whole.bounds
    assert read["von_mises"].max() == pytest.approx(whole["von_mises"].max(), rel=1e-12)


def test_a_folder_of_several_steps_lists_the_files_of_ranks(tmp_path, monkeypatch):
    """In a folder that held the files of more ranks, and of one process; what is there is listed, and nothing else."""
    folder = tmp_path / "out"
    many = solved("several steps", RanksInTurn(5), monkeypatch)
    write_folder(many, folder)
    write_folder(replace(many, backend="multifrontal"), folder)
    assert not [*folder.rglob("*.pvtu"), *folder.rglob("*_rank*")]
    history = solved("several steps", RanksInTurn(2), monkeypatch)
    assert folder / "solution.pvtu" in write_folder(history, folder)
    series = ElementTree.parse(folder / "solution.pvd")
    assert [entry.get("file") for entry in series.iter("DataSet")] == [f"solution_000{k}.pvtu" for k in (1, 2, 3)]
    assert (folder / "solution.pvtu").read_bytes() == (folder / "solution_0003.pvtu").read_bytes()
    listed = {file for index in folder.glob("*.pvtu") for file in sources(index)}
    assert listed == set(folder.glob("fields/*_rank*.vtu"))
    assert len(listed) == 2 * 3
    assert not [*folder.glob("solution*.vtu")]


def test_files_of_ranks_hold_what_criteria_of_fatigue_say(tmp_path, monkeypatch):
    """The last state alone, of one step and of several; of some bodies, of surfaces, and of pairs; rows of text too."""
    asked = [
        sg.Fatigue(sg.fatigue.SWT(), where="up"),
        sg.Fatigue(sg.fatigue.Crossland(bending_limit=300.0, torsion_limit=200.0), where=["low.top", "up"]),
        sg.Fatigue(sg.fatigue.Ruiz()),
    ]
    monkeypatch.setattr(by_rows, "_AT_ONCE", 7)
    for name in ("held by contact alone", "supports that hold again"):
        steps = [replace(step, at="events") for step in in_increments(MODELS[name]()).steps]
        model = replace(MODELS[name](), fatigue=asked, steps=steps)
        history = solved("", RanksInTurn(RANKS), monkeypatch, model)
        folders = [tmp_path / name / way for way in ("ranks", "one")]
        for folder, backend in zip(folders, ("petsc", "multifrontal"), strict=True):
            folder.mkdir(parents=True)
            write_folder(replace(history, backend=backend), folder)
        assert_whole(folders[0] / "solution.pvtu", folders[1] / "solution.vtu")
        for file in ("fatigue.csv", "history.csv"):
            assert (folders[0] / file).read_bytes() == (folders[1] / file).read_bytes()
        listed = {file for index in folders[0].glob("*.pvtu") for file in sources(index)}
        assert listed <= set(folders[0].glob("fields/*_rank*.vtu"))
        arrays = meshio.read(sources(folders[0] / "solution.pvtu")[0]).point_data
        assert {"fatigue_1_SWT", "fatigue_2_Crossland", "fatigue_3_Ruiz"} <= arrays.keys()


def test_a_rank_whose_disk_is_full_says_so(tmp_path, monkeypatch):
    history = solved("held by contact alone", RanksInTurn(RANKS), monkeypatch)
    write = module.write_grid

    def full(grid, path, **how):
        if path.name.endswith("rank1.vtu"):
            raise OSError(errno.ENOSPC, "No space left on device")
        write(grid, path, **how)

    monkeypatch.setattr(module, "write_grid", full)
    with pytest.raises(OSError, match=r"cannot write results into '.*': No space left on device; what it held"):
        write_folder(history, tmp_path)
    assert not [file for file in tmp_path.iterdir() if file.name != "fields"]


def test_a_rank_without_cells_writes_nothing(tmp_path, monkeypatch):
    """Two cells, whose first nodes are of the first and the last of three ranks."""
    team = RanksInTurn(RANKS)
    history = solved(
        "cubes",
        team,
        monkeypatch,
        sg.Model(
            sg.rectangle(width=2.0, height=1.0, nx=2, ny=1),
            bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
            supports=[sg.Support("left", u=(0, 0))],
            loads=[sg.Load("right", traction=(0.1, 0.0))],
        ),
    )
    mesh = history.model.mesh
    first = [int(nodes[0]) for cells in mesh.cells.values() for nodes in cells]
    owner = np.ones(len(mesh.points), dtype=np.int64)
    owner[first] = [0, 2]
    ranks = FieldsOnRanks(team, history.model, owner)
    names = write_state(Fields(history.model), history.last, tmp_path, "parts", ranks=ranks)
    assert names == ["fields/parts_rank0.vtu", "fields/parts_rank2.vtu", "parts.pvtu"]
    assert [len(meshio.read(tmp_path / file).cells_dict["quad"]) for file in names[:-1]] == [1, 1]


def test_one_process_writes_where_ranks_do_not(monkeypatch):
    """Of a mesh that was not cut here."""
    team = RanksInTurn(RANKS)
    assert fields_on_ranks(solved("several steps", team, monkeypatch)) is not None
    history = solved("several steps", team, monkeypatch)
    team.owners.clear()
    assert fields_on_ranks(history) is None
    monkeypatch.setattr(all_ranks, "several_ranks", lambda: None)
    assert fields_on_ranks(history) is None
