# SPDX-License-Identifier: BSD-3-Clause
"""What was found: states, fields, resultants, energies and the certificate."""
