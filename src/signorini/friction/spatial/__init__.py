# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb's law in space on the condensed interface: the exact circular or elliptic cone, and its facets.

Pairs have three rows: n normals, n first tangents, n second tangents. `solve_spatial` is to a `SpatialProblem` what
`friction.solve_coulomb` is to a `friction.CoulombProblem`.
"""

from signorini.friction.history.space.follow import StopSettings, at_rest, follow_stopping
from signorini.friction.history.space.landing import land_spatial
from signorini.friction.spatial.certificate import Violations, certify, natural_residual, violations
from signorini.friction.spatial.faceted import decoded, faceted_lcp
from signorini.friction.spatial.law import OPEN, SLIP, STICK, split, states
from signorini.friction.spatial.problem import SpatialProblem, from_compliance
from signorini.friction.spatial.result import LimitLoad, SpatialResult
from signorini.friction.spatial.solve import SpatialSettings, limit_load, solve_spatial

__all__ = [
    "OPEN",
    "SLIP",
    "STICK",
    "LimitLoad",
    "SpatialProblem",
    "SpatialResult",
    "SpatialSettings",
    "StopSettings",
    "Violations",
    "at_rest",
    "certify",
    "decoded",
    "faceted_lcp",
    "follow_stopping",
    "from_compliance",
    "land_spatial",
    "limit_load",
    "natural_residual",
    "solve_spatial",
    "split",
    "states",
    "violations",
]
