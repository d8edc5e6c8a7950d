"""The characters of Figs. 8 and 9, in faces that stand for the paper's, and where polygons are kept."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from glyphspline.plugins.experiments.polygons import read_clicked
from glyphspline.types import FloatArray

DATA = Path(__file__).parent / "data"
FONTS = Path(__file__).parents[2] / "fonts_test"


@dataclass(frozen=True)
class Character:
    """A character of the paper, in the face that stands for the paper's.

    Attributes:
        name: of the figure. family: of the paper's face, as files of it are called. theirs: its name.
        stem: of the file in ``fonts_test``, and of the clicked points beside it.
    """

    name: str
    source: str
    character: str
    stem: str
    family: str
    theirs: str

    def polygons(self) -> list[FloatArray]:
        """The clicked points."""
        return read_clicked(FONTS / f"{self.stem}.csv")[self.character]


CHARACTERS = (
    Character("fig-8", "Fig. 8", "龍", "kouzan-gyosho", "STXingkai", "Huawen Xingkai"),
    Character("fig-9", "Fig. 9", "好", "kouzan-kaisho", "STLiti", "Huawen Lishu"),
)
"""Those of Figs. 8 and 9."""
