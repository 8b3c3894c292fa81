# SPDX-License-Identifier: BSD-3-Clause
"""The same deck gives the same bytes: again, in another folder, and whatever number of threads there are."""

import json
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest

import signorini as sg
from signorini import blas_threads, cores
from signorini.cli import main
from signorini.fem import assembly, jacobian, kinematics, stiffness
from signorini.gallery.cubes import cubes
from signorini.interface import face_parts
from signorini.linalg import multifrontal, plan, schedule, system
from signorini.output.dataclasses_json import unsealed
from signorini.output.folder import write_folder

SPACE = """\
[mesh]
generator = "box"
x = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
y = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0]
z = [0.0, 0.25, 0.5]

[material.m]
E = 100.0
nu = 0.3

[[body]]
name = "block"
material = "m"

[[load]]
name = "press"
on = "top"
pressure = 1.0

[[load]]
name = "pull"
on = "right"
traction = [0.5, 0.2, 0.0]

[[contact]]
nonmortar = "bottom"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
friction = 0.4

[[step]]
scale = { press = 1.0 }

[[step]]
scale = { pull = 1.0 }
increments = 2
"""
CYLINDER = Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml"


def numbers(folder: Path) -> Iterator[tuple[str, object]]:
    """Every file with what is the same in it, whenever it was written: all but seconds and memory."""
    for file in sorted(file for file in folder.rglob("*") if file.is_file()):
        name = str(file.relative_to(folder))
        if file.suffix == ".h5":
            with h5py.File(file) as archive:
                parts: dict[str, object] = {}
                archive.visititems(lambda key, part, parts=parts: parts.update(_dataset(key, part)))
                yield name, parts
        elif file.suffix == ".npz":
            with np.load(file) as state:
                yield name, {key: state[key].tobytes() for key in state.files}
        elif file.suffix == ".json":
            summary = json.loads(file.read_text())
            yield name, {key: value for key, value in summary.items() if key not in ("timings", "peak_memory_bytes")}
        else:
            yield name, file.read_bytes()


def _dataset(key: str, part: h5py.Dataset | h5py.Group) -> dict[str, object]:
    if not isinstance(part, h5py.Dataset):
        return {}
    if key == "structure":
        plain = unsealed(part.asstr()[()])
        return {key: {name: value for name, value in plain.items() if name != "timings"}}
    return {key: list(part[()]) if part.dtype.kind == "O" else part[()].tobytes()}


@pytest.fixture
def use() -> Iterator[object]:
    """Says how many threads the BLAS of SciPy and NumPy may use."""
    found = blas_threads._found
    before = [get() for _, get in found]
    yield lambda number: [set_number(number) for set_number, _ in found]
    for (set_number, _), number in zip(found, before, strict=True):
        set_number(number)


@pytest.fixture
def shared(monkeypatch) -> None:
    """Small models are shared as large ones are."""
    monkeypatch.setattr(plan, "SHARED_WORK", 1e4)
    monkeypatch.setattr(schedule, "TILE", 16)
    monkeypatch.setattr(multifrontal, "SHARED_SOLVE", 0.0)
    monkeypatch.setattr(kinematics, "CELLS_AT_ONCE", 16)
    monkeypatch.setattr(jacobian, "_AT_ONCE", 16)
    monkeypatch.setattr(jacobian, "_SHARED_CELLS", 0)
    monkeypatch.setattr(assembly, "SHARED_CELLS", 0)
    monkeypatch.setattr(stiffness, "SHARED_ENTRIES", 0)
    monkeypatch.setattr(system, "SHARED_ENTRIES", 0)
    monkeypatch.setattr(face_parts, "SHARED_PAIRS", 0)


@pytest.mark.slow
@pytest.mark.usefixtures("shared")
@pytest.mark.parametrize("backend", ["auto", "iterative"])
@pytest.mark.parametrize("deck", ["plane", "space"])
def test_a_run_gives_the_same_bytes_whatever_the_threads(deck: str, backend: str, tmp_path: Path, use) -> None:
    path = tmp_path / f"{deck}.toml"
    path.write_text(SPACE if deck == "space" else CYLINDER.read_text().replace('path = "exact"', ""))
    if deck == "plane" and backend == "iterative":
        path.write_text(path.read_text() + "\n[[step]]\nincrements = 2\n")
    found = []
    for number, folder in ((1, "one"), (2, "two"), (3, "three"), (1, "again")):
        use(number)
        with cores.threads(number):
            code = main(["run", str(path), "-o", str(tmp_path / folder / "out"), "--quiet", "--backend", backend])
        assert code == 0
        found.append(dict(numbers(tmp_path / folder / "out")))
    assert len(found[0]) >= 6
    for other in found[1:]:
        assert [name for name in found[0] if found[0][name] != other.get(name)] == []


@pytest.mark.usefixtures("shared")
def test_sides_that_do_not_match_give_the_same_bytes_whatever_the_threads(tmp_path: Path) -> None:
    found = []
    for number in (1, 2, 3):
        with cores.threads(number):
            write_folder(sg.solve(cubes(5, 4)), tmp_path / str(number))
        found.append(dict(numbers(tmp_path / str(number))))
    assert len(found[0]) >= 6
    for other in found[1:]:
        assert [name for name in found[0] if found[0][name] != other.get(name)] == []
