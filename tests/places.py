"""Folders and fonts that tests read."""

from pathlib import Path

import matplotlib

ROOT = Path(__file__).parents[1]
FONTS = ROOT / "fonts_test"
GYOSHO = FONTS / "kouzan-gyosho.ttf"
DEJAVU = Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf"

FACES: list[tuple[str | Path, int, dict[str, float]]] = [
    ("kouzan-gyosho.ttf", 0, {}),
    ("kouzan-gyosho.otf", 0, {}),
    ("kouzan-gyosho.woff2", 0, {}),
    ("kouzan-kaisho.ttf", 0, {}),
    ("kouzan.ttc", 0, {}),
    ("kouzan.ttc", 1, {}),
    ("edge-cases.ttf", 0, {}),
    ("variable.ttf", 0, {}),
    ("variable.ttf", 0, {"wght": 650}),
    ("variable.ttf", 0, {"wght": 900}),
    ("variable-cff2.otf", 0, {}),
    ("variable-cff2.otf", 0, {"wght": 777, "wdth": 90}),
    ("variable-cff2.otf", 0, {"wght": 400, "wdth": 75}),
    (DEJAVU, 0, {}),
]
"""File, face index and location: every kind of font that is in the tree, and a large one."""
