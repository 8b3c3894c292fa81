# SPDX-License-Identifier: BSD-3-Clause
"""What sides that slide over ten elements set free, of the work of friction: rigid wheels and meshed sides.

    python -m benchmarks.sliding_energy [--page]     (--page writes docs/sliding.md)

Where nothing slides, or nothing rubs, it is of the work that friction would take.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import page
from signorini.engine import stride_pairs
from signorini.gallery.sliding import PRESSING, dragged_cylinder, driven_wheel

_PAGE = Path(__file__).parent.parent / "docs" / "sliding.md"
_STRIDES = (0.25, 0.125)  # of the shortest facet
_FRICTION = 0.3  # coefficient
_SPACING = 0.2  # mm, of the nodes of both sides of the cylinder, a fifth of its half-width
_STEEL = sg.Elastic(E=200.0, nu=0.3)


def wheel(*, rolls: bool) -> tuple[sg.Model, float]:
    """A rigid wheel on half-planes, four elements in the half-width, dragged or driven along ten of them; its force."""
    model = driven_wheel(ratio=0.64, ways=(0.0, 2.5), across=4, friction=_FRICTION)
    (obstacle,) = model.obstacles
    if not rolls:
        obstacle = replace(obstacle, rotation=0.0, moment=0.0)
    return replace(model, obstacles=[obstacle], steps=[model.steps[0], model.steps[2]]), 10.0


def cylinder(friction: float) -> tuple[sg.Model, float]:
    """A meshed cylinder on a meshed flat, five elements in the half-width, dragged along ten of them."""
    return dragged_cylinder(stroke=10.0 * _SPACING, spacing=_SPACING, friction=friction), PRESSING


def block() -> tuple[sg.Model, float]:
    """A block with corners on a bed whose nodes are not opposite its own, dragged along ten elements of its own."""
    top = sg.rectangle(x=np.linspace(0.0, 2.0, 9), y=np.linspace(0.0, 1.0, 4))
    bed = sg.rectangle(x=np.linspace(-1.0, 5.5, 22), y=np.linspace(-1.0, 0.0, 4))
    model = sg.Model(
        mesh=sg.join({"top": top, "bed": bed}),
        kind="plane strain",
        bodies=[sg.Body("top", _STEEL), sg.Body("bed", _STEEL)],
        supports=[sg.Support("bed.bottom", u=(0.0, 0.0)), sg.Support("top.top", u=(2.5, "free"), name="drag")],
        loads=[sg.Load(on="top.top", force=("free", -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact("top.bottom", "bed.top", friction=_FRICTION, sliding="finite")],
        steps=[sg.Step(scale={"press": 1.0, "drag": 0.0}), sg.Step(scale={"press": 1.0, "drag": 1.0})],
    )
    return model, 1.0


def hub() -> tuple[sg.Model, float]:
    """A hub that is pressed along its shaft by ten elements, axisymmetric."""
    shaft = sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(-1.0, 5.0, 25))
    ring = sg.rectangle(x=np.linspace(1.0, 2.0, 4), y=np.linspace(0.0, 1.0, 6))
    model = sg.Model(
        mesh=sg.join({"shaft": shaft, "hub": ring}),
        kind="axisymmetric",
        bodies=[sg.Body("shaft", _STEEL), sg.Body("hub", _STEEL)],
        supports=[sg.Support("shaft.bottom", u=(None, 0.0)), sg.Support("hub.bottom", u=(None, 2.0), name="push")],
        contacts=[sg.Contact("hub.left", "shaft.right", friction=_FRICTION, sliding="finite", interference=0.002)],
        steps=[sg.Step(scale={"push": 0.0}), sg.Step(scale={"push": 1.0})],
    )
    return model, 0.0


MODELS = {
    "rigid wheel, dragged": lambda: wheel(rolls=False),
    "rigid wheel, driven at 0.64 of friction": lambda: wheel(rolls=True),
    "cylinder on a flat": lambda: cylinder(_FRICTION),
    "cylinder on a flat, no friction": lambda: cylinder(0.0),
    "block with corners": block,
    "hub on a shaft": hub,
}


def freed(model: sg.Model, force: float) -> float:
    """Energy that the last step sets free, of the work of friction where all of it slides."""
    *_, step = sg.solve(model).steps
    way = max(abs(float(value)) for support in model.supports for value in support.u if isinstance(value, float))
    return abs(step.released) / (_FRICTION * force * way if force else step.work)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--page", action="store_true", help="write the table into docs/sliding.md")
    rows = []
    for name, make in MODELS.items():
        row = [name]
        for stride in _STRIDES:
            stride_pairs._STRIDE = stride
            row.append(f"{freed(*make()):.1e}")
        rows.append(row)
    text = page.table(("dragged along ten elements", *(f"strides of 1/{round(1 / s)} facet" for s in _STRIDES)), rows)
    print(text)
    if parser.parse_args().page:
        page.write("energy of sliding", text, _PAGE)


if __name__ == "__main__":
    main()
