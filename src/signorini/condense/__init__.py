# SPDX-License-Identifier: BSD-3-Clause
"""From stiffness, loads and interface to the condensed interface, at the price of one factorisation."""
