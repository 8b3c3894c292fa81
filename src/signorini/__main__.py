# SPDX-License-Identifier: BSD-3-Clause
"""``python -m signorini``."""

import sys

from signorini.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
