# SPDX-License-Identifier: BSD-3-Clause
"""Modes of a sector with waves around its ring: all of them together are those of the ring."""

from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.deck import DeckError, load_deck
from signorini.gallery.sectors import SECTORS, ring_on_shaft
from signorini.model.modes import ModesRequest
from tests.deck.inp.test_cyclic_symmetry import deck as sector_deck
from tests.helpers.calculix import ccx_frequencies, needs_ccx

STEEL = sg.Elastic(E=200.0, nu=0.3, density=2.0)


def of_all_waves(sector, number, **given):
    """omega^2 of all numbers of waves, ascending: those that go around do so both ways."""
    found = [sg.natural_modes(sector, number, nodal_diameters=h, **given).squares for h in range(SECTORS // 2 + 1)]
    return np.sort(np.concatenate([found[0], *(np.repeat(one, 2) for one in found[1:-1]), found[-1]]))


@pytest.mark.parametrize("joint", ["stuck", "slipping"])
def test_waves_of_a_sector_whose_sides_cut_a_joint_are_those_of_the_whole(joint):
    whole, sector = (ring_on_shaft(whole=every) for every in (True, False))
    exact = sg.natural_modes(whole, 20, joint=joint).squares
    assert of_all_waves(sector, 6, joint=joint)[:20] == pytest.approx(exact, rel=1e-9, abs=1e-9 * exact[-1])


def ring(count):
    flat = sg.annulus(
        inner=1.0, outer=1.5, n_radial=2, n_angular=3 * count, angle=60.0 * count, centre=(0.0, 0.0), cells="quad8"
    )
    return sg.Model(
        sg.extruded(flat, z=[0.0, 0.2, 0.4]),
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("bottom", u=(None, None, 0.0))],
        cyclic_symmetries=[] if count == SECTORS else [sg.CyclicSymmetry("end", "start", sectors=SECTORS)],
    )


@pytest.mark.slow
def test_in_space_by_lanczos_method_too():
    exact = sg.natural_modes(ring(SECTORS), 12).squares
    assert of_all_waves(ring(1), 4)[:12] == pytest.approx(exact, rel=1e-8, abs=1e-8 * exact[-1])
    modes = sg.natural_modes(ring(1), 4, nodal_diameters=2)
    assert modes.missed == 0
    assert modes.residuals.max() < 1e-9


def test_shapes_go_on_in_the_next_sector():
    sector, h = ring_on_shaft(whole=False), 2
    modes = sg.natural_modes(sector, 3, nodal_diameters=h)
    angle = 2.0 * np.pi / SECTORS
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    points = sector.mesh.points
    for part in ("ring", "shaft"):
        first, second = (sector.mesh.nodes_of(f"{part}.{side}") for side in ("start", "end"))
        partner = [int(second[np.argmin(np.linalg.norm(points[second] - turn @ x, axis=1))]) for x in points[first]]
        for shape in modes.shapes:
            ahead = np.exp(1j * h * angle) * shape[first] @ turn.T
            assert shape[partner] == pytest.approx(ahead, abs=1e-12 * np.abs(shape).max())
    assert [float(np.vdot(v, f).real) for v, f in zip(modes.shapes, modes.forces, strict=True)] == pytest.approx(
        [1.0] * 3
    )


def test_what_has_no_such_waves_is_named():
    sector = ring_on_shaft(whole=False)
    for model, h, said in (
        (sector, 4, "nodal_diameters: is 4; the model has at most 3, half the sectors"),
        (replace(sector, cyclic_symmetries=[]), 1, "nodal_diameters: is 1; the model has none"),
        (sector, -1, "nodal_diameters: is -1; expected a whole number >= 0"),
    ):
        with pytest.raises(sg.InputError, match=said):
            sg.natural_modes(model, 2, nodal_diameters=h)
    with pytest.raises(sg.InputError, match="amplitudes: are those of loops alike in all sectors"):
        ModesRequest(nodal_diameters=1, amplitudes=[0.1])


def select(folder: Path, waves: str) -> Path:
    """The sector of the static deck, which vibrates."""
    path = sector_deck(folder)
    steps = f"*STEP\n*FREQUENCY\n4\n*SELECT CYCLIC SYMMETRY MODES,{waves}\n*END STEP\n"
    path.write_text(path.read_text().split("*STEP")[0] + steps)
    return path


def test_decks_of_keywords_select_waves(tmp_path: Path) -> None:
    assert load_deck(select(tmp_path, "NMIN=2,NMAX=2")).modes.nodal_diameters == 2
    with pytest.raises(DeckError, match="has NMIN=0 and NMAX=2; expected one whole number as both"):
        load_deck(select(tmp_path, "NMIN=0,NMAX=2"))


@pytest.mark.slow
def test_the_command_tells_the_waves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("signorini.cli.run_modes._PICTURE_DOTS", 20)
    path = select(tmp_path, "NMIN=2,NMAX=2")
    assert main(["modes", str(path), "-o", str(tmp_path / "out"), "--nodal-diameters", "1"]) == 0
    assert "natural frequencies with 1 nodal diameter of the bodies as they are drawn" in capsys.readouterr().out
    grid = meshio.read(tmp_path / "out" / "modes.vtu")
    assert {"stuck_1", "stuck_1_imaginary"} <= set(grid.point_data)


@pytest.mark.slow
@needs_ccx
def test_waves_are_those_of_calculix(tmp_path: Path) -> None:
    path = select(tmp_path, "NMIN=1,NMAX=1")
    ours = sg.natural_modes(load_deck(path).model, 2, nodal_diameters=1).frequencies
    assert np.repeat(ours, 2) == pytest.approx(ccx_frequencies(path), rel=1e-5)
