# SPDX-License-Identifier: BSD-3-Clause
"""Natural frequencies of bodies whose joints are stuck, slip or are open, and what a joint damps."""
