# SPDX-License-Identifier: BSD-3-Clause
"""Doors upstairs: what data can be asked for that rooms above it do, which are imported when somebody asks."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

DOORS = {"card": "signorini.report.cards", "draw_model": "signorini.plot.model"}
"""Function to the module that has it."""


def door(name: str) -> Callable[..., Any]:
    """A function of `DOORS`."""
    found: Callable[..., Any] = getattr(importlib.import_module(DOORS[name]), name)
    return found
