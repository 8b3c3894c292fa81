# SPDX-License-Identifier: BSD-3-Clause
"""Decks of Abaqus and CalculiX: keywords and their data first, then what they mean.

Every reader raises a `DeckError` with file and line where a keyword is malformed, names what is not there or is there
twice, or would change the answer and is not supported.
"""
