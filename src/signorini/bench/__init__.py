# SPDX-License-Identifier: BSD-3-Clause
"""Measurements that can be run again."""
