# SPDX-License-Identifier: BSD-3-Clause
"""Models and results as HTML: cards in a notebook, and a report in one file. Asks no other host for anything."""
