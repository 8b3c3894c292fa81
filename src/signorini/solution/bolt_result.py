# SPDX-License-Identifier: BSD-3-Clause
"""What a bolt bears at the end of a step."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class BoltResult:
    """A bolt at the end of a step.

    Attributes
    ----------
    force : in it, tension > 0
    shortening : by which the halves of its section overlap, length
    """

    force: float
    shortening: float
