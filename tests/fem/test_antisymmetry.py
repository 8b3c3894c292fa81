# SPDX-License-Identifier: BSD-3-Clause
"""Planes of antisymmetry: half of what is loaded by opposites, or vibrates so, is the whole."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from tests.helpers.eight_cells import eight_cells

STEEL = sg.Elastic(E=200.0, nu=0.3, density=1.0)


def stack(whole, cut=None, space=False):
    """Two layers on each other from x = 0, or -2, to 2, clamped at the ends, pushed up on the right."""
    ends = np.linspace(-2.0 if whole else 0.0, 2.0, 9 if whole else 5)

    def layer(low, high):
        flat = sg.rectangle(x=ends, y=[low, high])
        return sg.extruded(flat, z=[0.0, 0.5], ends=("front", "back")) if space else flat

    zero = (0.0, 0.0, 0.0)[: 3 if space else 2]

    def push(at):
        return np.sign(at[:, :1]) * np.eye(len(zero))[1]

    mesh = sg.join({"lower": layer(0.0, 0.5), "upper": layer(0.5, 1.0)})
    clamped = ["right", "left"] if whole else ["right"]
    return sg.Model(
        mesh,
        bodies=[sg.Body(name, STEEL) for name in ("lower", "upper")],
        supports=[sg.Support(f"{part}.{end}", u=zero) for part in ("lower", "upper") for end in clamped]
        + ([] if whole else [sg.Support(f"{part}.left", u=cut, name=f"cut {part}") for part in ("lower", "upper")]),
        loads=[sg.Load("upper.top", traction=push, name="push")],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction="tied")],
    )


@pytest.mark.parametrize("space", [False, True])
def test_half_is_the_whole(space):
    along = (None, 0.0, 0.0) if space else (None, 0.0)
    whole, half = (stack(*given, space=space) for given in ((True,), (False, along)))
    one, part = (sg.solve(model).steps[-1] for model in (whole, half))
    assert 2.0 * part.strain_energy == pytest.approx(one.strain_energy, rel=1e-10)
    right = [int(np.argmin(np.linalg.norm(whole.mesh.points - x, axis=1))) for x in half.mesh.points]
    # nodes of both layers share places: those of the lower one come first in both meshes
    low = half.mesh.points[:, 1] < 0.5
    size = np.abs(one.displacement).max()
    assert part.displacement[low] == pytest.approx(one.displacement[right][low], abs=1e-11 * size)


def test_modes_of_the_whole_are_those_of_both_halves():
    whole = sg.natural_modes(stack(True), 6).squares
    halves = [sg.natural_modes(stack(False, cut), 4).squares for cut in ((0.0, None), (None, 0.0))]
    assert np.sort(np.concatenate(halves))[:6] == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize(("word", "axes"), [("XASYMM", (2, 3)), ("YASYMM", (1, 3)), ("ZASYMM", (1, 2))])
def test_planes_of_antisymmetry_of_a_deck(tmp_path: Path, word: str, axes: tuple[int, int]) -> None:
    found = []
    for held in (f"R,{word}", "\n".join(f"R,{axis}" for axis in axes)):
        path = tmp_path / "deck.inp"
        path.write_text(f"{eight_cells()}{held}\n*STEP\n*STATIC\n*DLOAD\n8,P2,1.\n*END STEP\n")
        found.append(sg.solve(sg.read(path)).steps[-1].displacement)
    assert (found[0] == found[1]).all()
    assert np.abs(found[0]).max() > 0.0
