# SPDX-License-Identifier: BSD-3-Clause
"""Linear complementarity problems: find z with ``0 <= z  _|_  w = M z + q >= 0``. Stands alone, knows no mechanics."""

from signorini.lcp.lemke import Lemke
from signorini.lcp.method import Method
from signorini.lcp.problem import LCP
from signorini.lcp.residual import Residual, natural_residual
from signorini.lcp.solution import LCPSolution, Ray
from signorini.lcp.solve import solve
from signorini.lcp.status import Status

__all__ = [
    "LCP",
    "LCPSolution",
    "Lemke",
    "Method",
    "Ray",
    "Residual",
    "Status",
    "natural_residual",
    "solve",
]
