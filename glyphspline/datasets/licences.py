"""The licence of a font as an SPDX identifier, guessed from what its name table says."""

from __future__ import annotations

import re

UNKNOWN = "unknown"
"""Of a font that says nothing, or nothing that is known here."""

GNU = r"(?:\bGNU\b|General Public Licen[sc]e|\bGPL)"

PATTERNS = (
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

COMPILED = [(name, re.compile(pattern, re.IGNORECASE | re.DOTALL)) for name, pattern in PATTERNS]

LATER = re.compile(r"any later version|or later|\(at your option\)", re.IGNORECASE)
EXCEPTION = re.compile(r"font exception|embedd?|document.{0,80}font", re.IGNORECASE | re.DOTALL)


def licence_of(*texts: str | None) -> str:
    """The licence that the first of these texts names, or "unknown".

    Args:
        texts: such as the licence, its address and the copyright notice of a font; None where it has none.
    """
    for text in texts:
        known = [name for name, pattern in COMPILED if text and pattern.search(text)]
        if text and known:
            gnu = next((_whole(name, text) for name in known if name.startswith(("GPL", "LGPL", "AGPL"))), None)
            if gnu is None or not known[0].startswith(("OFL", "GPL", "LGPL", "AGPL")):
                return known[0]
            return f"{known[0]} OR {gnu}" if known[0].startswith("OFL") else gnu
    return UNKNOWN


def _whole(name: str, text: str) -> str:
    """A licence of GNU with what is added to it."""
    if not name.endswith("later"):
        name += "-or-later" if LATER.search(text) else "-only"
    return f"{name} WITH Font-exception-2.0" if name.startswith("GPL") and EXCEPTION.search(text) else name
