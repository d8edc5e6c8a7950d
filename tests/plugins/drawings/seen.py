"""Small drawings of every kind that people give: what a browser shows of each, we draw, or say what we leave out.

``python -m scripts.drawings_seen`` draws all of them by Chromium and by us, and compares.
"""

from __future__ import annotations

from typing import NamedTuple

HEAD = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
BOX = 'viewBox="0 0 100 100"'


class Seen(NamedTuple):
    """A drawing.

    Attributes:
        text: inside the root, or the whole file if it begins as one. named: a part of what is said to be not read; ""
            if all of it is. root: attributes of the root.
    """

    text: str
    named: str = ""
    root: str = BOX

    @property
    def document(self) -> str:
        """The file."""
        return self.text if self.text.startswith(("<?", "<!")) else f"<svg {HEAD} {self.root}>{self.text}</svg>"


SQUARE = "M20 20H80V80H20Z"
HOLE = "M35 35H65V65H35Z"
STAR = "M50 5L79 95L3 40H97L21 95Z"

SEEN = {
    # Filling
    "even-odd attribute": Seen(f'<path fill-rule="evenodd" d="{SQUARE}{HOLE}"/>'),
    "even-odd style": Seen(f'<path style="fill-rule:evenodd" d="{SQUARE}{HOLE}"/>'),
    "even-odd inherited": Seen(f'<g fill-rule="evenodd"><path d="{SQUARE}{HOLE}"/></g>'),
    "even-odd star": Seen(f'<path fill-rule="evenodd" d="{STAR}"/>'),
    "even-odd crossing": Seen('<path fill-rule="evenodd" d="M10 10H60V60H10ZM40 40H90V90H40Z"/>'),
    "even-odd three deep": Seen(f'<path fill-rule="evenodd" d="M5 5H95V95H5Z{SQUARE}{HOLE}"/>'),
    "even-odd shared edge": Seen('<path fill-rule="evenodd" d="M10 10H50V90H10ZM50 10H90V90H50Z"/>'),
    "even-odd twice the same": Seen(f'<path fill-rule="evenodd" d="{SQUARE}{SQUARE}{HOLE}"/>'),
    "nonzero star": Seen(f'<path d="{STAR}"/>'),
    "nonzero hole": Seen(f'<path d="{SQUARE}M35 35V65H65V35Z"/>'),
    "nonzero no hole": Seen(f'<path d="{SQUARE}{HOLE}"/>'),
    "opposite shapes overlap": Seen('<path d="M10 10H60V60H10Z"/><path d="M40 40V90H90V40Z"/>'),
    "opposite shapes, one with a hole": Seen(f'<path d="{SQUARE}M35 35V65H65V35Z"/><path d="M40 10V90H60V10Z"/>'),
    "figure eight on a bar": Seen('<path d="M10 10L90 90V10L10 90Z"/><rect x="0" y="40" width="100" height="20"/>'),
    "even-odd beside nonzero": Seen(f'<path fill-rule="evenodd" d="{SQUARE}{HOLE}"/><circle cx="50" cy="50" r="10"/>'),
    "a shape twice": Seen('<rect width="50" height="50"/><rect width="50" height="50"/>'),
    "open paths are filled": Seen('<path d="M10 10H90V90"/><polyline points="10,90 40,90 40,60"/>'),
    # Style
    "css class none": Seen('<style>.a{fill:none}</style><rect class="a" width="100" height="100"/><rect width="40" height="40"/>'),  # noqa: E501
    "css id": Seen('<style>#a{display:none}</style><rect id="a" width="90" height="90"/><circle cx="50" cy="50" r="30"/>'),  # noqa: E501
    "css child and sibling": Seen('<style>g > rect + rect{fill:none}</style><g><rect width="30" height="30"/><rect x="50" width="50" height="50"/></g>'),  # noqa: E501
    "css nth-child": Seen('<style>rect:nth-child(2n){display:none}</style><rect width="30" height="30"/><rect x="40" width="30" height="30"/><rect x="70" y="50" width="30" height="30"/>'),  # noqa: E501
    "css attribute": Seen('<style>[data-k^="hi"]{visibility:hidden}</style><rect data-k="hide" width="90" height="90"/><circle r="40"/>'),  # noqa: E501
    "css not": Seen('<style>rect:not(.on){opacity:0}</style><rect width="90" height="90"/><rect class="on" width="30" height="60"/>'),  # noqa: E501
    "css is and where": Seen('<style>:is(.a,.b) rect{fill:none} :where(.c) rect{fill:black}</style><g class="a"><rect width="90" height="90"/></g><g class="c" fill="none"><rect width="30" height="30"/></g>'),  # noqa: E501
    "css important": Seen(f'<style>path{{fill:none!important}}</style><path style="fill:red" d="{SQUARE}"/><circle r="20"/>'),  # noqa: E501
    "css specificity": Seen(f'<style>#p{{fill:red}} path.q{{fill:none}} path{{fill:none}}</style><path id="p" class="q" d="{SQUARE}"/>'),  # noqa: E501
    "css order": Seen(f'<style>.q{{fill:none}} .q{{fill:red}}</style><path class="q" d="{SQUARE}"/>'),
    "css beats attribute": Seen(f'<style>path{{fill:black}}</style><path fill="none" d="{SQUARE}"/>'),
    "style beats css": Seen(f'<style>path{{fill:none}}</style><path style="fill:black" d="{SQUARE}"/>'),
    "css comments": Seen(f'<style>/* .q{{fill:none}} */ .q{{/*;*/fill:/**/red;}}</style><path fill="none" class="q" d="{SQUARE}"/>'),  # noqa: E501
    "css cdata": Seen('<style><![CDATA[ g > .a { fill : none } ]]></style><g><rect class="a" width="90" height="90"/></g><circle r="50"/>'),  # noqa: E501
    "css media screen": Seen(f'<style>@media screen{{.q{{fill:none}}}} @media print{{.r{{fill:none}}}}</style><path class="q" d="{SQUARE}"/><circle class="r" r="20"/>'),  # noqa: E501
    "css media attribute": Seen(f'<style media="print">path{{fill:none}}</style><path d="{SQUARE}"/>'),
    "css media dark": Seen(f'<style>@media (prefers-color-scheme: dark){{path{{fill:none}}}}</style><path d="{SQUARE}"/>'),  # noqa: E501
    "css import": Seen(f'<style>@import url("other.css");</style><path d="{SQUARE}"/>', "@import"),
    "css supports": Seen(f'<style>@supports (fill:red){{path{{fill:none}}}}</style><path d="{SQUARE}"/>', "@supports"),
    "css variable": Seen(f'<style>:root{{--ink:none}} .q{{fill:var(--ink)}} .r{{fill:var(--other, black)}}</style><path class="q" d="{SQUARE}"/><circle fill="none" class="r" r="20"/>'),  # noqa: E501
    "css invalid value": Seen(f'<style>path{{fill:black; fill:bogus}}</style><path fill="none" d="{SQUARE}"/>'),
    "css hover": Seen(f'<style>path:hover{{fill:none}}</style><path d="{SQUARE}"/>'),
    "css geometry": Seen('<style>circle{cx:50px;cy:50%;r:30px} rect{x:5px;width:10px;height:20px}</style><circle r="2"/><rect width="1" height="1"/>'),  # noqa: E501
    "css path": Seen(f"<style>path{{d:path('{SQUARE}')}}</style><path/>"),
    "css path none": Seen(f'<style>.q{{d:none}}</style><path class="q" d="M0 0H10V10Z"/><path d="{SQUARE}"/>'),
    "css type other": Seen(f'<style type="text/less">path{{fill:none}}</style><path d="{SQUARE}"/>'),
    "css universal": Seen('<style>*{fill:none} circle{fill:black}</style><rect width="90" height="90"/><circle r="40"/>'),  # noqa: E501
    "css two sheets": Seen(f'<style>path{{fill:none}}</style><style>path{{fill:black}}</style><path d="{SQUARE}"/>'),
    "css case": Seen(f'<path style="FILL:NONE" d="{SQUARE}"/><circle r="20"/>'),
    "css unknown selector": Seen(f'<style>path::what(3){{fill:none}} path{{fill:black}}</style><path fill="none" d="{SQUARE}"/>', "what"),  # noqa: E501
    "css animation": Seen(f'<style>@keyframes k{{from{{opacity:1}}}} path{{animation:k 1s}}</style><path d="{SQUARE}"/>', "animation"),  # noqa: E501
    # Paint
    "fill inherit": Seen('<g fill="none"><rect fill="inherit" width="90" height="90"/><rect fill="black" width="20" height="20"/></g>'),  # noqa: E501
    "fill current colour": Seen('<g color="transparent"><rect fill="currentColor" width="90" height="90"/></g><circle r="30" fill="currentColor"/>'),  # noqa: E501
    "fill transparent": Seen('<rect fill="transparent" width="90" height="90"/><circle r="30"/>'),
    "fill rgba 0": Seen('<rect fill="rgba(0,0,0,0)" width="90" height="90"/><rect fill="rgb(0 0 0 / 0%)" width="90" height="90"/><circle r="30"/>'),  # noqa: E501
    "fill #0000": Seen('<rect fill="#0000" width="90" height="90"/><circle r="30" fill="#000f"/>'),
    "fill hsl": Seen('<rect fill="hsla(120,50%,50%,0)" width="90" height="90"/><circle r="30" fill="hsl(0,100%,50%)"/>'),  # noqa: E501
    "fill bogus inherits": Seen('<g fill="none"><rect fill="bogus" width="90" height="90"/></g><circle r="30"/>'),
    "fill opacity 0": Seen('<rect fill-opacity="0" width="90" height="90"/><rect fill-opacity="0%" width="80" height="90"/><circle r="30"/>'),  # noqa: E501
    "fill opacity inherited": Seen('<g fill-opacity="0"><rect width="90" height="90"/><circle fill-opacity="1" r="30"/></g>'),  # noqa: E501
    "opacity 0": Seen('<rect opacity="0" width="90" height="90"/><g opacity="0"><rect width="80" height="90"/></g><circle r="30"/>'),  # noqa: E501
    "opacity half": Seen('<rect opacity=".5" width="90" height="90"/>', "transparent"),
    "fill initial": Seen('<g fill="none"><rect style="fill:initial" width="50" height="50"/></g>'),
    "fill unset": Seen('<g fill="none"><rect style="fill:unset" width="90" height="90"/></g><circle r="30"/>'),
    "gradient": Seen('<linearGradient id="l"><stop/><stop offset="1" stop-color="red"/></linearGradient><circle r="60" fill="url(#l)"/>'),  # noqa: E501
    "gradient fading": Seen('<linearGradient id="l"><stop/><stop offset="1" stop-opacity="0"/></linearGradient><circle r="60" fill="url(#l)"/>', "fade"),  # noqa: E501
    "gradient without stops": Seen('<linearGradient id="l"/><rect width="90" height="90" fill="url(#l)"/><circle r="30"/>'),  # noqa: E501
    "gradient by reference": Seen('<linearGradient id="k"><stop/></linearGradient><radialGradient id="l" xlink:href="#k"/><circle r="60" fill="url(#l)"/>'),  # noqa: E501
    "paint that is not there": Seen('<rect width="90" height="90" fill="url(#no)"/><circle r="30" fill="url(#no) black"/>'),  # noqa: E501
    "pattern": Seen('<pattern id="p" width="10" height="10" patternUnits="userSpaceOnUse"><rect width="5" height="10"/></pattern><circle r="60" fill="url(#p)"/>', "pattern"),  # noqa: E501
    "colours beside each other": Seen('<rect width="40" height="90" fill="#f00"/><rect x="50" width="40" height="90" fill="blue"/>'),  # noqa: E501
    "colours upon each other": Seen('<rect width="90" height="90" fill="red"/><circle r="40" fill="blue"/>', "colours"),
    "white on black": Seen('<rect width="90" height="90"/><circle cx="50" cy="50" r="30" fill="white"/>'),
    "white behind black": Seen('<rect width="100" height="100" fill="#fff"/><circle cx="50" cy="50" r="30"/>'),
    "white and black again": Seen('<rect width="90" height="90"/><circle cx="50" cy="50" r="30" fill="white"/><circle cx="50" cy="50" r="10"/>'),  # noqa: E501
    "white alone": Seen('<circle cx="50" cy="50" r="30" fill="white"/>'),
    # What is not shown
    "display none": Seen('<g display="none"><rect width="90" height="90"/></g><circle r="30"/>'),
    "display none stays": Seen('<g style="display:none"><rect display="inline" width="90" height="90"/></g><circle r="30"/>'),  # noqa: E501
    "visibility back in a child": Seen('<g visibility="hidden"><rect width="90" height="90"/><circle visibility="visible" r="30"/></g>'),  # noqa: E501
    "visibility collapse": Seen('<rect visibility="collapse" width="90" height="90"/><circle r="30"/>'),
    "no size": Seen('<rect width="0" height="90"/><circle r="0"/><ellipse rx="0" ry="30"/><circle r="-5"/><rect width="-5" height="5"/><circle r="20"/>'),  # noqa: E501
    "metadata": Seen(f'<title>t</title><desc>d</desc><metadata><x xmlns="urn:x"><path xmlns="http://www.w3.org/2000/svg" d="{SQUARE}"/></x></metadata><circle r="30"/>'),  # noqa: E501
    "another namespace": Seen(f'<o:path xmlns:o="urn:o" d="{SQUARE}"/><g><o:g xmlns:o="urn:o"><path d="{SQUARE}"/></o:g></g><circle r="30"/>'),  # noqa: E501
    "unknown element": Seen(f'<what><path d="{SQUARE}"/></what><circle r="30"/>'),
    "text": Seen('<circle r="30"/><text x="10" y="90">A</text>', "text"),
    "text hidden": Seen('<circle r="30"/><text display="none" x="10" y="90">A</text>'),
    "text empty": Seen('<circle r="30"/><text x="10" y="90">  </text>'),
    "image": Seen('<circle r="30"/><image href="data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7" x="50" width="50" height="50"/>', "image"),  # noqa: E501
    "foreign object": Seen('<circle r="30"/><foreignObject width="50" height="50"><p xmlns="http://www.w3.org/1999/xhtml">x</p></foreignObject>', "foreignObject"),  # noqa: E501
    "filter": Seen('<filter id="f"><feGaussianBlur stdDeviation="5"/></filter><circle cx="50" cy="50" r="30" filter="url(#f)"/>', "filter"),  # noqa: E501
    "filter that is not there": Seen('<circle cx="50" cy="50" r="30" filter="none"/>'),
    "marker": Seen('<marker id="m" markerWidth="9" markerHeight="9"><rect width="9" height="9"/></marker><path marker-end="url(#m)" d="M10 10H50V50"/>', "marker"),  # noqa: E501
    "stroke": Seen('<path stroke="black" stroke-width="9" d="M20 20H80V80H20Z"/>', "stroke"),
    "stroke of no fill": Seen('<path fill="none" stroke="black" d="M20 20H80"/>', "stroke"),
    "stroke without width": Seen('<path stroke="black" stroke-width="0" d="M20 20H80V80H20Z"/>'),
    "stroke transparent": Seen('<path stroke="black" stroke-opacity="0" stroke-width="9" d="M20 20H80V80H20Z"/>'),
    "animation": Seen('<circle r="30"><animate attributeName="r" values="30;30" dur="1s"/></circle>', "animation"),
    "svg font": Seen('<defs><font horiz-adv-x="600"><font-face font-family="F"/><glyph unicode="A" d="M0 0H9V9Z"/></font></defs>', "font"),  # noqa: E501
    # Clones, symbols, views
    "use": Seen('<defs><path id="g" d="M0 0H30V40H0Z"/></defs><use xlink:href="#g" x="50" y="50"/><use href="#g"/>'),
    "use of a later one": Seen('<use href="#g" x="50" y="50"/><path id="g" d="M0 0H30V40H0Z"/>'),
    "use inherits": Seen('<defs><path id="g" d="M0 0H30V40H0Z"/></defs><use href="#g" fill="none"/><g fill="none"><use href="#g" x="50" fill="black"/></g>'),  # noqa: E501
    "use of a group with its own fill": Seen('<defs><g id="g" fill="black"><path d="M0 0H30V40H0Z"/></g></defs><use href="#g" x="20" fill="none"/>'),  # noqa: E501
    "use nested": Seen('<defs><path id="a" d="M0 0H10V10H0Z"/><g id="b"><use href="#a" x="20"/></g></defs><use href="#b" y="30" transform="scale(2)"/>'),  # noqa: E501
    "use in a loop": Seen('<g id="a"><use href="#a" x="10"/><rect width="20" height="20"/></g>'),
    "use of nothing": Seen('<use href="#no"/><use href=""/><circle r="30"/>'),
    "use of another file": Seen('<use href="other.svg#g"/><circle r="30"/>', "other files"),
    "use css": Seen('<style>#g{fill:none} use #h{fill:none} .u{fill:black}</style><defs><path id="h" class="u" d="M0 0H30V40H0Z"/></defs><use href="#h"/><rect id="g" width="90" height="90"/>'),  # noqa: E501
    "symbol": Seen('<symbol id="s" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></symbol><use href="#s" x="10" y="20" width="40" height="40"/>'),  # noqa: E501
    "symbol without size": Seen('<symbol id="s" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></symbol><use href="#s"/>'),  # noqa: E501
    "symbol with size": Seen('<symbol id="s" viewBox="0 0 10 10" width="30" height="30"><circle cx="5" cy="5" r="5"/></symbol><use href="#s"/>'),  # noqa: E501
    "symbol cuts": Seen('<symbol id="s" viewBox="0 0 10 10"><circle cx="10" cy="5" r="5"/></symbol><use href="#s" width="40" height="40"/>'),  # noqa: E501
    "symbol does not cut": Seen('<symbol id="s" viewBox="0 0 10 10" overflow="visible"><circle cx="10" cy="5" r="5"/></symbol><use href="#s" width="40" height="40"/>'),  # noqa: E501
    "symbol alone": Seen('<symbol><rect width="90" height="90"/></symbol><circle r="30"/>'),
    "symbol slice": Seen('<symbol id="s" viewBox="0 0 10 20" preserveAspectRatio="xMidYMax slice"><circle cx="5" cy="15" r="5"/></symbol><use href="#s" width="40" height="40"/>'),  # noqa: E501
    "nested svg": Seen('<svg x="50%" width="50%" height="50%" viewBox="0 0 10 10"><path d="M0 0H10V10H0Z"/></svg>'),
    "nested svg cuts": Seen('<svg x="10" y="10" width="50" height="50"><circle r="40"/></svg>'),
    "nested svg does not cut": Seen('<svg x="30" y="30" width="50" height="50" overflow="visible"><circle r="20"/></svg>'),  # noqa: E501
    "nested svg, percentages inside": Seen('<svg x="10" width="50" height="80"><rect width="50%" height="50%"/></svg>'),
    "nested svg of no size": Seen('<svg width="0" height="50"><rect width="50" height="50"/></svg><circle r="30"/>'),
    "nested svg, min": Seen('<svg width="80" height="40" viewBox="5 5 10 10" preserveAspectRatio="xMinYMin"><rect x="5" y="5" width="10" height="10"/></svg>'),  # noqa: E501
    "nested svg, none": Seen('<svg width="80" height="40" viewBox="0 0 10 10" preserveAspectRatio="none"><circle cx="5" cy="5" r="5"/></svg>'),  # noqa: E501
    "nested svg, one side": Seen('<svg width="40" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></svg>'),
    "switch": Seen('<switch><rect systemLanguage="xx" width="90" height="90"/><circle systemLanguage="en" r="30"/><rect width="80" height="80"/></switch>'),  # noqa: E501
    "switch extension": Seen('<switch><foreignObject requiredExtensions="http://ns.adobe.com/AI/" width="9" height="9"/><g><circle r="30"/></g></switch>'),  # noqa: E501
    "language without a switch": Seen('<rect systemLanguage="de" width="90" height="90"/><circle r="30"/>'),
    "link": Seen('<a href="x"><rect width="30" height="30"/></a>'),
    # Clips and masks
    "clip": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip in style": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><circle cx="50" cy="50" r="40" style="clip-path:url(\'#c\')"/>'),  # noqa: E501
    "clip of a group": Seen('<clipPath id="c"><circle cx="50" cy="50" r="30"/></clipPath><g clip-path="url(#c)"><rect width="50" height="100"/><rect x="60" width="20" height="100"/></g>'),  # noqa: E501
    "clip by box": Seen('<clipPath id="c" clipPathUnits="objectBoundingBox"><circle cx=".5" cy=".5" r=".5"/></clipPath><rect x="10" y="20" width="60" height="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip rule": Seen(f'<clipPath id="c"><path clip-rule="evenodd" d="{SQUARE}{HOLE}"/></clipPath><rect width="100" height="100" clip-path="url(#c)"/>'),  # noqa: E501
    "clip of a clip": Seen('<clipPath id="d"><rect width="100" height="50"/></clipPath><clipPath id="c" clip-path="url(#d)"><rect width="50" height="100"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip in a clip": Seen('<clipPath id="d"><rect width="100" height="50"/></clipPath><clipPath id="c"><circle cx="50" cy="50" r="40" clip-path="url(#d)"/></clipPath><rect width="100" height="100" clip-path="url(#c)"/>'),  # noqa: E501
    "clip by use": Seen('<defs><rect id="r" width="50" height="100"/></defs><clipPath id="c"><use href="#r" x="20"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip transformed": Seen('<clipPath id="c" transform="rotate(45 50 50)"><rect x="30" y="30" width="40" height="40"/></clipPath><rect width="100" height="100" clip-path="url(#c)"/>'),  # noqa: E501
    "clip with two shapes": Seen('<clipPath id="c"><rect width="60" height="60"/><path d="M40 40V90H90V40Z"/></clipPath><circle cx="50" cy="50" r="48" clip-path="url(#c)"/>'),  # noqa: E501
    "clip empty": Seen('<clipPath id="c"/><rect width="90" height="90" clip-path="url(#c)"/><circle r="30"/>'),
    "clip that is not there": Seen('<circle r="30" clip-path="url(#c)"/>'),
    "clip that cuts nothing": Seen('<clipPath id="c"><rect width="100" height="100"/></clipPath><circle cx="50.1" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip moves along": Seen('<clipPath id="c"><rect width="25" height="50"/></clipPath><g transform="translate(40 20)" clip-path="url(#c)"><circle cx="20" cy="20" r="20"/></g>'),  # noqa: E501
    "clip by a circle function": Seen('<rect width="90" height="90" style="clip-path:circle(20px)"/>', "circle"),
    "clip by text": Seen('<clipPath id="c"><text y="90" font-size="90">A</text></clipPath><rect width="90" height="90" clip-path="url(#c)"/>', "text"),  # noqa: E501
    "clip ignores fill": Seen('<clipPath id="c" fill="none"><rect width="50" height="100" fill="none" opacity="0"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "mask white": Seen('<mask id="m"><rect width="50" height="100" fill="white"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask white and black": Seen('<mask id="m"><rect width="100" height="100" fill="#fff"/><circle cx="50" cy="50" r="20"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask by box": Seen('<mask id="m" maskContentUnits="objectBoundingBox"><rect width=".5" height="1" fill="white"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask region": Seen('<mask id="m" x="0" y="0" width=".5" height="1"><rect width="100" height="100" fill="white"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask grey": Seen('<mask id="m"><rect width="50" height="100" fill="gray"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>', "mask"),  # noqa: E501
    "mask alpha": Seen('<mask id="m" style="mask-type:alpha"><rect width="50" height="100"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask empty": Seen('<mask id="m"/><rect width="90" height="90" mask="url(#m)"/><circle r="30"/>'),
    "mask on a group": Seen('<mask id="m"><rect width="50" height="100" fill="white"/></mask><g mask="url(#m)"><circle cx="50" cy="50" r="40"/><rect x="40" width="20" height="100"/></g>'),  # noqa: E501
    # Lengths and shapes
    "units": Seen('<rect width="10mm" height="1cm"/><rect x="0.5in" width="10pt" height="1pc"/><rect y="50px" width="40Q" height="2em"/><rect x="60" y="60" width="1rem" height="1.5rem"/>'),  # noqa: E501
    "percentages": Seen('<circle cx="50%" cy="25%" r="10%"/><rect x="10%" y="50%" width="50%" height="25%"/>', root='viewBox="0 0 100 80"'),  # noqa: E501
    "font size": Seen('<g font-size="20"><rect width="2em" height="1em"/><g font-size="50%"><rect y="30" width="2em" height="1em"/></g></g>'),  # noqa: E501
    "calc": Seen('<rect style="width:calc(50% + 10px);height:calc((1in - 6px) / 2)"/>'),
    "rx only": Seen('<rect x="10" y="20" width="80" height="40" rx="10"/>'),
    "ry only": Seen('<rect x="10" y="20" width="80" height="40" ry="10"/>'),
    "rx too large": Seen('<rect x="10" y="20" width="80" height="40" rx="100"/>'),
    "rx and ry": Seen('<rect x="10" y="20" width="80" height="40" rx="30" ry="5"/>'),
    "rx percent": Seen('<rect x="10" y="20" width="80" height="40" rx="10%" ry="5%"/>'),
    "rx negative": Seen('<rect x="10" y="20" width="80" height="40" rx="-10" ry="8"/>'),
    "rx zero": Seen('<rect x="10" y="20" width="80" height="40" rx="0" ry="8"/>'),
    "ellipse with one radius": Seen('<ellipse cx="50" cy="50" rx="30"/>'),
    "circle px": Seen('<circle cx="50px" cy="50px" r="40px"/>'),
    "odd count of points": Seen('<polygon points="10,10 90,10 90,90 10"/>'),
    "points with an error": Seen('<polygon points="10,10 90,10 90,90 x 10,90"/>', "points"),
    "points without separators": Seen('<polygon points="10-0 90 10-5.5.5,1e1,90"/>'),
    # Path data
    "arc flags": Seen('<path d="M10 50a1 1 0 0140 0a20 20 0 1120-20z"/>'),
    "arc to itself": Seen('<path d="M20 20 H80 A25 25 0 1 0 80 20 V80 H20 Z"/>'),
    "arc too small": Seen('<path d="M10 50A5 2 30 0 1 90 50Z"/>'),
    "arc without radius": Seen('<path d="M10 50A0 20 0 0 1 90 50V90Z"/>'),
    "arc negative radius": Seen('<path d="M10 50A-40 40 0 0 1 90 50Z"/>'),
    "arc turned": Seen('<path d="M20 50A40 20 30 1 0 80 50Z"/>'),
    "path exponents": Seen('<path d="M1e1 1E1 9e+1 100e-1.9e2.9e2Z"/>'),
    "path compressed": Seen('<path d="M10-.5L90.5.5 50.5 90-5-5z"/>'),
    "path implicit lines": Seen('<path d="m10 10 80 0 0 80zM20 60 30 60 30 80"/>'),
    "path after z": Seen('<path d="M10 10h30v30zl-5 50h50zm50 0h20v20z"/>'),
    "path smooth": Seen('<path d="M10 50S30 10 50 50S70 90 90 50T50 10T10 50Q0 0 30 30T60 60"/>'),
    "path error at the end": Seen('<path d="M20 20H80V80H20ZL"/>', "path data"),
    "path error in the middle": Seen('<path d="M20 20H80V80L x 3 H20Z"/>', "path data"),
    "path error at the beginning": Seen('<path d="L20 20H80V80Z"/><circle r="20"/>', "path data"),
    "path error in a flag": Seen('<path d="M20 20H80A5 5 0 2 1 80 80H20Z"/>', "path data"),
    "path odd numbers": Seen('<path d="M20 20L80 20 80 80 20"/>', "path data"),
    "path none": Seen('<path d=""/><path/><path d="none"/><circle r="30"/>'),
    "path two moves": Seen('<path d="M5 5M20 20H80V80ZM1 1"/>'),
    "path relative curves": Seen('<path d="m20 20c0 20 20 40 40 40s20-40 20-40q-10-20-20-10t-40 10z"/>'),
    # Transforms
    "transform list": Seen('<rect width="20" height="20" transform="translate(50,10),rotate(30)scale(2 1.5)"/>'),
    "transform skew": Seen('<rect width="30" height="30" transform="translate(20) skewX(20) skewY(-10)"/>'),
    "transform about a point": Seen('<rect x="30" y="30" width="30" height="20" transform="rotate(45 50 50)"/>'),
    "transform odd spaces": Seen('<rect width="30" height="30" transform=" matrix ( 1,0 0 1 , 20.5-.5e1 ) "/>'),
    "transform bad": Seen('<rect width="30" height="30" transform="rotate(30 1)"/>', "transform"),
    "transform css": Seen('<rect width="30" height="30" style="transform:translate(20px,10%) rotate(0.1turn) scale(150%)"/>'),  # noqa: E501
    "transform css over attribute": Seen('<rect width="30" height="30" transform="scale(3)" style="transform:translateX(20px)"/>'),  # noqa: E501
    "transform css none": Seen('<rect width="30" height="30" transform="scale(3)" style="transform:none"/>'),
    "transform css without unit": Seen('<rect width="30" height="30" style="transform:translate(20,10)"/>', "transform"),  # noqa: E501
    "transform origin": Seen('<rect x="30" y="30" width="30" height="20" style="transform:rotate(45deg);transform-origin:50px 50px"/>'),  # noqa: E501
    "transform origin centre": Seen('<rect x="30" y="30" width="30" height="20" style="transform:rotate(45deg);transform-origin:center"/>'),  # noqa: E501
    "transform origin of its box": Seen('<rect x="30" y="30" width="30" height="20" style="transform:rotate(45deg);transform-box:fill-box;transform-origin:center"/>'),  # noqa: E501
    "transform origin attribute": Seen('<rect x="30" y="30" width="30" height="20" transform="rotate(45)" transform-origin="40 40"/>'),  # noqa: E501
    "transform of three dimensions": Seen('<rect width="30" height="30" style="transform:rotateX(45deg)"/>', "transform"),  # noqa: E501
    "rotate property": Seen('<rect x="40" y="10" width="30" height="30" style="rotate:20deg"/>', "rotate"),
    "mirrored": Seen('<path d="M10 10H60V60H10Z" transform="matrix(-1 0 0 1 100 0)"/><path d="M10 40H60V90H10Z"/>'),
    "flat": Seen('<rect width="50" height="50" transform="scale(1 0)"/><circle r="30"/>'),
    # Files
    "view box offset": Seen('<circle cx="0" cy="0" r="40"/>', root='viewBox="-50 -50 100 100"'),
    "size without view box": Seen('<circle cx="50%" cy="50%" r="40"/>', root='width="100" height="100"'),
    "size in millimetres": Seen('<circle cx="50" cy="50" r="40"/>', root='width="30mm" height="30mm" viewBox="0 0 100 100"'),  # noqa: E501
    "size in percent": Seen('<circle cx="50" cy="50" r="40"/>', root='width="100%" height="100%" viewBox="0 0 100 100"'),  # noqa: E501
    "stretched": Seen('<circle cx="50" cy="50" r="40"/>', root='width="150" height="100" preserveAspectRatio="none" viewBox="0 0 100 100"'),  # noqa: E501
    "root fill": Seen('<rect width="90" height="90"/><circle fill="black" r="30"/>', root=f'{BOX} fill="none"'),
    "root style": Seen('<rect width="90" height="90"/><circle fill="black" r="30"/>', root=f'{BOX} style="fill:none"'),
    "prefix": Seen(f'<s:svg xmlns:s="http://www.w3.org/2000/svg" {BOX}><s:path d="{SQUARE}"/><path d="M0 0H9V9Z"/></s:svg>'.replace("<s:svg", '<?xml version="1.0"?><s:svg', 1)),  # noqa: E501
    "entities": Seen(f'<!DOCTYPE svg [<!ENTITY st "fill:none"><!ENTITY d "{SQUARE}">]><svg {HEAD} {BOX}><rect style="&st;" width="90" height="90"/><path d="&d;"/></svg>'),  # noqa: E501
    "document type": Seen(f'<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd"><svg {HEAD} {BOX}><path d="{SQUARE}"/></svg>'),  # noqa: E501
    "style sheet in another file": Seen(f'<?xml version="1.0"?><?xml-stylesheet href="no.css"?><svg {HEAD} {BOX}><path d="{SQUARE}"/></svg>', "other files"),  # noqa: E501
    "nested groups": Seen("<g>" * 50 + f'<path d="{SQUARE}"/>' + "</g>" * 50),
    # Others of each kind
    "css of types": Seen('<style>rect:nth-of-type(odd),circle:first-of-type{fill:none}</style><rect width="30" height="30"/><rect x="40" width="30" height="30"/><circle cx="20" cy="70" r="20"/><circle cx="70" cy="70" r="20"/>'),  # noqa: E501
    "css attribute equals": Seen('<style>[fill="red"]{fill:none} [data-a="X" i]{display:none}</style><rect fill="red" width="30" height="30"/><rect data-a="x" x="40" width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css two classes": Seen('<style>.a.b{fill:none}</style><rect class="b a" width="30" height="30"/><rect class="a" x="40" width="30" height="30"/>'),  # noqa: E501
    "css root": Seen('<style>:root > g{fill:none}</style><g><rect width="30" height="30"/><circle fill="#000" r="20"/></g>'),  # noqa: E501
    "css general sibling": Seen('<style>rect ~ circle{fill:none}</style><circle cx="20" cy="20" r="20"/><rect y="50" width="30" height="30"/><circle cx="70" cy="70" r="20"/>'),  # noqa: E501
    "css empty and only": Seen('<style>g:empty{fill:none} g > rect:only-child{fill:none}</style><g><rect width="30" height="30"/></g><g><rect x="40" width="30" height="30"/><circle cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "css has": Seen('<style>g:has(circle){display:none}</style><g><rect width="30" height="30"/></g><g><rect x="40" width="30" height="30"/><circle cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "css namespace": Seen('<style>@namespace s url(http://www.w3.org/2000/svg); rect{fill:none}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css at the end": Seen('<rect class="a" width="30" height="30"/><circle r="50"/><g><defs><style>.a{fill:none}</style></defs></g>'),  # noqa: E501
    "css important in style": Seen('<style>rect{fill:black!important}</style><rect style="fill:none" width="30" height="30"/><rect x="50" style="fill:none !important" width="30" height="30"/>'),  # noqa: E501
    "css important attribute": Seen('<g fill="none"><rect fill="black !important" width="30" height="30"/></g><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css spaces": Seen('<rect style=" ; fill : none ;; " width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),
    "css comment in style": Seen('<rect style="/* a;b */fill:none/*c*/" width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css media and": Seen('<style>@media all and (min-width: 1px){rect{fill:none}}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>', "media"),  # noqa: E501
    "css layer": Seen('<style>@layer a{rect{fill:none}}</style><rect width="30" height="30"/>', "@layer"),
    "css nesting": Seen('<style>g{ rect{fill:none} }</style><g><rect width="30" height="30"/></g>', "nested"),
    "css html comment": Seen('<style>&lt;!-- rect{fill:none} --></style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css string with a brace": Seen('<style>text{font-family:"a}b;c"} rect{fill:none}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css pseudo-element": Seen('<style>rect::before{fill:none} rect:first-child{fill:none}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css opacity": Seen('<style>.a{opacity:0%} .b{fill-opacity:0.0} .c{opacity:150%}</style><rect class="a" width="30" height="30"/><rect class="b" x="40" width="30" height="30"/><circle class="c" cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css clip": Seen('<style>.k{clip-path:url("#c")}</style><clipPath id="c"><rect width="50" height="100"/></clipPath><circle class="k" cx="50" cy="50" r="40"/>'),  # noqa: E501
    "css visibility": Seen('<style>g{visibility:hidden} .v{visibility:visible}</style><g><rect width="30" height="30"/><circle class="v" cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "css current colour": Seen('<style>.a{color:transparent} .b{fill:currentColor}</style><g class="a"><rect class="b" width="30" height="30"/></g><circle class="b" cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css inherit": Seen('<style>g{fill:none} .i{fill:inherit} circle{fill:black}</style><g><rect class="i" width="30" height="30"/><circle cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "css even-odd": Seen('<style>.e{fill-rule:evenodd}</style><g class="e"><path d="M20 20H80V80H20ZM35 35H65V65H35Z"/></g>'),  # noqa: E501
    "css transform": Seen('<style>rect{transform:translate(10px,20px) skewX(10deg) rotate(.1rad)}</style><rect width="30" height="30"/>'),  # noqa: E501
    "css transform matrix": Seen('<rect width="30" height="30" style="transform:matrix(1,.5,0,1,10,10)"/>'),
    "css all": Seen('<g fill="none"><rect style="all:unset" width="30" height="30"/></g><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "fill short hex": Seen('<g fill="none"><rect fill="#12345" width="30" height="30"/><rect fill="rgb(1,2)" x="40" width="30" height="30"/></g><circle fill="#abc" cx="50" cy="70" r="20"/>'),  # noqa: E501
    "fill upper case": Seen('<rect fill="NONE" width="30" height="30"/><circle fill="RED" cx="50" cy="70" r="20"/><rect fill=" none " x="40" width="30" height="30"/>'),  # noqa: E501
    "fill rgb out of range": Seen('<circle fill="rgb(300,-5,120%)" cx="50" cy="70" r="20"/><circle fill="rgb(110%, 0%, 0%)" cx="50" cy="20" r="20"/>'),  # noqa: E501
    "fill of wide gamuts": Seen('<circle fill="oklch(40% 0.1 20)" cx="50" cy="70" r="20"/><rect fill="color(display-p3 1 0 0 / 0)" width="90" height="40"/>'),  # noqa: E501
    "fill named colour": Seen('<circle fill="rebeccapurple" cx="50" cy="70" r="20"/>'),
    "fill opacity negative": Seen('<rect fill-opacity="-1" width="30" height="30"/><circle fill-opacity="2" cx="50" cy="70" r="20"/>'),  # noqa: E501
    "opacity in groups": Seen('<g opacity="1"><g style="opacity:0"><rect width="30" height="30"/></g><circle cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "opacities multiplied": Seen('<g opacity=".04"><rect opacity=".04" width="90" height="90"/></g><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "display upper case": Seen('<rect display="NONE" width="30" height="30"/><circle display="bogus" cx="50" cy="70" r="20"/>'),  # noqa: E501
    "display on what is referred to": Seen('<defs style="display:none"><path id="g" d="M0 0H30V40H0Z"/></defs><use href="#g"/>'),  # noqa: E501
    "display none on a clone's target": Seen('<path id="g" display="none" d="M0 0H30V40H0Z"/><use href="#g"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "display none in a clip": Seen('<clipPath id="c"><rect display="none" width="50" height="100"/><rect visibility="hidden" x="50" width="50" height="100"/><rect width="30" height="100"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "defs everywhere": Seen('<g><defs><rect width="90" height="90"/></defs><circle cx="50" cy="70" r="20"/></g>'),
    "text in defs": Seen('<defs><text id="t">A</text></defs><circle cx="50" cy="70" r="20"/>'),
    "text span": Seen('<text y="50"><tspan>A</tspan></text>', "text"),
    "text without fill": Seen('<text y="50" fill="none">A</text><circle cx="50" cy="70" r="20"/>'),
    "image without a picture": Seen('<image width="50" height="50"/><circle cx="50" cy="70" r="20"/>'),
    "filter missing": Seen('<circle cx="50" cy="70" r="20" filter="url(#no)"/>'),
    "blend": Seen('<circle cx="50" cy="70" r="20" style="mix-blend-mode:multiply"/>', "blend"),
    "marker in a style": Seen('<style>path{marker:url(#m)}</style><marker id="m"><rect width="3" height="3"/></marker><path d="M10 10H50V50"/>', "marker"),  # noqa: E501
    "use with units": Seen('<defs><path id="g" d="M0 0H30V40H0Z"/></defs><use href="#g" x="10mm" y="25%"/>'),
    "use of a link and a switch": Seen('<defs><a id="a"><rect width="20" height="20"/></a><switch id="s"><rect width="20" height="20"/></switch></defs><use href="#a"/><use href="#s" x="50"/>'),  # noqa: E501
    "use of a nested svg": Seen('<defs><svg id="s" x="10" width="20" height="20" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></svg></defs><use href="#s"/><use href="#s" x="40" width="40" height="40"/>'),  # noqa: E501
    "use of a symbol of a symbol": Seen('<symbol id="a" viewBox="0 0 10 10"><circle cx="5" cy="5" r="5"/></symbol><symbol id="b" viewBox="0 0 20 20"><use href="#a" width="10" height="10"/><rect x="10" y="10" width="10" height="10"/></symbol><use href="#b" x="10" y="10" width="60" height="60"/>'),  # noqa: E501
    "use of a symbol with percentages": Seen('<symbol id="a"><rect width="50%" height="50%"/></symbol><use href="#a" width="40" height="80"/>'),  # noqa: E501
    "use transformed and moved": Seen('<defs><g id="g" transform="scale(2)"><rect width="10" height="10"/></g></defs><use href="#g" x="10" y="10" transform="rotate(20)"/>'),  # noqa: E501
    "use of a clip": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><defs><circle id="g" cx="50" cy="50" r="40" clip-path="url(#c)"/></defs><use href="#g" x="20"/>'),  # noqa: E501
    "use clipped": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><defs><circle id="g" cx="50" cy="50" r="40"/></defs><use href="#g" x="20" clip-path="url(#c)"/>'),  # noqa: E501
    "use css inheritance": Seen('<style>use{fill:none} .k{fill:black}</style><defs><path id="g" d="M0 0H30V40H0Z"/></defs><use href="#g"/><use class="k" href="#g" x="50"/>'),  # noqa: E501
    "two of one id": Seen('<rect id="g" width="20" height="20"/><circle id="g" cx="20" cy="80" r="20"/><use href="#g" x="50"/>'),  # noqa: E501
    "symbol, max and mid": Seen('<symbol id="s" viewBox="0 0 10 10" preserveAspectRatio="xMaxYMid meet"><circle cx="5" cy="5" r="5"/></symbol><use href="#s" width="80" height="40"/>'),  # noqa: E501
    "symbol with an offset box": Seen('<symbol id="s" viewBox="-5 -5 10 10"><circle r="5"/></symbol><use href="#s" x="10" y="10" width="40" height="40"/>'),  # noqa: E501
    "symbol transformed": Seen('<symbol id="s" viewBox="0 0 10 10" transform="translate(20 0)"><circle cx="5" cy="5" r="5"/></symbol><use href="#s" width="40" height="40"/>'),  # noqa: E501
    "nested svg transformed": Seen('<svg width="40" height="40" transform="translate(30 20)"><circle cx="20" cy="20" r="20"/></svg>'),  # noqa: E501
    "nested svg in a nested svg": Seen('<svg x="10" y="10" width="80" height="80" viewBox="0 0 40 40"><svg x="50%" y="50%" width="50%" height="50%"><rect width="100%" height="50%"/></svg></svg>'),  # noqa: E501
    "nested svg, overflow in style": Seen('<svg x="30" y="30" width="30" height="30" style="overflow:visible"><circle r="20"/></svg>'),  # noqa: E501
    "nested svg, slice": Seen('<svg width="40" height="80" viewBox="0 0 10 10" preserveAspectRatio="xMidYMid slice"><circle cx="5" cy="5" r="5"/></svg>'),  # noqa: E501
    "switch in a switch": Seen('<switch><g systemLanguage="fr"><rect width="90" height="90"/></g><switch><rect systemLanguage="xx" width="80" height="80"/><circle r="30"/></switch></switch>'),  # noqa: E501
    "switch of nothing": Seen('<switch><rect systemLanguage="xx" width="90" height="90"/></switch><circle r="30"/>'),
    "switch with a group hidden": Seen('<switch><g display="none"><rect width="90" height="90"/></g><rect width="80" height="80"/></switch><circle r="30"/>'),  # noqa: E501
    "required features": Seen('<rect requiredFeatures="http://www.w3.org/TR/SVG11/feature#Shape" width="30" height="30"/>'),  # noqa: E501
    "clip of a nested svg": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><svg clip-path="url(#c)"><circle cx="50" cy="50" r="40"/></svg>'),  # noqa: E501
    "clip with percentages": Seen('<clipPath id="c"><rect width="50%" height="50%"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip by box of a group": Seen('<clipPath id="c" clipPathUnits="objectBoundingBox"><rect width=".5" height="1"/></clipPath><g clip-path="url(#c)" transform="translate(10 10)"><rect width="20" height="20"/><circle cx="60" cy="60" r="20"/></g>'),  # noqa: E501
    "clip by box, transformed": Seen('<clipPath id="c" clipPathUnits="objectBoundingBox" transform="translate(10 0)"><rect width=".5" height="1"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip with a group in it": Seen('<clipPath id="c"><g><rect width="90" height="90"/></g><rect width="20" height="90"/></clipPath><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clip transformed child": Seen('<clipPath id="c"><rect width="40" height="40" transform="rotate(45)"/></clipPath><rect width="100" height="100" clip-path="url(#c)"/>'),  # noqa: E501
    "clip of even-odd": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><path clip-path="url(#c)" fill-rule="evenodd" d="M20 20H80V80H20ZM35 35H65V65H35Z"/>'),  # noqa: E501
    "clip by something else": Seen('<mask id="c"><rect width="50" height="100" fill="#fff"/></mask><circle cx="50" cy="50" r="40" clip-path="url(#c)"/>'),  # noqa: E501
    "clips twice": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><clipPath id="d"><rect width="100" height="50"/></clipPath><g clip-path="url(#c)"><circle cx="50" cy="50" r="40" clip-path="url(#d)"/></g>'),  # noqa: E501
    "clip and mask": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><mask id="m"><rect width="100" height="50" fill="white"/></mask><circle cx="50" cy="50" r="40" clip-path="url(#c)" mask="url(#m)"/>'),  # noqa: E501
    "mask by use": Seen('<defs><circle id="g" cx="50" cy="50" r="30" fill="#fff"/></defs><mask id="m"><use href="#g"/></mask><rect width="100" height="100" mask="url(#m)"/>'),  # noqa: E501
    "mask in units": Seen('<mask id="m" maskUnits="userSpaceOnUse" x="20" y="20" width="40" height="40"><rect width="100" height="100" fill="#fff"/></mask><rect width="100" height="100" mask="url(#m)"/>'),  # noqa: E501
    "mask clipped": Seen('<clipPath id="c"><rect width="50" height="100"/></clipPath><mask id="m"><rect width="100" height="100" fill="#fff" clip-path="url(#c)"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask of a mask": Seen('<mask id="n"><rect width="100" height="50" fill="#fff"/></mask><mask id="m" mask="url(#n)"><rect width="50" height="100" fill="#fff"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask transformed element": Seen('<mask id="m"><rect width="20" height="100" fill="#fff"/></mask><rect width="40" height="40" transform="translate(20 20) rotate(10)" mask="url(#m)"/>'),  # noqa: E501
    "mask that is not there": Seen('<circle cx="50" cy="50" r="40" mask="url(#no)"/>'),
    "mask half opaque": Seen('<mask id="m"><rect width="50" height="100" fill="white" opacity=".5"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>', "mask"),  # noqa: E501
    "mask with a stroke": Seen('<mask id="m"><path stroke="white" stroke-width="20" d="M0 50H100"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>', "strokes"),  # noqa: E501
    "lengths, odd ones": Seen('<rect x="1e1" y="+10" width="20PX" height=".25in"/><rect x="50" y="50" width="10,5" height="20"/><rect x="50" y="60" width="5 0" height="20"/><rect x=" 60 " y="20" width="20" height="20"/>'),  # noqa: E501
    "length with a space before its unit": Seen('<rect width="50 %" height="50"/><circle cx="70" cy="70" r="20"/>'),
    "lengths of the window": Seen('<rect width="10vw" height="50"/>', "vw"),
    "circle percent radius": Seen('<circle cx="50" cy="50" r="25%"/>', root='viewBox="0 0 200 100"'),
    "rect auto": Seen('<rect width="auto" height="50"/><circle cx="70" cy="70" r="20"/>'),
    "line and polyline": Seen('<line x1="0" y1="0" x2="90" y2="90"/><polyline points="10 10 90 10 90 90"/>'),
    "polygon of one point": Seen('<polygon points="10,10"/><polygon points=""/><polygon/><circle cx="70" cy="70" r="20"/>'),  # noqa: E501
    "path with references": Seen('<path d="M20&#x20;20&#10;H80\n\tV80 H20 z "/>'),
    "path z and on": Seen('<path d="M10 10zl40 0 0 40z M60 60 h30 v30 z h-20 v-10 z"/>'),
    "path comma after a command": Seen('<path d="M20 20H80V80H20Z L,5 5"/>', "path data"),
    "path two commas": Seen('<path d="M20 20H80V80H20ZM5,,5H9V9"/>', "path data"),
    "path number with a point at its end": Seen('<path d="M20 20H80V80.H20Z"/>', "path data"),
    "path unknown command": Seen('<path d="M20 20H80V80H20ZB5 5"/>', "path data"),
    "path leading text": Seen('<path d="x M20 20H80V80Z"/><circle cx="20" cy="70" r="20"/>', "path data"),
    "path huge": Seen('<path d="M20 20H80V80L1e999 1"/>', "path data"),
    "path arcs in a row": Seen('<path d="M30 50a20 20 0 1 0 40 0 20 20 0 1 0-40 0zm10 0a10 10 0 1 1 20 0 10 10 0 1 1-20 0z"/>'),  # noqa: E501
    "path arcs, even-odd": Seen('<path fill-rule="evenodd" d="M12 2a10 10 0 1010 10A10 10 0 0012 2zm0 4a6 6 0 106 6 6 6 0 00-6-6z"/>', root='viewBox="0 0 24 24"'),  # noqa: E501
    "path arc, a hair": Seen('<path d="M10 50A40 40 0 0 1 90 50A40 40 0 0 1 90 50.0000001Z"/>'),
    "path T after M": Seen('<path d="M10 10T50 10 90 50L10 90Z"/>'),
    "path S after Q": Seen('<path d="M10 10Q50 0 50 50S90 50 90 90L10 90Z"/>'),
    "bow tie": Seen('<path d="M10 10L90 90V10L10 90Z"/>'),
    "bow tie, even-odd": Seen('<path fill-rule="evenodd" d="M10 10L90 90V10L10 90Z"/>'),
    "rings that touch": Seen('<path fill-rule="evenodd" d="M10 10H90V90H10ZM10 30H50V70H10Z"/>'),
    "even-odd, four deep, mixed directions": Seen('<path fill-rule="evenodd" d="M0 0H100V100H0ZM10 10V90H90V10ZM20 20H80V80H20ZM30 30V70H70V30Z"/>'),  # noqa: E501
    "nonzero, same way, three deep": Seen('<path d="M0 0H100V100H0ZM10 10H90V90H10ZM20 20V80H80V20Z"/>'),
    "counters in two shapes": Seen('<path d="M0 0H60V60H0ZM20 20V40H40V20Z"/><path d="M40 40V100H100V40ZM60 60H80V80H60Z"/>'),  # noqa: E501
    "a hole filled by another shape": Seen('<path fill-rule="evenodd" d="M10 10H90V90H10ZM30 30H70V70H30Z"/><path d="M40 40V60H60V40Z"/>'),  # noqa: E501
    "transform none": Seen('<rect width="30" height="30" transform="none"/><rect x="50" width="30" height="30" transform=""/>'),  # noqa: E501
    "transform with units": Seen('<rect width="30" height="30" transform="translate(10px,20px)"/>', "transform"),
    "transform upper case": Seen('<rect width="30" height="30" transform="SCALE(2)"/>', "transform"),
    "transform trailing": Seen('<rect width="30" height="30" transform="translate(20) ,scale(1.5) rotate(10),"/>', "transform"),  # noqa: E501
    "transform matrix short": Seen('<rect width="30" height="30" transform="matrix(1 0 0 1 5)"/>', "transform"),
    "transform scale and skew": Seen('<g transform="scale(.5,-1) translate(0,-100)"><circle cx="50" cy="50" r="40" transform="skewX(30)"/></g>'),  # noqa: E501
    "transform on the root": Seen('<rect width="30" height="30"/>', "whole drawing", f'{BOX} transform="translate(20 20)"'),  # noqa: E501
    "transform percent": Seen('<rect width="30" height="20" style="transform:translate(50%,50%)"/>'),
    "transform percent of its box": Seen('<rect x="10" width="30" height="20" style="transform:translate(50%,50%);transform-box:fill-box"/>'),  # noqa: E501
    "transform origin keywords": Seen('<rect x="30" y="30" width="30" height="20" style="transform:scale(.5);transform-origin:right bottom"/>'),  # noqa: E501
    "transform origin one value": Seen('<rect x="30" y="30" width="30" height="20" style="transform:scale(.5);transform-origin:top"/>'),  # noqa: E501
    "view box with commas": Seen('<circle cx="0" cy="0" r="40"/>', root='viewBox="-50,-50,100,100"'),
    "one side of a size": Seen('<circle cx="50" cy="50" r="40"/>', root='width="120" viewBox="0 0 100 100"'),
    "aspect of the root": Seen('<circle cx="50" cy="50" r="40"/>', root='width="150" height="100" preserveAspectRatio="xMinYMin" viewBox="0 0 100 100"'),  # noqa: E501
    "processing instruction": Seen(f'<?xml version="1.0" standalone="no"?><!-- a --><?xpacket x?><svg {HEAD} {BOX}><path d="{SQUARE}"/></svg>'),  # noqa: E501
    "xml space": Seen('<g xml:space="preserve"><rect width="30" height="30"/></g>'),
    "inkscape": Seen('<sodipodi:namedview xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" id="n"/><g xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:groupmode="layer" style="display:inline"><path style="fill:#000000;fill-opacity:1;stroke:none" d="m 20,20 h 60 v 60 h -60 z" inkscape:connector-curvature="0"/></g><g style="display:none"><rect width="100" height="100"/></g>'),  # noqa: E501
    "illustrator": Seen(f'<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [<!ENTITY ns_svg "http://www.w3.org/2000/svg"><!ENTITY ns_ai "http://ns.adobe.com/AdobeIllustrator/10.0/">]><svg xmlns="&ns_svg;" xmlns:i="&ns_ai;" {BOX} xml:space="preserve"><style type="text/css">.st0{{fill:none;}} .st1{{fill-rule:evenodd;clip-rule:evenodd;}}</style><switch><foreignObject requiredExtensions="&ns_ai;" width="1" height="1"/><g i:extraneous="self"><rect class="st0" width="100" height="100"/><path class="st1" d="{SQUARE}{HOLE}"/></g></switch></svg>'),  # noqa: E501
    "figma": Seen('<g clip-path="url(#clip0)"><path fill-rule="evenodd" clip-rule="evenodd" d="M20 20H80V80H20ZM35 35H65V65H35Z" fill="black"/></g><defs><clipPath id="clip0"><rect width="100" height="100" fill="white"/></clipPath></defs>', root='width="100" height="100" viewBox="0 0 100 100" fill="none"'),  # noqa: E501
    "material": Seen('<path d="M0 0h24v24H0z" fill="none"/><path d="M12 2C6.48 2 2 6.48 2 12s4.48 10 10 10 10-4.48 10-10S17.52 2 12 2zm-2 15l-5-5 1.41-1.41L10 14.17l7.59-7.59L19 8l-9 9z"/>', root='height="24" width="24" viewBox="0 0 24 24"'),  # noqa: E501
    "sketch": Seen('<g stroke="none" stroke-width="1" fill="none" fill-rule="evenodd"><g transform="translate(-10, -10)" fill="#000000" fill-rule="nonzero"><polygon points="30 30 90 30 90 90 30 90"/></g></g>'),  # noqa: E501
    # And others
    "even-odd, a thin overlap": Seen('<path fill-rule="evenodd" d="M10 0H90V43H10ZM20 40H80V100H20Z"/>'),
    "even-odd, a thin loop": Seen('<path fill-rule="evenodd" d="M10 10H90V90H10V40H95V43H5V37H50V10Z"/>'),
    "opposite, a thin overlap": Seen('<path d="M10 0H90V43H10ZM20 40V100H80V40Z"/><rect x="45" width="10" height="90"/>'),  # noqa: E501
    "css escapes": Seen('<style>.a\\:b{fill:none} #\\31 x{fill:none}</style><rect class="a:b" width="30" height="30"/><rect id="1x" x="40" width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css case of elements": Seen('<style>RECT{fill:none} circle{FILL:None}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css any namespace": Seen('<style>*|rect{fill:none}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css nth-last-child": Seen('<style>g *:nth-last-child(1){fill:none} g > :nth-child(2n+1 of .x){fill:none}</style><g><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/></g>'),  # noqa: E501
    "css classes apart": Seen('<style>[class~=a]{fill:none}</style><rect class="b\t a\nc" width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css media not print": Seen('<style>@media not print{rect{fill:none}} @media screen, print{.a{fill:none}} @media only screen and (orientation:landscape){.b{fill:none}}</style><rect width="30" height="30"/><rect class="a" x="40" width="30" height="30"/><circle cx="50" cy="70" r="20"/>', "media"),  # noqa: E501
    "css wide words": Seen('<g fill="none" visibility="hidden"><rect style="fill:revert;visibility:visible" width="30" height="30"/><rect style="fill:initial;visibility:inherit" x="40" width="30" height="30"/></g><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css descendant of the root": Seen('<style>svg rect{fill:none} svg svg rect{fill:black}</style><rect width="30" height="30"/><svg><rect x="50" width="30" height="30"/></svg>'),  # noqa: E501
    "css variable in a variable": Seen('<style>svg{--a:none;--b:var(--a)} rect{fill:var(--b)} circle{fill:var(--no)}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css shorthand of nothing": Seen('<style>rect{fill:none;fill:url(#no) , red}</style><rect width="30" height="30"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "css colours of zero opacity": Seen('<rect style="fill:rgb(0 0 0 / .0)" width="30" height="30"/><rect style="fill:#FFF0" x="40" width="30" height="30"/><rect style="fill:hsl(120deg 50% 50% / 0)" x="40" y="40" width="30" height="30"/><circle cx="20" cy="70" r="20"/>'),  # noqa: E501
    "css display block": Seen('<rect style="display:block" width="30" height="30"/><g style="display:contents"><circle cx="20" cy="70" r="20"/></g>'),  # noqa: E501
    "root hidden": Seen('<rect width="30" height="30"/><circle visibility="visible" cx="50" cy="70" r="20"/>', root=f'{BOX} visibility="hidden"'),  # noqa: E501
    "root without opacity": Seen('<rect width="30" height="30"/>', root=f'{BOX} opacity="0"'),
    "root clipped": Seen('<clipPath id="c"><rect width="20" height="100"/></clipPath><rect width="30" height="30"/>', "whole", f'{BOX} clip-path="url(#c)"'),  # noqa: E501
    "root with a place": Seen('<rect width="30" height="30"/>', root=f'{BOX} x="20" y="30"'),
    "root with a rule": Seen('<path d="M20 20H80V80H20ZM35 35H65V65H35Z"/>', root=f'{BOX} fill-rule="EvenOdd"'),
    "stroke none in a style": Seen('<style>rect{stroke:none}</style><rect stroke="red" width="30" height="30"/>'),
    "stroke current colour": Seen('<g color="transparent"><rect stroke="currentColor" width="30" height="30"/></g>'),
    "stroke of a paint that is not there": Seen('<rect stroke="url(#no)" width="30" height="30"/>'),
    "clip of a line": Seen('<clipPath id="c"><line x2="90" y2="90"/></clipPath><rect width="90" height="90" clip-path="url(#c)"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "clip with a rule around it": Seen('<g clip-rule="evenodd"><clipPath id="c"><path d="M20 20H80V80H20ZM35 35H65V65H35Z"/></clipPath></g><rect width="90" height="90" clip-path="url( #c )"/>'),  # noqa: E501
    "clip by a symbol": Seen('<symbol id="s"><rect width="30" height="90"/></symbol><clipPath id="c"><use href="#s"/></clipPath><rect width="90" height="90" clip-path="url(#c)"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "clip by a link": Seen('<clipPath id="c"><a><rect width="30" height="90"/></a></clipPath><rect width="90" height="90" clip-path="url(#c)"/><circle cx="50" cy="95" r="3"/>'),  # noqa: E501
    "clip of nothing": Seen('<clipPath id="c"><rect width="30" height="90"/></clipPath><g clip-path="url(#c)"/><circle cx="50" cy="70" r="20" clip-path="none" mask="none"/>'),  # noqa: E501
    "clip of evenodd by evenodd": Seen('<clipPath id="c"><path clip-rule="evenodd" d="M0 0H100V100H0ZM45 0H55V100H45Z"/></clipPath><path clip-path="url(#c)" fill-rule="evenodd" d="M20 20H80V80H20ZM35 35H65V65H35Z"/>'),  # noqa: E501
    "clip by two circles": Seen('<clipPath id="c"><circle cx="35" cy="50" r="25"/><circle cx="65" cy="50" r="25"/></clipPath><rect width="100" height="100" clip-path="url(#c)"/>'),  # noqa: E501
    "mask red": Seen('<mask id="m"><rect width="50" height="100" fill="red"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>', "mask"),  # noqa: E501
    "mask white without opacity": Seen('<mask id="m"><rect width="100" height="100" fill="white" opacity="0"/><rect width="20" height="100" fill="#fff"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask black on white on black": Seen('<mask id="m"><rect width="100" height="100"/><circle cx="50" cy="50" r="30" fill="white"/><circle cx="50" cy="50" r="10" fill="black"/></mask><rect width="100" height="100" mask="url(#m)"/>'),  # noqa: E501
    "mask white gradient": Seen('<linearGradient id="l"><stop stop-color="white"/><stop offset="1" stop-color="white"/></linearGradient><mask id="m"><rect width="50" height="100" fill="url(#l)"/></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>'),  # noqa: E501
    "mask with text": Seen('<mask id="m"><rect width="50" height="100" fill="white"/><text y="90" font-size="80">A</text></mask><circle cx="50" cy="50" r="40" mask="url(#m)"/>', "text"),  # noqa: E501
    "symbol with a place": Seen('<symbol id="s" x="10" y="20" width="30" height="30"><circle cx="15" cy="15" r="15"/></symbol><use href="#s" x="5"/>'),  # noqa: E501
    "use with spaces": Seen('<rect id="g" width="20" height="20"/><use href=" #g " x="50"/>'),
    "use of hidden things": Seen('<g visibility="hidden"><rect id="g" width="20" height="20"/></g><use href="#g" x="50"/>'),  # noqa: E501
    "use both references": Seen('<defs><rect id="g" width="20" height="20"/><rect id="h" width="40" height="40"/></defs><use href="#g" xlink:href="#h" x="50"/>'),  # noqa: E501
    "use percent": Seen('<defs><rect id="g" width="20%" height="20%"/></defs><svg width="50" height="50"><use href="#g" x="50%" y="50%"/></svg>'),  # noqa: E501
    "points in any form": Seen('<polygon points="10,10,40,10,40,40"/><polyline points=" 60 10 , 90 10&#10;90,40 "/><polygon points="10-60"/>'),  # noqa: E501
    "path many of one command": Seen('<path d="M10 10H30 50 40V30 50h5 5v5 5C60 60 70 60 70 70 60 80 50 80 40 70L10 90z"/>'),  # noqa: E501
    "path relative moves": Seen('<path d="m10 10 20 0 0 20z m40 0 20 0 0 20z m0 40h20v20z"/>'),
    "path relative arcs and curves": Seen('<path d="m50 10a20 20 0 0 1 20 20 20 20 0 0 1-20 20s-10 0-20-10-5-5-5-5q-5-5 0-10t10-5z"/>'),  # noqa: E501
    "path signs": Seen('<path d="M+10+10L+9e1-0L90 9.0e+1L10,+90z"/>'),
    "path of one point": Seen('<path d="M10 10z"/><path d="M10 10L10 10"/><path d="M50 50"/><circle cx="50" cy="70" r="20"/>'),  # noqa: E501
    "path T chain after a curve": Seen('<path d="M10 50C20 10 30 10 40 50T70 50 90 50V90H10Z"/>'),
    "path capital Z twice": Seen('<path d="M20 20H80V80ZZ M10 90H20V80Z z"/>'),
    "tiny view box": Seen('<circle cx="0.0005" cy="0.0005" r="0.0004"/>', root='viewBox="0 0 .001 .001"'),
    "huge view box": Seen('<circle cx="500000" cy="500000" r="400000"/>', root='viewBox="0 0 1e6 1e6"'),
    "switch of text": Seen('<switch><text y="50">A</text><rect width="30" height="30"/></switch>', "text"),
    "switch languages": Seen('<switch><rect systemLanguage="" width="90" height="90"/><circle systemLanguage="fr, en-US" cx="50" cy="70" r="20"/></switch>'),  # noqa: E501
    "text alone": Seen('<text y="50" font-size="50">A</text>', "text"),
    "vector effect": Seen('<rect width="30" height="30" vector-effect="non-scaling-stroke"/>'),
    "opacity of almost nothing": Seen('<rect width="90" height="90" opacity="0.0001"/><circle cx="50" cy="70" r="20" opacity="0.999"/>'),  # noqa: E501
    "colours covered": Seen('<rect x="20" y="20" width="40" height="40" fill="red"/><rect width="90" height="90" fill="green"/>'),  # noqa: E501
    "white covered": Seen('<circle cx="50" cy="50" r="20" fill="white"/><rect width="90" height="90"/>'),
    "white letter on a disc on white": Seen('<rect width="100" height="100" fill="#ffffff"/><circle cx="50" cy="50" r="40" fill="#0000cc"/><path fill="white" d="M40 30H60V70H40Z"/>'),  # noqa: E501
    "white stroke on black": Seen('<rect width="90" height="90"/><path d="M10 10H80" stroke="white"/>', "strokes"),
    "off-white": Seen('<rect width="100" height="100" fill="#fefefe"/><circle cx="50" cy="50" r="40"/>', "colours"),
    "two greys": Seen('<rect width="50" height="100" fill="#333"/><rect x="50" width="50" height="100" fill="#999"/>'),
    "doctype html entities": Seen(f'<!DOCTYPE svg [<!ENTITY box "0 0 100 100"><!ENTITY p "<path d=\'{SQUARE}\'/>">]><svg {HEAD} viewBox="&box;">&p;</svg>'),  # noqa: E501
    "mirrored twice": Seen('<g transform="scale(-1,1) translate(-100)"><path d="M10 10H60V60H10Z"/></g><path d="M40 40H90V90H40Z"/><path transform="matrix(0 1 1 0 0 0)" d="M30 5H50V95H30Z"/>'),  # noqa: E501
}  # fmt: skip

INK = {
    "even-odd attribute": 0.270, "even-odd style": 0.270, "even-odd inherited": 0.270, "even-odd star": 0.190,
    "even-odd crossing": 0.420, "even-odd three deep": 0.540, "even-odd shared edge": 0.640,
    "even-odd twice the same": 0.090, "nonzero star": 0.275, "nonzero hole": 0.270, "nonzero no hole": 0.360,
    "opposite shapes overlap": 0.460, "opposite shapes, one with a hole": 0.370, "figure eight on a bar": 0.380,
    "even-odd beside nonzero": 0.301, "a shape twice": 0.250, "open paths are filled": 0.365, "css class none": 0.160,
    "css id": 0.283, "css child and sibling": 0.090, "css nth-child": 0.090, "css attribute": 0.126, "css not": 0.180,
    "css is and where": 0.090, "css important": 0.031, "css specificity": 0.360, "css order": 0.360,
    "css beats attribute": 0.360, "style beats css": 0.360, "css comments": 0.360, "css cdata": 0.196,
    "css media screen": 0.031, "css media attribute": 0.360, "css media dark": 0.360, "css variable": 0.031,
    "css invalid value": 0.360, "css hover": 0.360, "css geometry": 0.303, "css path": 0.360, "css path none": 0.360,
    "css type other": 0.360, "css universal": 0.126, "css two sheets": 0.360, "css case": 0.031, "fill inherit": 0.040,
    "fill current colour": 0.071, "fill transparent": 0.071, "fill rgba 0": 0.071, "fill #0000": 0.071,
    "fill hsl": 0.071, "fill bogus inherits": 0.071, "fill opacity 0": 0.071, "fill opacity inherited": 0.071,
    "opacity 0": 0.071, "fill initial": 0.250, "fill unset": 0.071, "gradient": 0.282, "gradient without stops": 0.071,
    "gradient by reference": 0.282, "paint that is not there": 0.071, "colours beside each other": 0.720,
    "white on black": 0.527, "white behind black": 0.283, "white and black again": 0.559, "white alone": 0.283,
    "display none": 0.071, "display none stays": 0.071, "visibility back in a child": 0.071,
    "visibility collapse": 0.071, "no size": 0.031, "metadata": 0.071, "another namespace": 0.071,
    "unknown element": 0.071, "text hidden": 0.071, "text empty": 0.071, "filter that is not there": 0.283,
    "stroke without width": 0.360, "stroke transparent": 0.360, "use": 0.240, "use of a later one": 0.240,
    "use inherits": 0.120, "use of a group with its own fill": 0.120, "use nested": 0.040, "use in a loop": 0.040,
    "use of nothing": 0.071, "use css": 0.120, "symbol": 0.125, "symbol without size": 0.784, "symbol with size": 0.070,
    "symbol cuts": 0.062, "symbol does not cut": 0.125, "symbol alone": 0.071, "symbol slice": 0.125,
    "nested svg": 0.250, "nested svg cuts": 0.126, "nested svg does not cut": 0.125,
    "nested svg, percentages inside": 0.100, "nested svg of no size": 0.071, "nested svg, min": 0.160,
    "nested svg, none": 0.251, "nested svg, one side": 0.125, "switch": 0.071, "switch extension": 0.071,
    "language without a switch": 0.071, "link": 0.090, "clip": 0.251, "clip in style": 0.251, "clip of a group": 0.224,
    "clip by box": 0.188, "clip rule": 0.270, "clip of a clip": 0.125, "clip in a clip": 0.251, "clip by use": 0.368,
    "clip transformed": 0.160, "clip with two shapes": 0.488, "clip empty": 0.071, "clip that is not there": 0.071,
    "clip that cuts nothing": 0.502, "clip moves along": 0.082, "clip ignores fill": 0.251, "mask white": 0.251,
    "mask white and black": 0.377, "mask by box": 0.251, "mask region": 0.251, "mask alpha": 0.251, "mask empty": 0.071,
    "mask on a group": 0.272, "units": 0.324, "font size": 0.100, "calc": 0.270, "rx only": 0.311, "ry only": 0.311,
    "rx too large": 0.251, "rx and ry": 0.307, "rx percent": 0.316, "rx negative": 0.314, "rx zero": 0.320,
    "ellipse with one radius": 0.283, "circle px": 0.502, "odd count of points": 0.320,
    "points without separators": 0.068, "arc flags": 0.125, "arc to itself": 0.360, "arc too small": 0.226,
    "arc without radius": 0.160, "arc negative radius": 0.251, "arc turned": 0.145, "path exponents": 0.320,
    "path compressed": 0.416, "path implicit lines": 0.330, "path after z": 0.190, "path smooth": 0.323,
    "path none": 0.071, "path two moves": 0.180, "path relative curves": 0.216, "transform list": 0.120,
    "transform skew": 0.082, "transform about a point": 0.060, "transform odd spaces": 0.075, "transform css": 0.198,
    "transform css over attribute": 0.090, "transform css none": 0.090, "transform origin": 0.060,
    "transform origin centre": 0.060, "transform origin of its box": 0.060, "transform origin attribute": 0.060,
    "mirrored": 0.460, "flat": 0.071, "prefix": 0.360, "entities": 0.360, "document type": 0.360,
    "nested groups": 0.360, "css of types": 0.215, "css attribute equals": 0.125, "css two classes": 0.090,
    "css root": 0.031, "css general sibling": 0.215, "css empty and only": 0.215, "css has": 0.090,
    "css namespace": 0.125, "css at the end": 0.196, "css important in style": 0.090, "css important attribute": 0.125,
    "css spaces": 0.125, "css comment in style": 0.125, "css html comment": 0.125, "css string with a brace": 0.125,
    "css pseudo-element": 0.215, "css opacity": 0.125, "css clip": 0.251, "css visibility": 0.125,
    "css current colour": 0.125, "css inherit": 0.125, "css even-odd": 0.270, "css transform": 0.090,
    "css transform matrix": 0.090, "css all": 0.125, "fill short hex": 0.125, "fill upper case": 0.125,
    "fill rgb out of range": 0.250, "fill of wide gamuts": 0.125, "fill named colour": 0.125,
    "fill opacity negative": 0.125, "opacity in groups": 0.125, "opacities multiplied": 0.125,
    "display upper case": 0.125, "display on what is referred to": 0.120, "display none on a clone's target": 0.125,
    "display none in a clip": 0.098, "defs everywhere": 0.125, "text in defs": 0.125, "text without fill": 0.125,
    "image without a picture": 0.125, "filter missing": 0.125, "use with units": 0.120,
    "use of a link and a switch": 0.080, "use of a nested svg": 0.156, "use of a symbol of a symbol": 0.160,
    "use of a symbol with percentages": 0.080, "use transformed and moved": 0.040, "use of a clip": 0.251,
    "use clipped": 0.251, "use css inheritance": 0.120, "two of one id": 0.205, "symbol, max and mid": 0.125,
    "symbol with an offset box": 0.125, "symbol transformed": 0.125, "nested svg transformed": 0.125,
    "nested svg in a nested svg": 0.080, "nested svg, overflow in style": 0.125, "nested svg, slice": 0.306,
    "switch in a switch": 0.071, "switch of nothing": 0.071, "switch with a group hidden": 0.071,
    "required features": 0.090, "clip of a nested svg": 0.251, "clip with percentages": 0.125,
    "clip by box of a group": 0.040, "clip by box, transformed": 0.294, "clip with a group in it": 0.036,
    "clip transformed child": 0.080, "clip of even-odd": 0.135, "clip by something else": 0.502, "clips twice": 0.125,
    "clip and mask": 0.125, "mask by use": 0.283, "mask in units": 0.160, "mask clipped": 0.251,
    "mask of a mask": 0.251, "mask transformed element": 0.080, "mask that is not there": 0.502,
    "lengths, odd ones": 0.088, "length with a space before its unit": 0.125, "rect auto": 0.125,
    "line and polyline": 0.320, "polygon of one point": 0.125, "path with references": 0.360, "path z and on": 0.135,
    "path arcs in a row": 0.093, "path arc, a hair": 0.251, "path T after M": 0.453, "path S after Q": 0.434,
    "bow tie": 0.320, "bow tie, even-odd": 0.320, "rings that touch": 0.480,
    "even-odd, four deep, mixed directions": 0.560, "nonzero, same way, three deep": 1.000,
    "counters in two shapes": 0.600, "a hole filled by another shape": 0.520, "transform none": 0.180,
    "transform scale and skew": 0.251, "transform percent": 0.060, "transform percent of its box": 0.060,
    "transform origin keywords": 0.015, "transform origin one value": 0.015, "processing instruction": 0.360,
    "xml space": 0.090, "inkscape": 0.360, "illustrator": 0.270, "sketch": 0.360, "css escapes": 0.125,
    "css case of elements": 0.090, "css any namespace": 0.125, "css nth-last-child": 0.090, "css classes apart": 0.125,
    "css wide words": 0.125, "css descendant of the root": 0.090, "css variable in a variable": 0.125,
    "css shorthand of nothing": 0.125, "css colours of zero opacity": 0.125, "css display block": 0.215,
    "stroke none in a style": 0.090, "stroke current colour": 0.090, "stroke of a paint that is not there": 0.090,
    "clip of a line": 0.125, "clip with a rule around it": 0.270, "clip by a symbol": 0.125, "clip by a link": 0.003,
    "clip of nothing": 0.125, "clip of evenodd by evenodd": 0.240, "clip by two circles": 0.336,
    "mask white without opacity": 0.036, "mask black on white on black": 0.251, "mask white gradient": 0.251,
    "symbol with a place": 0.070, "use with spaces": 0.080, "use of hidden things": 0.040, "use both references": 0.040,
    "use percent": 0.010, "points in any form": 0.090, "path many of one command": 0.262, "path relative moves": 0.060,
    "path relative arcs and curves": 0.132, "path signs": 0.680, "path of one point": 0.125,
    "path T chain after a curve": 0.380, "path capital Z twice": 0.185, "switch languages": 0.125,
    "vector effect": 0.090, "opacity of almost nothing": 0.125, "colours covered": 0.810, "white covered": 0.810,
    "white letter on a disc on white": 0.422, "two greys": 1.000, "doctype html entities": 0.360,
    "mirrored twice": 0.480,
}  # fmt: skip
"""The share of the view that is ink in Chromium's picture, of drawings that are drawn as it shows them."""
