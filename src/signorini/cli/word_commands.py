# SPDX-License-Identifier: BSD-3-Clause
"""``signorini schema`` and ``explain``: what decks may hold and results say, for editors and for people."""

from __future__ import annotations

import argparse
import json
import textwrap

from signorini.cli.exit_codes import EXIT_CODES
from signorini.deck.schema import deck_schema, meanings
from signorini.errors import InputError, one_of
from signorini.outcome import Outcome
from signorini.report.words import MEANINGS

_WIDTH = 100  # letters of a line


def schema(options: argparse.Namespace) -> int:
    """Print the JSON schema of TOML decks."""
    del options
    print(json.dumps(deck_schema(), indent=1))
    return 0


def explain(options: argparse.Namespace) -> int:
    """Print what a key of decks, all keys of a table, a status, an exit code or a number of certificates means."""
    keys, word = meanings(), options.word
    found = [(key, *keys[key]) for key in keys if word in (key, key.rsplit(".", 1)[-1])]
    found += [(f"status {word}", Outcome(word).advice, "")] if word in set(Outcome) else []
    codes = {str(code): words for code, words in EXIT_CODES.items()}
    found += [(f"exit code {word}", codes[word], "")] if word in codes else []
    found += [(f"certificate, {word}", MEANINGS[word], "")] if word in MEANINGS else []
    found += [(key, *keys[key]) for key in keys if key.rpartition(".")[0] == word]
    if not found:
        known = [*keys, *{key.rsplit(".", 1)[-1] for key in keys}, *Outcome, *codes, *MEANINGS]
        raise InputError(one_of(word, sorted(known), "key or code").partition(" Known:")[0], where=("explain",))
    for name, words, default in found:
        print(name + (f" (default {default})" if default else ""))
        print(textwrap.fill(words, _WIDTH, initial_indent="  ", subsequent_indent="  "))
    return 0
