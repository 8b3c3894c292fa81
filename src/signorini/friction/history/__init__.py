# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb histories: what is followed along a load, in the plane and in space."""
