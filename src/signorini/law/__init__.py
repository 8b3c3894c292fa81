# SPDX-License-Identifier: BSD-3-Clause
"""The law of a contact pair: its states and the largest friction that it carries."""
