# SPDX-License-Identifier: BSD-3-Clause
"""Who can touch whom: pairs, frames, gaps and areas, as one object for all contacts of a model."""
