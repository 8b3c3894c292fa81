"""What ends meshes that get finer: the memory that the next one is expected to take."""

import signorini as sg
from signorini.accuracy import bounds


def test_memory_grows_with_the_stiffness_where_nothing_is_factorised(monkeypatch):
    """From 1 to 2 GB, and ten times the nodes: 10^1.1 GB more, as a factor in space 10^1.4."""
    monkeypatch.setattr(bounds, "peak_memory", lambda: 1e9)
    asked = bounds.Bounds(sg.Accuracy(0.01, nodes=10**6, memory=1.3e10), 3)
    monkeypatch.setattr(bounds, "peak_memory", lambda: 2e9)
    told = [asked.end(10_000, 100_000, 3, iterated=iterated) for iterated in (True, False)]
    words = "the next mesh has 100000 nodes, with which {} GB of memory are expected, more than 13 GB"
    assert told == [words.format("13.6"), words.format("26.1")]
