# SPDX-License-Identifier: BSD-3-Clause
"""The verification suite: computed values beside closed forms and references, as a table."""
