# SPDX-License-Identifier: BSD-3-Clause
"""Decks of Abaqus and CalculiX: keywords and their data first, then what they mean."""
