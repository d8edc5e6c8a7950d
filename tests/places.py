"""Folders that tests read."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
FONTS = ROOT / "fonts_test"
GYOSHO = FONTS / "kouzan-gyosho.ttf"
