# SPDX-License-Identifier: BSD-3-Clause
"""Sparse direct factorisation that condenses onto the contact interface."""

from signorini.linalg.protocol import Factorisation, NotPositiveDefinite
from signorini.linalg.registry import AUTOMATIC, BACKENDS, factorise

__all__ = ["AUTOMATIC", "BACKENDS", "Factorisation", "NotPositiveDefinite", "factorise"]
