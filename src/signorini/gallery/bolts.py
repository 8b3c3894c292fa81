# SPDX-License-Identifier: BSD-3-Clause
"""A bolt that clamps a sleeve, with stiffnesses by hand."""

from __future__ import annotations

import numpy as np

from signorini.meshing.cut import cut
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.bolt import Bolt
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.links import RigidBody
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.step import Step

PRELOAD = 6.0
"""Force of the bolt."""

_LENGTH, _WIDTH, _CLAMPED = 4.0, 1.0, 1.5  # of bolt and sleeve, of the bolt, of the sleeve
_MODULUS = 200.0  # force over area; bars without contraction, so that strains are uniform


def bolted_sleeve() -> tuple[Model, float, float]:
    """A bolt with a rigid head on a sleeve, and the stiffness of both, force over length.

    Two steps: the bolt is tightened to :data:`PRELOAD`, and with its length locked the head is pulled, at the factor 1
    of "pull" by as much.
    """
    inner, outer = _WIDTH + 0.5, _WIDTH + 0.5 + _CLAMPED
    whole = rectangle(x=[0.0, _WIDTH, inner, outer], y=np.linspace(0.0, _LENGTH + 1.0, 6))
    quads = whole.cells["quad"]
    at = whole.points[quads].mean(axis=1)
    kept = (at[:, 0] < _WIDTH) | (at[:, 1] > _LENGTH)
    used, cells = np.unique(quads[kept], return_inverse=True)
    points, above = whole.points[used], at[kept][:, 1] > _LENGTH
    seat = np.flatnonzero((points[:, 1] == _LENGTH) & (points[:, 0] >= inner))
    bolt = Mesh(
        points=points,
        cells={"quad": cells.reshape(-1, 4)},
        bodies={"shank": np.flatnonzero(~above), "head": np.flatnonzero(above)},
        boundaries={"seat": seat[None, :], "foot": np.flatnonzero(points[:, 1] == 0.0)[None, :]},
    )
    sleeve = rectangle(x=[inner, outer], y=np.linspace(0.0, _LENGTH, 5))
    mesh = cut(
        join({"bolt": bolt, "sleeve": sleeve}), "cut", body="bolt.shank", point=(0.0, 0.5 * _LENGTH), normal=(0.0, 1.0)
    )
    steel = Elastic(E=_MODULUS, nu=0.0)
    model = Model(
        mesh,
        kind="plane stress",
        bodies=[Body(name, steel) for name in ("bolt.shank", "bolt.head", "sleeve")],
        supports=[
            Support("bolt.foot", u=(0.0, 0.0)),
            Support("sleeve.bottom", u=(0.0, 0.0)),
            Support("head", u=(0.0, None, 0.0)),
        ],
        rigid_bodies=[RigidBody("head", on="bolt.head", point=(0.0, _LENGTH + 1.0))],
        loads=[Load("head", force=(0.0, PRELOAD, 0.0), name="pull")],
        contacts=[Contact("sleeve.top", "bolt.seat", friction=0.2)],
        bolts=[Bolt("cut", force=PRELOAD, name="bolt")],
        steps=[
            Step(name="tighten", scale={"bolt": 1.0, "pull": 0.0}),
            Step(name="pull", hold=["bolt"], scale={"pull": 1.0}),
        ],
    )
    return model, _MODULUS * _WIDTH / _LENGTH, _MODULUS * _CLAMPED / _LENGTH
