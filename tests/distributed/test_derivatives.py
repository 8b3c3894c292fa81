"""Derivatives of histories on ranks are those of one process, wherever bodies and displacements are."""

import json

import pytest

from tests.distributed.test_on_ranks import on_ranks, with_ranks
from tests.helpers.derivatives_on_ranks import MODELS

APART = 1e-8  # stiffness, loads and stresses change by differences over 1e-5 of what is given


@with_ranks
@pytest.mark.slow
@pytest.mark.parametrize("number", [2, 3])
def test_derivatives_are_those_of_one_process(number):
    """Of pressures, displacements and stresses, by friction, materials, loads, and places of nodes."""
    done = on_ranks(number, "-m", "tests.helpers.derivatives_on_ranks")
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    assert answers.keys() == MODELS.keys()
    apart = {(name, what): size for name, found in answers.items() for what, size in found.items()}
    assert {key: size for key, size in apart.items() if not size <= APART} == {}
