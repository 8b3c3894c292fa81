# SPDX-License-Identifier: BSD-3-Clause
"""What the plane alone has: covering paths, walls between states, the tree of states."""
