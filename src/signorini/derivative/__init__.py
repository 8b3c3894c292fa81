# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of the answers of a history by what is given, exactly and through all of its events."""
