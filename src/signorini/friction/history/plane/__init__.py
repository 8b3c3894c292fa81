# SPDX-License-Identifier: BSD-3-Clause
"""Histories in the plane: from event to event by the inverse of a state that is changed pair by pair."""
