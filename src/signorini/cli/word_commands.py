# SPDX-License-Identifier: BSD-3-Clause
"""``signorini schema`` and ``explain``: what decks may hold and results say, for editors and for people."""

from __future__ import annotations

import argparse
import json
import textwrap

from signorini.deck.schema import deck_schema, meanings
from signorini.errors import InputError, one_of
from signorini.outcome import Outcome
from signorini.report.words import MEANINGS

_WIDTH = 100  # letters of a line

EXIT_CODES = {
    "0": "Done; of a run: solved, and certified.",
    "1": "A check failed (verify, diff), an internal error, a disk that is full, or memory that ran out.",
    "2": "The input is wrong: the message says where, what was found and what is expected.",
    "3": "No certified solution: the status and message in summary.json say why; what was solved before is written.",
    "130": "Interrupted, by Ctrl-C or SIGTERM: the finished steps are written, and --from goes on from them.",
}


def schema(options: argparse.Namespace) -> int:
    """Print the JSON schema of TOML decks."""
    del options
    print(json.dumps(deck_schema(), indent=1))
    return 0


def explain(options: argparse.Namespace) -> int:
    """Print what a key of decks, a status, an exit code or a number of certificates means."""
    keys, word = meanings(), options.word
    found = [(key, *keys[key]) for key in keys if word in (key, key.rsplit(".", 1)[-1])]
    found += [(f"status {word}", Outcome(word).advice, "")] if word in set(Outcome) else []
    found += [(f"exit code {word}", EXIT_CODES[word], "")] if word in EXIT_CODES else []
    found += [(f"certificate, {word}", MEANINGS[word], "")] if word in MEANINGS else []
    if not found:
        known = [*keys, *{key.rsplit(".", 1)[-1] for key in keys}, *Outcome, *EXIT_CODES, *MEANINGS]
        raise InputError(one_of(word, sorted(known), "key or code").partition(" Known:")[0], where=("explain",))
    for name, words, default in found:
        print(name + (f" (default {default})" if default else ""))
        print(textwrap.fill(words, _WIDTH, initial_indent="  ", subsequent_indent="  "))
    return 0
