"""Facts of fonts: names, metrics, licence, scripts, and how many of their glyphs a data set takes."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import GlyphsplineError
from ...readers.clusters import clusters, glyphs_of
from ...readers.selection import Characters
from ...runs.engine import Job, reason
from ...runs.schedule import Place
from .spec import DatasetSpec

if TYPE_CHECKING:
    from ...readers import Source

SPLITS = ("train", "validation", "test")
"""In the order in which rows are written."""


@dataclass(frozen=True)
class FontFacts:
    """One face of a font file at one location.

    Attributes:
        path: where it is; not written. file: its name without folders. face: its index in the file.
        at: axis tag and value for each axis, as ``location`` is; empty at the default. Not written.
        sha256: of the file. postscript_name, version: of the name table, as family and style; None where it is silent.
        weight_class, width_class: of OS/2, 400 and 5 being usual, or of the location on the axes wght and wdth.
        italic: whether the font says so.
        axes: of a variable font, as "wght=100:400:900" (least, default, most). location: as "wght=400,wdth=100".
        embedding: what OS/2 allows. licence: SPDX identifier, guessed. licence_text, licence_url: names 13 and 14.
        scripts: of its characters, by ISO 15924.
        coverage: share of the characters asked for that it has; None if none are.
        split: None of a font that is not taken.
        status: "taken", "left out" (by a filter), "duplicate" (of a file with the same bytes), or "failed".
        reason: why it is not taken. same_as: sha256 of the first font that is called and numbered the same, if the
            bytes differ; such a font is taken.
        taken: number of its glyphs that are asked for.
    """

    path: Path
    file: str
    face: int = 0
    at: tuple[tuple[str, float], ...] = ()
    sha256: str | None = None
    family: str | None = None
    style: str | None = None
    postscript_name: str | None = None
    version: str | None = None
    weight_class: int | None = None
    width_class: int | None = None
    italic: bool | None = None
    axes: tuple[str, ...] = ()
    location: str | None = None
    units_per_em: float | None = None
    ascender: float | None = None
    descender: float | None = None
    glyphs: int | None = None
    characters: int | None = None
    embedding: str | None = None
    licence: str | None = None
    licence_text: str | None = None
    licence_url: str | None = None
    scripts: tuple[str, ...] = ()
    coverage: float | None = None
    split: str | None = None
    status: str = "taken"
    reason: str | None = None
    same_as: str | None = None
    taken: int = 0

    @property
    def place(self) -> Place:
        """As a worker opens it."""
        return self.path, self.face, self.at

    @property
    def key(self) -> tuple[str, int, tuple[tuple[str, float], ...]]:
        """Hash of the file, face and location: the same for fonts with the same glyphs."""
        return self.sha256 or "", self.face, self.at


@dataclass(frozen=True)
class ScanJob(Job[Path, list[FontFacts]]):
    """The facts of all faces of font files. A file that cannot be read is a fact too."""

    spec: DatasetSpec

    chunk = 1
    chooses = False

    def together(self, tasks: Sequence[Path], contents: Sequence[Any]) -> list[FontFacts]:
        """The facts of some files."""
        return [facts for path in tasks for facts in _faces(path, self.spec)]

    def failed(self, task: Path, error: Exception) -> list[FontFacts]:
        """A file that cost a worker."""
        return [_unread(task, reason(error))]


def _unread(path: Path, reason: str, face: int = 0) -> FontFacts:
    return FontFacts(path, path.name, face, status="failed", reason=reason)


def _faces(path: Path, spec: DatasetSpec) -> Iterator[FontFacts]:
    from ...readers import open_source

    face, faces = 0, 1
    while face < faces:
        try:
            source = open_source(path, face)
            faces = source.num_faces
            yield from facts_of(source, spec)
        except GlyphsplineError as error:
            yield _unread(path, error.message, face)
        except Exception as error:  # broken tables raise any of a dozen types
            yield _unread(path, f"a broken font: {type(error).__name__}: {error}", face)
        face += 1


def facts_of(source: Source, spec: DatasetSpec) -> Iterator[FontFacts]:
    """The facts of an opened font, at each location where glyphs are taken."""
    from ...readers import Font
    from ...readers.open import reopened

    tables = source.tables() if isinstance(source, Font) else None
    shared = {"Zyyy", "Zinh", "Zzzz"}  # common, inherited and unknown
    facts = FontFacts(
        source.path.absolute(), source.path.name, source.face_index, sha256=source.sha256, family=source.family,
        style=source.style, axes=tuple(f"{a.tag}={a.minimum:g}:{a.default:g}:{a.maximum:g}" for a in source.axes),
        units_per_em=source.metrics.units_per_em, ascender=source.metrics.ascender,
        descender=source.metrics.descender, glyphs=len(source.glyph_names), characters=len(source.cmap),
        scripts=tuple(sorted({script_of(chr(code)) for code in source.cmap} - shared)),
        **{"licence": UNKNOWN} | _of_names(tables),
    )  # fmt: skip
    facts = chosen(facts, source, spec)
    default = {axis.tag: axis.default for axis in source.axes}
    named = source.instances if spec.instances == "named" else {}
    for style, location in (named or {source.style: default}).items():
        at = {**default, **location}
        place = ",".join(f"{tag}={value:g}" for tag, value in at.items()) or None
        taken = facts.taken
        if taken and at != default and (spec.characters or spec.scripts):  # other glyphs may show them there
            taken = len(selected(reopened(source.path, source.face_index, at), spec))
        yield replace(
            facts, style=style, location=place, at=() if at == default else tuple(at.items()), taken=taken,
            **_classes(tables, at),
        )  # fmt: skip


def chosen(facts: FontFacts, source: Source, spec: DatasetSpec) -> FontFacts:
    """The facts with what the filters say of the font: how many of its glyphs are taken, or why none are."""
    if asked := set(clusters(spec.characters)):
        there = [cluster for cluster in asked if not glyphs_of(source, cluster).missing]
        facts = replace(facts, coverage=len(there) / len(asked))
    if spec.licences and facts.licence not in spec.licences:
        return replace(facts, status="left out", reason=f"its licence is {facts.licence}")
    if facts.coverage is not None and facts.coverage < spec.coverage:
        return replace(facts, status="left out", reason=f"has {facts.coverage:.3g} of the characters")
    taken = len(selected(source, spec))
    if not taken:
        return replace(facts, status="left out", reason="has none of the glyphs")
    return replace(facts, taken=taken, split=split_of(source.family, spec))


def _of_names(tables: Any) -> dict[str, Any]:
    """What the table ``name`` says; nothing of a source without tables."""
    names = None if tables is None else tables.get("name")
    if names is None:
        return {}
    copyright, version, postscript_name, text, url = (
        _printable(names.getDebugName(number)) for number in (0, 5, 6, 13, 14)
    )
    return {
        "version": version, "postscript_name": postscript_name, "licence": licence_of(text, url, copyright),
        "licence_text": text and text[:500], "licence_url": url and url[:500],  # some have 40,000 characters
    }  # fmt: skip


def _classes(tables: Any, location: Mapping[str, float]) -> dict[str, Any]:
    """What the table ``OS/2`` says, or would say of the font at a location."""
    os2 = None if tables is None else tables.get("OS/2")
    if os2 is None:
        return {}
    if location:
        from fontTools.varLib import set_default_weight_width_slant

        set_default_weight_width_slant(tables, location)
    return {
        "weight_class": os2.usWeightClass,
        "width_class": os2.usWidthClass,
        "italic": bool(os2.fsSelection & 1) or location.get("ital", 0.0) > 0.0,
        "embedding": {0: "installable", 2: "restricted", 4: "preview and print", 8: "editable"}.get(os2.fsType & 15),
    }


def _printable(text: str | None) -> str | None:
    """A text of a font on one line, without characters that do something to a page or a terminal; None if empty."""
    return " ".join("".join(c if c.isprintable() else " " for c in text or "").split()) or None


def script_of(character: str) -> str:
    """The script of a character by ISO 15924."""
    from fontTools.unicodedata import script

    return str(script(character))


def selected(source: Source, spec: DatasetSpec) -> dict[int, str | None]:
    """The glyphs that are asked for by index, ascending, each with the character asked for, if it shows that alone.

    Without a filter they are all, those without a character too.
    """
    if not (spec.characters or spec.scripts):
        return dict.fromkeys(range(len(source.glyph_names)))
    asked = clusters(spec.characters) if spec.characters else map(chr, source.cmap)
    found = Characters(source, [c for c in dict.fromkeys(asked) if not spec.scripts or script_of(c[0]) in spec.scripts])
    alone = found.alone if spec.characters else {}
    gids = sorted(source.gids[name] for name in found.names)
    return {gid: alone.get(source.glyph_names[gid]) for gid in gids}


def split_of(family: str, spec: DatasetSpec) -> str:
    """The split of all fonts of a family: its name and the seed decide, whatever other fonts there are."""
    name = " ".join(unicodedata.normalize("NFKC", family).casefold().split())
    digest = blake2b(f"{spec.seed}:{name}".encode(), digest_size=8).digest()
    share = int.from_bytes(digest, "big") / 2**64
    if share < spec.test:
        return "test"
    return "validation" if share < spec.test + spec.validation else "train"


UNKNOWN = "unknown"
"""Of a font that says nothing, or nothing that is known here."""

GNU = r"(?:\bGNU\b|General Public Licen[sc]e|\bGPL)"

LICENCES = (
    ("OFL-1.0", r"Open Font Licen[sc]e,?\s*\(?(?:OFL\s*)?v(?:ersion)? ?1\.0"),
    ("OFL-1.1", r"Open Font Licen[sc]e|scripts\.sil\.org/OFL|openfontlicense\.org|\bOFL\b"),
    ("Apache-2.0", r"Apache Licen[sc]e|apache\.org/licenses/LICENSE-2"),
    ("Ubuntu-font-1.0", r"Ubuntu Font Licen[sc]e"),
    ("Bitstream-Vera", r"Bitstream Vera|dejavu[\w.-]*/(?:wiki/index\.php/)?License|dejavu-fonts\.org/wiki/License"),
    ("LicenseRef-Liberation-Font-License", r"Liberation Fonts? licen[sc]e|LiberationFontLicense"),
    ("IPA", r"IPA Font Licen[sc]e|ipa_font_license"),
    ("Arphic-1999", r"Arphic Public Licen[sc]e"),
    ("CC0-1.0", r"\bCC0\b|creativecommons\.org/publicdomain/zero"),
    ("CC-BY-SA-4.0", r"creativecommons\.org/licenses/by-sa/4\.0"),
    ("CC-BY-SA-3.0", r"creativecommons\.org/licenses/by-sa/3\.0"),
    ("CC-BY-4.0", r"creativecommons\.org/licenses/by/4\.0"),
    ("CC-BY-3.0", r"creativecommons\.org/licenses/by/3\.0"),
    ("AGPL-3.0", r"Affero|\bAGPL"),
    ("LGPL-3.0", r"(?:Lesser General Public|\bLGPL).{0,40}(?:version |v\.? ?|-)3"),
    ("LGPL-2.1", r"Lesser General Public|\bLGPL"),
    ("GPL-3.0", GNU + r".{0,80}?(?:version |v\.? ?|-)3|gnu\.org/licenses/gpl-3"),
    ("GPL-2.0", GNU + r".{0,80}?(?:version |v\.? ?|-)2|gnu\.org/licenses/(?:old-licenses/)?gpl-2"),
    ("GPL-1.0-or-later", GNU),
    ("LicenseRef-GUST-Font-License", r"GUST Font Licen[sc]e"),
    ("LicenseRef-public-domain", r"public domain"),
    ("mplus", r"\bM\+ FONTS\b.*unlimited permission|unlimited permission.*modification"),
    ("MIT", r"\bMIT Licen[sc]e|Permission is hereby granted, free of charge"),
)
"""Identifiers, and what says so; the first one counts. What is not on the list of SPDX begins with LicenseRef-."""


def licence_of(*texts: str | None) -> str:
    """The licence that the first of these texts names, or "unknown".

    Args:
        texts: such as the licence, its address and the copyright notice of a font; None where it has none.
    """
    for text in texts:
        known = [name for name, pattern in LICENCES if _says(pattern, text or "")]
        if text and known:
            gnu = next((_whole(name, text) for name in known if name.startswith(("GPL", "LGPL", "AGPL"))), None)
            if gnu is None or not known[0].startswith(("OFL", "GPL", "LGPL", "AGPL")):
                return known[0]
            return f"{known[0]} OR {gnu}" if known[0].startswith("OFL") else gnu
    return UNKNOWN


def _whole(name: str, text: str) -> str:
    """A licence of GNU with what is added to it."""
    if not name.endswith("later"):
        name += "-or-later" if _says(r"any later version|or later|\(at your option\)", text) else "-only"
    excepted = name.startswith("GPL") and _says(r"font exception|embedd?|document.{0,80}font", text)
    return f"{name} WITH Font-exception-2.0" if excepted else name


def _says(pattern: str, text: str) -> bool:
    return re.search(pattern, text, re.IGNORECASE | re.DOTALL) is not None
