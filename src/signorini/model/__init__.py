# SPDX-License-Identifier: BSD-3-Clause
"""The problem in the user's words: frozen data, checked when made, no numerics."""
