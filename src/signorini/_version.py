# SPDX-License-Identifier: BSD-3-Clause
"""The version, in one place: read by the build, by ``signorini.__version__`` and by every summary."""

__version__ = "0.1.0"
