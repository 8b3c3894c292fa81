# SPDX-License-Identifier: BSD-3-Clause
"""Models, problems and references that several tests use."""
