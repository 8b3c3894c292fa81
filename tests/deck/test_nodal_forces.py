# SPDX-License-Identifier: BSD-3-Clause
"""Nodal forces of files as loads of decks: of modes, whose loops they follow, and of tables."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.model.modes import STUCK
from signorini.output.modes_files import write_shapes
from tests.helpers.bar_deck import BAR_ON_A_FLOOR

BAR = BAR_ON_A_FLOOR.replace("pressure = 1.0", 'pressure = "0.02 + 2*x^2"')
SHAKE = """\
[[load]]
name = "shake"
nodal_forces = { file = "modes.vtu", column = "stuck_1_force" }
[[step]]
name = "press"
scale = { press = 1.0 }
[[step]]
name = "shake"
scale = { shake = [SIZE, -SIZE, SIZE] }
"""


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, sg.Solution]:
    """A folder with the modes of a bar that is pressed on a rough floor."""
    folder = tmp_path_factory.mktemp("modes")
    (folder / "press.toml").write_text(BAR)
    solution = sg.solve(sg.read(folder / "press.toml"))
    write_shapes(solution.model, {STUCK: sg.natural_modes(solution, 1)}, folder / "modes.vtu")
    return folder, solution


def test_the_force_of_a_mode_moves_what_sticks_by_its_shape(pressed: tuple[Path, sg.Solution]) -> None:
    folder, solution = pressed
    (folder / "deck.toml").write_text(BAR.replace("0.4", '"stick"') + SHAKE.replace("SIZE", "1e-6"))
    before, step = sg.solve(sg.read(folder / "deck.toml")).steps
    shape = sg.natural_modes(solution, 1).shapes[0]
    moved = 1e-6 * shape / np.linalg.norm(shape, axis=1).max()
    assert step.displacement - before.displacement == pytest.approx(moved, abs=1e-12)


def test_its_loop_is_that_of_the_mode(pressed: tuple[Path, sg.Solution]) -> None:
    folder, solution = pressed
    (folder / "deck.toml").write_text(BAR + SHAKE.replace("SIZE", "2e-3"))
    step = sg.solve(sg.read(folder / "deck.toml")).steps[-1]
    ends = [sum(c.dissipation for c in one.contacts) for one in step.instants if one.what == "segment"]
    loop = sg.joint_damping(solution, [2e-3], cycles=1).loops[0]
    assert loop.dissipation > 0.0
    assert ends[-1] - ends[0] == pytest.approx(loop.dissipation, rel=1e-9)


def test_tables_have_forces_by_numbers_of_nodes(pressed: tuple[Path, sg.Solution]) -> None:
    folder, _ = pressed
    (folder / "forces.csv").write_text("node,fx,fy\n27,0.5,0\n9,0,0\n18,0.25,-0.5\n")
    text = BAR + '[[load]]\nname = "pull"\nnodal_forces = { file = "forces.csv" }\n'
    (folder / "deck.toml").write_text(text)
    model = sg.read(folder / "deck.toml")
    assert model.mesh.nodes["pull"].tolist() == [17, 26]
    assert model.loads[1].nodal_forces.tolist() == [[0.25, -0.5], [0.5, 0.0]]
    assert main(["convert", str(folder / "deck.toml"), "-o", str(folder / "again.toml")]) == 0
    again = sg.read(folder / "again.toml")
    assert (again.loads[1].nodal_forces == model.loads[1].nodal_forces).all()


FILE = '{ file = "modes.vtu", column = "stuck_1_force" }'


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (FILE, '{ file = "lost.vtu" }', ":26: load[1].nodal_forces.file: there is no file"),
        (
            FILE,
            '{ file = "modes.vtu", column = "stuck_2_force" }',
            ":26: load[1].nodal_forces.column: 'modes.vtu': unk",
        ),
        (FILE, '{ file = "modes.vtu" }', ":26: load[1].nodal_forces.column: 'modes.vtu': unknown field of vectors"),
        (FILE, '{ fil = "modes.vtu" }', ":26: load[1].nodal_forces.fil: unknown key; did you mean 'file'?"),
        (
            FILE,
            '{ file = "wrong.csv" }',
            ":26: load[1].nodal_forces: 'PATH' has the columns node, fx; expected node, fx",
        ),
        (FILE, '{ file = "foreign.csv" }', ":26: load[1].nodal_forces: has node 99, which the mesh has not; expected"),
        (FILE, '{ file = "twice.csv" }', ":26: load[1].nodal_forces: has a node twice; expected one force for each"),
        (FILE, '{ file = "none.csv" }', ":26: load[1].nodal_forces: has no force at all; expected one force for each"),
        (
            'name = "shake"\nnodal',
            'name = "shake"\non = "top"\nnodal',
            ":26: load[1].on: goes with no nodal_forces of a",
        ),
        ('name = "shake"\nnodal', 'name = "top"\nnodal', ":25: load[1].name: there is a place called 'top'; expected"),
    ],
)
def test_what_are_no_forces_is_told(
    pressed: tuple[Path, sg.Solution], capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    folder, _ = pressed
    for name, rows in (("wrong", "1,1"), ("foreign", "99,1,0"), ("twice", "2,1,0\n2,0,1"), ("none", "2,0,0")):
        (folder / f"{name}.csv").write_text(f"node,fx{'' if name == 'wrong' else ',fy'}\n{rows}\n")
    text = BAR + SHAKE.replace("SIZE", "1e-6")
    assert text.count(old) == 1
    (folder / "deck.toml").write_text(text.replace(old, new))
    assert main(["check", str(folder / "deck.toml")]) == 2
    assert said.replace("PATH", str(folder / "wrong.csv")) in capsys.readouterr().err
