# SPDX-License-Identifier: BSD-3-Clause
"""An accuracy instead of a mesh: what an answer lacks, and meshes that are refined until it is little enough."""
