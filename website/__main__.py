# SPDX-License-Identifier: BSD-3-Clause
"""Build the site into a folder: ``python -m website FOLDER`` (by default ``out/site``), then open its index.html."""

import sys
from pathlib import Path

from website.build import build

target = Path(sys.argv[1] if len(sys.argv) > 1 else "out/site")
build(target)
print(f"{target / 'index.html'}: {sum(1 for _ in target.rglob('*.html'))} pages")
