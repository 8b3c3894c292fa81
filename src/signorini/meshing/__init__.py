# SPDX-License-Identifier: BSD-3-Clause
"""Making and reading meshes; knows nothing of finite elements."""
