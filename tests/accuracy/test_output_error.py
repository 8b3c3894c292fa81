"""What an output lacks: what halving the facets that touch has changed, and what stresses tell of the rest."""

import numpy as np
import pytest

from signorini.accuracy.output_error import OutputLevel, output_error


def falling(power, levels, error=0.01, signed=0.0):
    """Of an output 1 whose error falls with a power of the length of facets, a fourth as long from mesh to mesh."""
    found = []
    for k in range(levels):
        left = error * 4.0 ** (-power * k)
        found.append(OutputLevel(value=1.0 - left, whole=1.0 - left * 2.0**power, length=4.0**-k, signed=signed))
    return found, left


@pytest.mark.parametrize(("power", "most"), [(1, 1.0), (2, 1.35)])
def test_errors_that_fall_with_the_length_of_facets_or_its_square(power, most):
    """With friction, whose history remembers where contacts have ended between nodes, and without."""
    levels, left = falling(power, 2)
    assert 1.0 - 1e-12 <= output_error(levels) / left <= most + 1e-12


def test_one_mesh_does_not_tell_how_fast_errors_fall():
    """All that halving has changed may be left."""
    for power in (1, 2):
        (level,), _ = falling(power, 1)
        assert output_error([level]) == pytest.approx(abs(level.value - level.whole))


def test_what_stresses_lack_is_added():
    """A displacement, whose error is that of the bodies: facets alone would tell a tenth of it."""
    level = OutputLevel(value=0.99, whole=0.989, length=1.0, signed=-0.01)
    assert output_error([level]) == pytest.approx(0.011)


def test_a_change_that_is_small_by_luck_is_not_believed():
    """The output has changed by a tenth since the mesh before: no error falls faster than with the fourth power."""
    before = OutputLevel(value=0.9, whole=0.7, length=1.0, signed=0.0)
    for finer in (1.2, 2.0, 3.0):
        lucky = OutputLevel(value=1.0, whole=1.0, length=1.0 / finer, signed=0.0)
        assert output_error([before, lucky]) == pytest.approx(0.1 / (max(finer, 2.0) ** 4 - 1.0))


def test_nothing_is_known_where_no_facets_were_halved():
    unknown = OutputLevel(value=float("nan"), whole=float("nan"), length=1.0, signed=0.0)
    alone = OutputLevel(value=1.0, whole=float("nan"), length=0.5, signed=0.0)
    for levels in ([unknown], [alone], [unknown, alone]):
        assert output_error(levels) == np.inf
