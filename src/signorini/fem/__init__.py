# SPDX-License-Identifier: BSD-3-Clause
"""Finite elements, and the only place that knows scikit-fem: meshes, elements, assembly, supports, loads, stress."""
