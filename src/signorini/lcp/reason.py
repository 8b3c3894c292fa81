# SPDX-License-Identifier: BSD-3-Clause
"""Why a walk along Lemke's path returned; numbers, since compiled code says them."""

MORE, SOLVED, RAY, DOUBT = range(4)
"""The block of pivots is full; theta left; nothing blocks; theta is tied within rounding, to be judged outside."""
