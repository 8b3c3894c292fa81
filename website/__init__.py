# SPDX-License-Identifier: BSD-3-Clause
"""The site: pages of docs/ behind the README, and an API reference; ``python -m website FOLDER`` builds it."""
