# SPDX-License-Identifier: BSD-3-Clause
"""Solutions as files and as text."""
