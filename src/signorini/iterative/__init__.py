# SPDX-License-Identifier: BSD-3-Clause
"""Contact without a factor: multipliers, semismooth Newton, conjugate gradients and multigrid."""
