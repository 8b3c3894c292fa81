# SPDX-License-Identifier: BSD-3-Clause
"""The walk of the plainest deck through the house: it enters no room of what it does not use."""

from pathlib import Path

import pytest

import signorini
from benchmarks import walk

ROOT = Path(signorini.__file__).parent
MOST_FILES = 137  # that a newcomer reads from a deck to its answer, archive and loops not yet compiled included

# what the paper's cylinder has not, and the folders and files that are there for it alone
FEATURES = {
    "bolts": ["engine/bolts", "meshing/cut", "meshing/halves", "model/bolt"],
    "cyclic symmetry": ["fem/cyclic", "fem/neighbours", "interface/sectors"],
    "equations and rigid bodies": ["fem/links"],
    "elastic foundations": ["fem/foundation"],
    "obstacles that move": ["fem/obstacles", "model/rigid"],
    "bodies that turn": ["fem/turning_bodies", "fem/body_frames", "engine/turning"],
    "contacts that slide far": ["interface/sliding", "engine/sliding", "engine/handing_over", "engine/stride_pairs"],
    "closures": ["law/closure", "engine/closure_solver", "engine/closure_paths"],
    "bonds": ["law/cohesion", "engine/bond_rates", "engine/bond_paths", "engine/bond_company"],
    "wear": ["interface/worn_sides", "engine/wear_steps", "model/wear", "solution/wear_state"],
    "bodies that yield": [
        "plasticity",
        "engine/plastic_solver",
        "engine/plastic_rounds",
        "engine/tangent_bodies",
        "model/plastic",
    ],
    "temperatures": ["fem/thermal"],
    "natural modes": ["vibration", "fem/mass", "linalg/inertia", "model/modes"],
    "values that vary": ["model/varying", "deck/varying", "deck/nodal_forces", "fem/varying", "engine/overlaps"],
    "tied sides": ["condense/ties"],
    "steps that change contacts or supports": ["engine/contact_changes", "engine/support_changes"],
    "fields between the ends of steps": ["output/series"],
    "a deck of keywords": ["deck/inp"],
    "a third dimension": ["friction/space", "friction/history/space"],
    "an exact path": ["friction/history", "engine/path_states"],
    "bodies too large to condense": ["iterative", "engine/multipliers"],
}


@pytest.fixture(scope="module")
def visited():
    return walk.visited(walk.EXAMPLE)


@pytest.mark.parametrize("feature", FEATURES)
def test_the_plainest_deck_does_not_enter_what_it_does_not_use(visited, feature):
    entered = [
        f"{file}.py ({', '.join(names)})"
        for file, names in visited.items()
        if any(f"{file}/".startswith(f"{place}/") for place in FEATURES[feature])
    ]
    assert not entered, (
        f"{walk.EXAMPLE.name} has no {feature}, but visits {'; '.join(entered)}: ask whether there are any before"
    )


def test_the_walk_is_short(visited):
    assert len(visited) <= MOST_FILES, (
        f"{walk.EXAMPLE.name} visits {len(visited)} files, expected at most {MOST_FILES}; see which are new by "
        "`python -m benchmarks.walk --chain`, and enter those of a feature only where it is used"
    )


def test_features_are_where_the_walk_looks_for_them():
    known = {path.relative_to(ROOT).with_suffix("").as_posix() for path in ROOT.rglob("*.py")}
    known |= {path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*") if path.is_dir()}
    assert not {place for places in FEATURES.values() for place in places} - known
