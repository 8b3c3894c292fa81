# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of solutions, as Matplotlib figures that belong to nobody but the caller."""
