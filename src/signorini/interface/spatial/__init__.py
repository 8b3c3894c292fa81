# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in space: mortar coupling of faces that need not match, node pairs, nodes on faces, frames."""
