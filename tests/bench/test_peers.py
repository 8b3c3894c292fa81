# SPDX-License-Identifier: BSD-3-Clause
"""Decks for other codes are right, and where the codes are there they agree with us."""

from pathlib import Path

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder

case = pytest.importorskip("benchmarks.peers.case", reason="the benchmarks are beside the tests in a checkout only")


def test_calculix_deck_has_the_load_of_the_paper(tmp_path: Path) -> None:
    cylinder = case.cylinder_case(1)
    case.write_calculix(cylinder, tmp_path / "cylinder.inp", friction=0.4)
    deck = (tmp_path / "cylinder.inp").read_text()
    lines = deck.split("*DLOAD\n")[1].split("*")[0].splitlines()
    total = 0.0
    for line in lines:
        cell, side, pressure = line.split(",")
        corners = cylinder.points[cylinder.cells[int(cell) - 1]]
        start = int(side[1]) - 1
        ends = corners[[start, (start + 1) % 4]]
        assert (ends[:, 1] == 8.0).all()
        total += float(pressure) * np.ptp(ends[:, 0])
    assert total == pytest.approx(78.0)
    assert "*FRICTION\n0.4,1000" in deck
    assert deck.count("*NODE\n") == 1


def test_arc_from_the_pole_up() -> None:
    cylinder = case.cylinder_case(2)
    arc = cylinder.points[cylinder.arc_nodes]
    assert arc[0].tolist() == [0.0, 0.0]
    assert (np.diff(arc[:, 1]) > 0).all()
    assert cylinder.arc_lengths.sum() == pytest.approx(np.linalg.norm(np.diff(arc, axis=0), axis=1).sum())


@pytest.mark.slow
@pytest.mark.parametrize(("peer", "tolerance"), [("run_getfem", 1e-6), ("run_calculix", 2e-2)])
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_peers_agree(peer: str, tolerance: float, friction: float) -> None:
    """GetFEM solves the same discrete problem; CalculiX has a penalty and pressures at other points."""
    module = pytest.importorskip(f"benchmarks.peers.{peer}")
    reason = module.missing()
    if reason is not None:
        pytest.skip(reason)
    result = module.run(case.cylinder_case(3), friction)
    contact = solve_prepared(prepare(zhu_cylinder(friction=friction, refine=3))).last.contacts[0]
    ours = contact.pressure[np.argsort(contact.points[:, 0])]
    near = slice(0, 10)  # away from the edge of contact
    assert result.pressure[near] == pytest.approx(ours[near], rel=tolerance)
    assert result.iterations > 1
    assert min(result.solve_seconds, result.memory) > 0


def test_page_keeps_what_is_around_a_table(tmp_path: Path) -> None:
    page = pytest.importorskip("benchmarks.page")
    begin, end = page.markers("name")
    file = tmp_path / "page.md"
    file.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
    page.write("name", page.table(("what", "s"), [("all", 1)]), file)
    page.write("name", page.table(("what", "s"), [("all", 1)]), file)
    assert file.read_text() == f"before\n{begin}\n| what | s |\n| --- | ---: |\n| all | 1 |\n{end}\nafter\n"
    with pytest.raises(SystemExit, match="lacks the line"):
        page.write("other", "", file)
