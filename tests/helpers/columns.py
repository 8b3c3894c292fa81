# SPDX-License-Identifier: BSD-3-Clause
"""A column of two unit blocks that yield, pressed from above: uniaxial stress, with closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import signorini as sg

E, NU, Y, HARDENING, EXPANSION, DENSITY = 200.0, 0.3, 1.0, 20.0, 1e-3, 0.5
PRESSURE = 2.0

ELASTIC = sg.Elastic(E=E, nu=NU, density=DENSITY, expansion=EXPANSION)
SOFT = replace(ELASTIC, plastic=sg.Plastic(Y, hardening=HARDENING))


def plastic_strain(stress: float = PRESSURE) -> float:
    """Of a bar that is pulled once."""
    return max(stress - Y, 0.0) / HARDENING


def strain(stress: float = PRESSURE) -> float:
    """Of a bar that is pulled once, elastic and plastic."""
    return stress / E + plastic_strain(stress)


def column(
    kind: str = "axisymmetric",
    *,
    lower: sg.Elastic = SOFT,
    upper: sg.Elastic = SOFT,
    cells: tuple[int, int] | None = None,
    friction: float | str = 0.0,
    supports: tuple[sg.Support, ...] = (),
    **given: object,
) -> sg.Model:
    """Two blocks, "up" on "low", whose meshes do not match, free to widen.

    Parameters
    ----------
    kind : of the model; in space two planes of symmetry hold the blocks, in the plane one
    lower, upper : materials
    cells : along an edge of the upper and the lower one; (2, 3), in space (1, 2)
    friction : of their contact "interface"
    supports : beyond those of symmetry and the bottom
    given : other fields of the model; without loads or obstacles the load "press" is on the top
    """
    up, low = (np.linspace(0.0, 1.0, n + 1) for n in cells or ((1, 2) if kind == "3d" else (2, 3)))
    if kind == "3d":
        mesh = sg.join({"up": sg.box(x=up, y=up, z=1.0 + up), "low": sg.box(x=low, y=low, z=low)})
        held = [sg.Support("low.bottom", u=(None, None, 0.0), name="floor")]
        for block in ("up", "low"):
            held += [
                sg.Support(f"{block}.left", u=(0.0, None, None)),
                sg.Support(f"{block}.front", u=(None, 0.0, None)),
            ]
    else:
        mesh = sg.join({"up": sg.rectangle(x=up, y=1.0 + up), "low": sg.rectangle(x=low, y=low)})
        held = [sg.Support("low.bottom", u=(None, 0.0), name="floor")]
        if kind != "axisymmetric":
            held += [sg.Support(f"{block}.left", u=(0.0, None)) for block in ("up", "low")]
    if "foundations" in given:
        held = [support for support in held if support.name != "floor"]
    if not {"loads", "obstacles"} & given.keys():
        given["loads"] = [sg.Load("up.top", pressure=PRESSURE, name="press")]
    contact = sg.Contact("up.bottom", "low.top", friction=friction, name="interface")
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body("up", upper), sg.Body("low", lower)],
        supports=[*held, *supports],
        **({"contacts": [contact], "steps": [sg.Step(increments=1)]} | given),
    )


def top(solution: sg.Solution, step: int = -1) -> np.ndarray:
    """(k,) How far the nodes of the top have moved up."""
    return solution.steps[step].displacement[solution.model.mesh.nodes_of("up.top"), -1]
