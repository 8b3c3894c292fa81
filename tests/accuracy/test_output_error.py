"""What an output lacks: outputs that converge in known ways, and what stresses tell of them."""

import numpy as np
import pytest

from signorini.accuracy.output_error import OutputLevel, output_error


def levels(errors, signed=None, products=None, nodes=(100, 300, 900, 2700, 8100)):
    """Meshes with an output of 1 and given errors."""
    told = zip(errors, nodes, signed or [0.0] * 5, products or [0.0] * 5, strict=False)
    return [OutputLevel(value=1.0 - e, nodes=n, signed=s, products=p) for e, n, s, p in told]


@pytest.mark.parametrize("power", [0.7, 1.0, 1.5])
def test_errors_of_one_sign_that_fall_by_a_power_of_the_nodes(power):
    errors = [0.1 * 3.0 ** (-power * i) for i in range(4)]
    assert 0.7 <= output_error(levels(errors)) / errors[-1] <= 5.0


def test_what_stresses_lack_with_signs_is_believed_where_it_told_the_changes():
    """Half of what is true, again and again; changes alone would say nine times as much."""
    errors = [0.1, 0.02, -0.003, 0.0006, -0.0001]
    told = levels(errors, signed=[0.5 * e for e in errors], products=[abs(e) for e in errors])
    assert 0.7 <= output_error(told) / abs(errors[-1]) <= 5.0
    assert output_error(levels(errors)) > 9.0 * abs(errors[-1])


def test_changes_that_fall_fast_are_believed_the_second_time():
    """The peak between two cylinders: changes fall tenfold and more while nodes grow threefold."""
    errors, nodes = [0.19, 7.8e-3, 6.1e-4, 4.8e-5, -5.1e-6], (422, 1325, 4574, 13576, 40941)
    assert output_error(levels(errors[:4], nodes=nodes)) > 10.0 * errors[3]  # the first mesh was given
    assert 1.0 <= output_error(levels(errors, nodes=nodes)) / 5.1e-6 <= 10.0


def test_a_fall_that_was_slow_before_or_turns_is_not_believed():
    """The change over two meshes counts, by the root of their nodes."""
    nodes = (422, 1325, 4574, 13576, 40941)
    for errors in ([0.19, 7.8e-3, 4.8e-3, 2.5e-3, 2.4e-3], [0.19, 7.8e-3, 6.1e-4, 4.8e-5, 1.2e-4]):
        told = abs(errors[4] - errors[2]) * (nodes[2] / nodes[4]) ** 0.5
        assert output_error(levels(errors, nodes=nodes)) == pytest.approx(told)


def test_a_last_change_that_is_too_small_counts_as_the_fall_before_it():
    """It falls a thousandfold by luck after it has fallen by a part of 0.06."""
    errors = [0.2, 0.1, 6.0e-3, 3.0e-4, 2.94e-4]
    assert output_error(levels(errors)) > 1.5e-4


def test_luck_on_the_last_mesh_is_not_believed():
    """The friction of the paper's cylinder: two meshes agree to a thousandth, and are a hundredth away from the truth.

    What stresses say there is a tenth of the changes, or of the other sign.
    """
    errors = [-7.0e-2, 2.2e-2, -1.2e-2, -1.1e-2]
    told = levels(errors, [3.2e-1, 5.5e-2, 6.6e-3, -3.1e-4], [1.1, 2.8e-1, 1.4e-2, 8.9e-4])
    assert 0.7 <= output_error(told) / 1.1e-2 <= 5.0


def test_nothing_is_known_of_one_mesh():
    unknown = OutputLevel(value=float("nan"), nodes=100, signed=0.0, products=0.0)
    assert output_error(levels([0.1])) == np.inf
    assert output_error([unknown, *levels([0.1])]) == np.inf
