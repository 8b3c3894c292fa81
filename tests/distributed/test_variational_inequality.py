# SPDX-License-Identifier: BSD-3-Clause
"""Contact without friction is the variational inequality that PETSc solves by itself on the same matrix."""

import pytest

from tests.distributed.test_on_ranks import with_petsc


@with_petsc
@pytest.mark.slow
def test_both_ways_have_the_answer_of_factorised_bodies():
    from benchmarks.variational_inequality import rows_of

    multipliers, inequality = rows_of(2)
    for row in (multipliers, inequality):
        assert float(row[-1]) <= 1e-8
    assert inequality[3] <= multipliers[3]
