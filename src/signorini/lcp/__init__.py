# SPDX-License-Identifier: BSD-3-Clause
"""Linear complementarity problems: find z with ``0 <= z  _|_  w = M z + q >= 0``. Stands alone, knows no mechanics."""

from signorini.lcp.block import BlockPivoting
from signorini.lcp.box import BoxLCP, MixedLCP
from signorini.lcp.classes import (
    is_copositive_plus,
    is_k,
    is_p,
    is_positive_definite,
    is_positive_semidefinite,
    is_symmetric,
    is_z,
)
from signorini.lcp.enumeration import Enumeration, Face, all_solutions
from signorini.lcp.feasibility import Feasibility
from signorini.lcp.game import LemkeHowson
from signorini.lcp.interior import InteriorPoint
from signorini.lcp.lemke import Lemke
from signorini.lcp.mprgp import MPRGP
from signorini.lcp.multigrid import ProjectedMultigrid
from signorini.lcp.newton import SemismoothNewton
from signorini.lcp.principal import LeastIndex
from signorini.lcp.problem import LCP
from signorini.lcp.relaxation import ProjectedSOR
from signorini.lcp.residual import Residual, natural_residual
from signorini.lcp.solution import LCPSolution, Method, Ray, Status
from signorini.lcp.solve import METHODS, solve

__all__ = [
    "LCP",
    "METHODS",
    "MPRGP",
    "BlockPivoting",
    "BoxLCP",
    "Enumeration",
    "Face",
    "Feasibility",
    "InteriorPoint",
    "LCPSolution",
    "LeastIndex",
    "Lemke",
    "LemkeHowson",
    "Method",
    "MixedLCP",
    "ProjectedMultigrid",
    "ProjectedSOR",
    "Ray",
    "Residual",
    "SemismoothNewton",
    "Status",
    "all_solutions",
    "is_copositive_plus",
    "is_k",
    "is_p",
    "is_positive_definite",
    "is_positive_semidefinite",
    "is_symmetric",
    "is_z",
    "natural_residual",
    "solve",
]
