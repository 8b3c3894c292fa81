# SPDX-License-Identifier: BSD-3-Clause
"""Bodies cut among the ranks of MPI, and contact iterated on them by PETSc; nothing of either is imported unasked."""
