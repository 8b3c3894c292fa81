# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield: what their points remember and answer, and how it is measured."""
