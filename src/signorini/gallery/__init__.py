# SPDX-License-Identifier: BSD-3-Clause
"""Ready problems: the paper's cylinder, patch tests, press fit, sliding block, two-body Hertz contact."""
