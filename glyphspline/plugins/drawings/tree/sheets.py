"""Style sheets inside a drawing: which rules there are, and which of them are for an element."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, TypeAlias

from ....extras import need
from .document import Document
from .unread import Unread

Declaration: TypeAlias = tuple[str, str, bool]
"""A property, its value, and whether it is important."""

COMMENT = re.compile(r"/\*.*?(?:\*/|$)", re.DOTALL)
ITEM = re.compile(r"""(?:[^;"'()]|"[^"]*"|'[^']*'|\((?:[^()"']|"[^"]*"|'[^']*'|\([^()]*\))*\))+""")
IMPORTANT = re.compile(r"\s*!\s*important\s*$", re.IGNORECASE)

SILENT = {"font-face", "keyframes", "-webkit-keyframes", "charset", "namespace", "page", "property", "counter-style"}
"""Rules that say nothing of how shapes look; the property ``animation`` is named itself."""

KNOWN_MEDIA = {
    "prefers-color-scheme:light": True, "prefers-color-scheme:dark": False, "prefers-color-scheme": True,
    "prefers-reduced-motion:no-preference": True, "prefers-reduced-motion:reduce": False, "color": True,
    "prefers-contrast:no-preference": True, "prefers-contrast:more": False, "monochrome": False, "scripting": True,
    "forced-colors:active": False, "forced-colors:none": True, "hover:hover": True, "hover": True,
}  # fmt: skip
"""What a browser with a plain screen says of features."""


def declarations(text: str, unread: Unread, line: int = 0) -> Iterator[Declaration]:
    """The declarations of a style attribute, or of a rule."""
    for item in ITEM.findall(COMMENT.sub(" ", text)):
        name, colon, value = item.partition(":")
        name = name.strip()
        if not colon or not re.fullmatch(r"-{0,2}[A-Za-z_][\w-]*", name):
            if "{" in item:
                unread.add("nested style rules", line)
            continue
        plain = IMPORTANT.sub("", value).strip()
        if plain:
            yield name if name.startswith("--") else name.lower(), plain, plain != value.strip()


class StyleRules:
    """The rules of all style sheets in a drawing."""

    def __init__(self, document: Document, unread: Unread) -> None:
        self._matcher: Any = None
        self._wrapped: dict[Any, Any] = {}
        self._unread = unread
        if document.sheets:
            unread.add("style sheets in other files")
        sheets = [each for each in document.root.iter("style") if "".join(each.itertext()).strip()]
        for element in sheets:
            line, kind = document.lines[element], (element.get("type") or "text/css").strip().lower()
            applies = self._media(element.get("media") or "all", line)
            if kind == "text/css" and applies:
                self._add("".join(element.itertext()), line)
        if self._matcher is not None:
            import cssselect2

            wrapper = cssselect2.ElementWrapper.from_xml_root(document.root)
            self._wrapped = {each.etree_element: each for each in wrapper.iter_subtree()}

    def of(self, element: Any) -> Iterator[Declaration]:
        """The declarations for an element, those that count less first."""
        if self._matcher is not None and (wrapped := self._wrapped.get(element)) is not None:
            for _, _, pseudo, found in sorted(self._matcher.match(wrapped), key=lambda each: each[:2]):
                if pseudo is None:
                    yield from found

    def _add(self, text: str, line: int) -> None:
        need("drawings")
        import cssselect2
        import tinycss2

        if self._matcher is None:
            self._matcher = cssselect2.Matcher()
        text = re.sub(r"<!--|-->", " ", text)
        self._add_rules(tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True), line)

    def _add_rules(self, rules: Any, line: int) -> None:
        import cssselect2
        import tinycss2

        for rule in rules:
            at = line + getattr(rule, "source_line", 1) - 1
            if rule.type == "at-rule":
                name, prelude = rule.lower_at_keyword, tinycss2.serialize(rule.prelude)
                if name == "media" and rule.content is not None:
                    if self._media(prelude, at):
                        inner = tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True)
                        self._add_rules(inner, line)
                elif name not in SILENT:
                    self._unread.add(f"style rules of @{name}", at)
            elif rule.type == "qualified-rule":
                found = [*declarations(tinycss2.serialize(rule.content), self._unread, at)]
                try:
                    selectors = cssselect2.compile_selector_list(rule.prelude)
                except cssselect2.SelectorError:
                    self._unread.add(f"style rules for {tinycss2.serialize(rule.prelude).strip()[:40]!r}", at)
                    continue
                for selector in selectors:
                    self._matcher.add_selector(selector, found)

    def _media(self, queries: str, line: int) -> bool:
        """Whether a list of media queries is true of a screen; what cannot be told is named."""
        answers = [media_answer(query) for query in queries.lower().split(",")]
        if True not in answers and None in answers:
            self._unread.add(f"style rules for media {' '.join(queries.split())!r}", line)
        return True in answers


def media_answer(query: str) -> bool | None:
    """Whether a media query is true of a plain screen; None: it cannot be told."""
    words = query.strip()
    turned = re.match(r"not\s", words) is not None
    answers: list[bool | None] = []
    for part in re.split(r"\sand\s", re.sub(r"^(?:not|only)\s+", "", words)):
        part = re.sub(r"\s*:\s*", ":", part.strip())
        if part in ("", "all", "screen"):
            answers.append(True)
        elif re.fullmatch(r"[a-z]+", part):
            answers.append(False)
        else:
            answers.append(KNOWN_MEDIA.get(part.strip("() ")))
    whole = False if False in answers else None if None in answers else True
    return whole if whole is None else whole != turned
