# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue of stress histories: criteria over all planes and of deviators, and lives."""

from __future__ import annotations

from signorini.fatigue.criteria import CRITERIA, SWT, Crossland, DangVan, FatemiSocie, Ruiz

__all__ = ["CRITERIA", "SWT", "Crossland", "DangVan", "FatemiSocie", "Ruiz"]
