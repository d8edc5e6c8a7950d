"""``python -m glyphspline``: the same as the command ``glyphspline``."""

from .cli import main

if __name__ == "__main__":
    main()
