# SPDX-License-Identifier: BSD-3-Clause
"""Strategy: what does not depend on the loads, then step after step and increment after increment."""
