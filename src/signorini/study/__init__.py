# SPDX-License-Identifier: BSD-3-Clause
"""Parameter studies: one problem with many values of what is given, a row of a table for each combination."""
