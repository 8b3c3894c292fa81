# SPDX-License-Identifier: BSD-3-Clause
"""Closed forms to compare with, each with its limits of validity."""
