"""Variable fonts, designspaces and Glyphs files: all masters of a glyph as one curve.

Needs checks and fonts. In: masters; out: results in all masters, variable fonts. Read first: :mod:`.convert_masters`.
"""

from __future__ import annotations

from ...hooks import Plugin

PLUGIN = Plugin(
    readers={"designspaces": ".designspace:READER", "glyphs": ".glyphs_file:READER"},
    services={
        "axis_pages": ".axis_pages:axis_pages",
        "check_axis": ".convert_masters:check_axis",
        "convert_masters": ".convert_masters:convert_masters",
        "fit_masters": ".job:convert_font_masters",
        "kink_report": ".kinks:kink_report",
        "no_joints": ".kinks:no_joints",
        "on_axes": ".on_axes:on_axes",
        "refit_masters": ".job:refit_masters",
        "turns_figure": ".axis_pages:turns_figure",
        "variations": ".variations:Variations",
    },
    work={"masters": ".work:masters", "axes": ".work:axes"},
)
