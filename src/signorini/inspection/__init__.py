# SPDX-License-Identifier: BSD-3-Clause
"""A model as it was understood, in words and as data, and what looks wrong; solves nothing."""
