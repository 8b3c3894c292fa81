# SPDX-License-Identifier: BSD-3-Clause
"""What small displacements do not describe is said, in the plane and in space; what moves as a whole is not."""

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step


def dragged(dimension, motion):
    """A block moved over another one of its size."""
    x = np.linspace(0, 1, 3)
    if dimension == 2:
        upper, lower = rectangle(x=x, y=x), rectangle(x=x, y=x - 1)
    else:
        upper, lower = box(x=x, y=x, z=x), box(x=x, y=x, z=x - 1)
    elastic = Elastic(E=1000.0, nu=0.3)
    return Model(
        join({"upper": upper, "lower": lower}),
        bodies=[Body("upper", elastic), Body("lower", elastic)],
        supports=[Support("lower.bottom", u=(0,) * dimension), Support("upper.top", u=motion)],
        contacts=[Contact("upper.bottom", "lower.top", friction=0.3)],
        steps=[Step(increments=2)],
    )


@pytest.mark.parametrize(
    ("motion", "said"),
    [
        ((0.1, -0.01), []),
        ((0.5, -0.01), ["contact 'upper.bottom' slips by up to 0.4"]),
        ((0.0, 3.0), []),  # away
        ((0.0, -1.5), ["body 'upper' strains or turns by", "body 'lower' strains or turns by"]),
    ],
)
@pytest.mark.parametrize("dimension", [2, 3])
def test_large_displacements_are_said(dimension, motion, said):
    motion = motion if dimension == 2 else (motion[0], 0.0, motion[1])
    notes = [note for note in solve(dragged(dimension, motion)).last.notes if "holds for small" in note]
    assert len(notes) == len(said)
    for note, start in zip(notes, said, strict=True):
        assert note.startswith(start)
