"""What an output lacks: what halving the facets that touch changes, and what stresses tell of the rest."""

import numpy as np
import pytest

from signorini.accuracy.output_error import OutputLevel, output_error


@pytest.mark.parametrize("power", [1, 2])
def test_errors_that_fall_with_the_length_of_facets_or_its_square(power):
    """With friction, whose history remembers where contacts have ended between nodes, and without."""
    level = OutputLevel(value=1.0 - 0.01, nodes=900, signed=0.0, halved=1.0 - 0.01 * 0.5**power)
    assert 0.7 <= output_error([level]) / 0.01 <= 2.0


def test_what_stresses_lack_is_added():
    """A displacement, whose error is that of the bodies: facets alone would tell a tenth of it."""
    level = OutputLevel(value=0.99, nodes=900, signed=-0.01, halved=0.99 + 5e-4)
    assert output_error([level]) == pytest.approx(0.01075)


def test_meshes_before_tell_where_no_facets_were_halved():
    """The change over two meshes counts where the last one is small by luck."""
    known = [OutputLevel(value=v, nodes=n, signed=0.0) for v, n in ((0.7, 100), (0.9, 400), (0.89, 1600))]
    assert output_error(known) == pytest.approx(0.19 / 4.0)
    assert output_error([*known[:2], OutputLevel(value=0.89, nodes=1600, signed=0.1)]) == 0.1


def test_nothing_is_known_of_one_mesh_whose_facets_were_not_halved():
    unknown = OutputLevel(value=float("nan"), nodes=100, signed=0.0)
    alone = OutputLevel(value=1.0, nodes=300, signed=0.0)
    for levels in ([], [unknown], [alone], [unknown, alone]):
        assert output_error(levels) == np.inf
