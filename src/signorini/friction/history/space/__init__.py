# SPDX-License-Identifier: BSD-3-Clause
"""Histories in space: increments that end at events, rates where they fail."""
