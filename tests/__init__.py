# SPDX-License-Identifier: BSD-3-Clause
"""The tests: a folder for every room of the package, and `helpers` that several of them use."""
