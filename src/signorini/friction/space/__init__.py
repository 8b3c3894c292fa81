# SPDX-License-Identifier: BSD-3-Clause
"""What space alone has: sweeps, proximal steps, overloads."""
