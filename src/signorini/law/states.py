# SPDX-License-Identifier: BSD-3-Clause
"""Codes of the state of a contact pair, known to the law of contact and to its results alike."""

from __future__ import annotations

OPEN, STICK, SLIP_PLUS, SLIP_MINUS = 0, 1, 2, 3
"""Open; closed without slip; slipping with friction along +t; slipping with friction along -t."""

UNDECIDED = -1
"""A state that the solution decides."""

SLIP = SLIP_PLUS
"""Closed and slipping: in space the direction is that of the tangential force."""
