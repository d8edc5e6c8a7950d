"""outputs/paper/README.md: a template filled from claims.json, so that it holds no number which that file lacks."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from ..survey import table as markdown

TEMPLATE = Path(__file__).with_name("README.template.md")

SIGN = {"reproduced": "✓", "differs": "≠", "not decidable": "?", "proven": "∎", "measured": "·"}


def write_report(out: Path) -> None:
    """Fill the template from ``out/claims.json``, without sections that have no claim, and pictures that are not there.

    A page of all claims is the whole template.
    """
    content = json.loads((out / "claims.json").read_text(encoding="utf-8"))
    made = chosen(TEMPLATE.read_text(encoding="utf-8"), {c["id"] for c in content["claims"]})
    page = re.sub(r"!\[[^]]*\]\(([^)]+)\)\n\n", lambda m: m[0] if (out / m[1]).exists() else "", render(made, content))
    (out / "README.md").write_text(page, encoding="utf-8")


def chosen(template: str, claims: set[str]) -> str:
    """The template without the sections all of whose claims are missing; some have none, and are of all."""
    parts = re.split(r"(?m)^(?=#{1,2} )", template)
    asked = [set(re.findall(r"\{\{claim (.+?)\}\}", part)) for part in parts]
    if set().union(*asked) <= claims:
        return template
    of_all = [k for k, part in enumerate(parts) if "{{summary}}" in part or "{{times}}" in part]
    return "".join(part for k, part in enumerate(parts) if k in of_all or asked[k] & claims)


def render(template: str, content: dict[str, Any]) -> str:
    """Replace ``{{claim id}}``, ``{{paper}}``, ``{{summary}}``, ``{{times}}``; a claim that was not run says so."""
    claims = {c["id"]: c for c in content["claims"]}

    def fill(match: re.Match[str]) -> str:
        kind, _, name = match[1].partition(" ")
        if kind == "claim":
            return block(claims[name]) if name in claims else f"`{name}` was not run."
        return {"summary": summary(claims), "paper": content["paper"], "times": show(content["times"])}[kind]

    return re.sub(r"\{\{(.+?)\}\}", fill, template)


def summary(claims: dict[str, Any]) -> str:
    """A line a claim."""
    rows = [
        [c["source"], f'<a href="#{id}">{cell(c["claim"])}</a>', f"{SIGN[said.partition(' for ')[0]]} {said}"]
        for id, c in claims.items()
        if (said := c["verdict"])
    ]
    return markdown(["source", "claim", "verdict"], rows)


def block(claim: dict[str, Any]) -> str:
    """One claim: what is said, what the paper reports, what was measured, and why it differs."""
    lines = [
        f'<a id="{claim["id"]}"></a>',
        f"**{claim['claim']}** (`{claim['id']}`)",
        "",
        f"- Paper: {claim['paper']}",
        f"- Verdict: **{claim['verdict']}**. {claim['note']}",
    ]
    value = claim["measured"]
    return "\n".join(
        [*lines, "", show(value)] if isinstance(value, dict) else [*lines, f"- Measured: {json.dumps(value)}"]
    )


def show(value: dict[str, Any]) -> str:
    """Nested mappings as tables: plain entries first, then a table for each mapping, of rows if it is nested again."""
    plain = {k: v for k, v in value.items() if not isinstance(v, dict)}
    nested = {k: v for k, v in value.items() if isinstance(v, dict)}
    parts = [table({"": plain}) if len(plain) <= 7 else listing(plain)] if plain else []
    flat = {k: v for k, v in nested.items() if not any(isinstance(x, dict) for x in v.values())}
    alike: dict[tuple[str, ...], dict[str, Any]] = {}
    for name, entries in flat.items():
        alike.setdefault(tuple(entries), {})[name] = entries
    parts += map(table, alike.values())
    for k, v in nested.items():
        if k not in flat:
            parts.append(f"{k}:\n\n{show(v)}")
    return "\n\n".join(parts)


def table(rows: dict[str, dict[str, Any]]) -> str:
    """A mapping of rows, all with the same columns."""
    columns = list(next(iter(rows.values())))
    names = any(rows)
    cells = [[cell(name)] * names + [cell(entries[c]) for c in columns] for name, entries in rows.items()]
    return markdown([""] * names + [cell(c) for c in columns], cells)


def listing(entries: dict[str, Any]) -> str:
    """A line an entry."""
    return "\n".join(["| | |", "|---|---|", *(f"| {cell(k)} | {cell(v)} |" for k, v in entries.items())])


def cell(value: Any) -> str:
    """A number just as claims.json writes it; in a word the sign that would end a column is escaped."""
    return value.replace("|", "\\|") if isinstance(value, str) else json.dumps(value)


NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def numbers_missing(text: str, content: str) -> list[str]:
    """Numbers of the README, addresses and file names apart, that claims.json does not hold."""
    text = re.sub(r"`[^`]*`|\]\([^)]*\)|<a [^>]*>", " ", text)
    known = set(NUMBER.findall(content))
    return sorted({x for x in NUMBER.findall(text) if x not in known})
