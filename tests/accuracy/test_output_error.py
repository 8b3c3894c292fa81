"""What an output lacks: what halving the facets that touch has changed, and what stresses tell of the rest."""

import numpy as np
import pytest

from signorini.accuracy.output_error import OutputLevel, output_error


def falling(power, error=0.01):
    """On two meshes an output 1 whose error falls with a power of the length of facets, to a fourth; what is left."""
    found = []
    for length in (1.0, 0.25):
        left = error * length**power
        found.append(OutputLevel(value=1.0 - left, whole=1.0 - left * 2.0**power, length=length, signed=0.0))
    return found, left


@pytest.mark.parametrize("power", [1, 2])
def test_errors_that_fall_with_the_length_of_facets_or_its_square(power):
    """With friction, whose history remembers where contacts have ended between nodes, and without."""
    levels, left = falling(power)
    assert 1.0 <= output_error(levels) / left <= 1.3


def test_one_mesh_does_not_tell_how_fast_errors_fall():
    """All that halving has changed may be left."""
    for power in (1, 2):
        level = falling(power)[0][0]
        assert output_error([level]) == pytest.approx(abs(level.value - level.whole))


@pytest.mark.parametrize(("signed", "lacks"), [(0.01, 0.011), (-0.01, 0.009), (-0.001, 0.001)])
def test_what_stresses_lack_is_added_with_its_sign(signed, lacks):
    """Of what cancels no less than half of the sum is believed to be left."""
    level = OutputLevel(value=0.99, whole=0.989, length=1.0, signed=signed)
    assert output_error([level]) == pytest.approx(lacks)


def test_a_change_that_is_small_by_luck_is_not_believed():
    """The output has changed by a tenth since the mesh before, whose facets were twice as long at least."""
    before = OutputLevel(value=0.9, whole=0.7, length=1.0, signed=0.0)
    for finer in (1.2, 2.0, 3.0):
        lucky = OutputLevel(value=1.0, whole=1.0, length=1.0 / finer, signed=0.0)
        assert output_error([before, lucky]) == pytest.approx(0.1 / (max(finer, 2.0) ** 4.5 - 1.0))


def test_nothing_is_known_where_no_facets_were_halved():
    unknown = OutputLevel(value=float("nan"), whole=float("nan"), length=1.0, signed=0.0)
    alone = OutputLevel(value=1.0, whole=float("nan"), length=0.5, signed=0.0)
    for levels in ([unknown], [alone], [unknown, alone]):
        assert output_error(levels) == np.inf
