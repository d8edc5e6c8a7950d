# /// script
# requires-python = ">=3.11"
# dependencies = ["glyphspline[sources]"]
# ///
"""What would be mended in fonts and sources, as a table in Markdown: ``uv run mend.py Mine.designspace Mine.ttf``."""

import sys

import glyphspline as gs

KINDS = ["kink", "slanted", "unlevel"]

print("| file | glyph | finding | contour | before | points move by | |")
print("|---|---|---|---:|---:|---:|---|")
for path in sys.argv[1:]:
    source = gs.open_source(path)
    for name in source.glyph_names:
        try:
            _, changes = gs.mend(source.masters(name), KINDS, outer=source.outer)
        except gs.GlyphsplineError as error:
            print(error, file=sys.stderr)
            continue
        for change in changes:
            what = path, name, change.kind, change.contour
            row = *what, f"{change.before:.3g}", f"{change.moved:.3g}", change.why or ""
            print("|", " | ".join(map(str, row)), "|")
