"""Convert many fonts: ``python scripts/batch_convert.py FONT|FOLDER|GLOB|@LIST … --out DIR [options]``.

The same as ``glyphspline convert --each``: each font gets a folder of its own, be it one or many.
"""

from __future__ import annotations

import sys

from glyphspline.cli import main

if __name__ == "__main__":
    sys.argv[1:1] = ["convert", "--each"]
    main()
