"""Convert many fonts: ``python scripts/batch_convert.py FONT|FOLDER|GLOB|@LIST … --out DIR [options]``.

The same as ``glyphspline convert``: of several fonts, or of a folder, a glob or a list, each gets a folder of its own.
"""

from __future__ import annotations

import sys

from glyphspline.cli import main

if __name__ == "__main__":
    sys.argv[1:1] = ["convert"]
    main()
