"""``glyphspline check``: what is shown, written and counted, exit status, baselines, and settings."""

from __future__ import annotations

import csv
import io
import json
import re
from base64 import b64encode
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.outlines.flaws.kinds import KINDS
from glyphspline.plugins.checks.baseline import Baseline
from glyphspline.plugins.checks.finding import severity
from glyphspline.plugins.checks.page import to_draw
from glyphspline.plugins.checks.tables import COLUMNS
from tests.faulty_drawings import drawings, turning
from tests.places import FONTS

FAULTS = {"two": turning(2), "five": turning(5), "jump": turning(0), "fine": "M0 0L400 0L400 400L0 400Z"}
EVIL = "a|`b`*[x](y)<i>@me #1_~$"
"""A glyph's name with all that Markdown and GitHub take for more than text."""

runner = CliRunner()


def checked(*arguments: str | Path) -> Result:
    return runner.invoke(app, ["check", "--jobs", "0", *map(str, arguments)])


def data_of(*arguments: str | Path) -> dict[str, Any]:
    result = checked("--json", *arguments)
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def lines_of(result: Result) -> list[list[str]]:
    """The cells of the table on standard output."""
    return [[cell.strip() for cell in line.split(" | ")] for line in result.stdout.splitlines() if " | " in line]


def test_the_worst_come_first_and_info_is_only_counted(tmp_path: Path) -> None:
    result = checked(drawings(tmp_path / "font", FAULTS))
    assert result.exit_code == 0, result.output
    head, *rows = lines_of(result)
    assert head == ["glyph", "level", "score", "contour", "segment", "point", "finding"]
    assert [(row[0], row[1]) for row in rows] == [("five", "WARN"), ("two", "WARN")]
    assert rows[0][5:] == ["500, -500", "kink: turns by 5° at a joint meant to be smooth"]
    assert "4 glyphs: 2 findings of WARN" in result.stderr
    assert "INFO, shown with -l INFO: 1 jump" in result.stderr
    every = checked(tmp_path / "font", "-l", "info", "--rows", "2")
    assert [row[0] for row in lines_of(every)[1:]] == ["five", "two"]
    assert "and 1 more; --rows 3 shows all" in every.stderr
    assert [row[0] for row in lines_of(checked(tmp_path / "font", "-l", "INFO"))[1:]] == ["five", "two", "jump"]


def test_nothing_found_is_said_and_quiet_says_nothing(tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", {"fine": FAULTS["fine"]})
    result = checked(font)
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "1 glyph: 0 findings of WARN\n")
    quiet = checked(drawings(tmp_path / "bad", FAULTS), "--quiet", "-e", "WARN")
    assert (quiet.exit_code, quiet.stdout, quiet.stderr) == (1, "", "")


@pytest.mark.parametrize(
    ("names", "more", "status"),
    [
        (["five"], [], 0),
        (["five"], ["-e", "WARN"], 1),
        (["five"], ["-e", "INFO"], 1),
        (["jump"], ["--error-level", "WARN"], 0),
        (["jump"], ["--error-level", "info"], 1),
        (["jump"], ["-e", "INFO", "-l", "WARN"], 1),
        (["jump"], ["-e", "INFO", "--kinds", "kink"], 0),
        (["fine"], ["-e", "INFO"], 0),
        (["five"], ["-e", "WARN", "--thresholds", "kink=6"], 0),
    ],
)
def test_exit_status(names: list[str], more: list[str], status: int, tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", {name: FAULTS[name] for name in names})
    assert checked(font, *more).exit_code == status


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--kinds", "kink,lumps"], "--kinds has no 'lumps': there are kink, jump"),
        (["--thresholds", "kin=1"], "--thresholds has no 'kin': there are kink, corner_angle"),
        (["--thresholds", "kink"], "--thresholds is like kink=1,short=2, not 'kink'"),
        (["--thresholds", "kink=wide"], "--thresholds is like kink=1,short=2, not 'kink=wide'"),
        (["--thresholds", "kink=-1"], "the threshold kink is above 0 and up to a million, not -1.0"),
        (["--thresholds", "kink=nan"], "the threshold kink is above 0"),
        (["--loglevel", "FAIL"], "FAIL"),
        (["-e", "never"], "never"),
        (["--json", "--csv", "-"], "only one of --json, --csv - and the like goes to standard output"),
        (["--csv", "-", "--ghmarkdown", "-"], "only one of"),
        (["--plot", "turns.gif"], "--plot is a file of png, pdf, svg, not turns.gif"),
        (["--plot", "turns.svg"], "not a variable font"),
        (["--axis", "wght"], "not a variable font"),
        (["--text", "Z"], "none of the glyphs asked for is in the font"),
        (["--baseline", "nothing.json"], "nothing.json: cannot be read"),
        (["--html", "/dev/null/folder/page.html"], "page.html: cannot be written: Not a directory"),
    ],
)
def test_calls_that_cannot_be_followed(more: list[str], words: str, tmp_path: Path) -> None:
    result = checked(drawings(tmp_path / "font", FAULTS), *more)
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.replace("│", " ").split())


def test_many_fonts_in_one_list(tmp_path: Path) -> None:
    one, other = drawings(tmp_path / "one", {"two": turning(2)}), drawings(tmp_path / "other", {"five": turning(5)})
    (tmp_path / "fonts.txt").write_text(f"{one}\n# nothing\n{other}\n")
    for asked in ([one, other], [f"@{tmp_path / 'fonts.txt'}"]):
        result = checked(*asked)
        assert result.exit_code == 0, result.output
        assert [row[:2] for row in lines_of(result)] == [["font", "glyph"], [str(other), "five"], [str(one), "two"]]
        assert "2 glyphs of 2 fonts: 2 findings of WARN" in result.stderr
    found = data_of(one, other)
    assert [font["counts"] for font in found["fonts"]] == [{"kink": 1}, {"kink": 1}]


def test_a_font_that_cannot_be_read_costs_only_itself(tmp_path: Path) -> None:
    (tmp_path / "broken.ttf").write_bytes(b"nothing")
    good = drawings(tmp_path / "font", FAULTS)
    result = checked(good, tmp_path / "broken.ttf", "--json")
    assert result.exit_code == 1
    broken, font = json.loads(result.stdout)["fonts"]
    assert ("broken.ttf" in broken["error"], font["error"], len(font["findings"])) == (True, None, 3)
    alone = checked(tmp_path / "broken.ttf")
    assert (alone.exit_code, alone.stdout) == (2, "")


def test_faces_of_a_collection(tmp_path: Path) -> None:
    assert len(data_of(FONTS / "kouzan.ttc")["fonts"]) == 1
    both = data_of(FONTS / "kouzan.ttc", FONTS / "kouzan-kaisho.ttf")["fonts"]
    assert [Path(font["font"]).name for font in both] == [
        "kouzan-kaisho.ttf",
        "kouzan.ttc, face 0",
        "kouzan.ttc, face 1",
    ]


def test_the_command_says_what_python_says() -> None:
    path = FONTS / "kouzan-gyosho.otf"
    font = gs.open_font(path)
    expected = sorted([item for outline in font.outlines(font.glyph_names) for item in gs.check(outline)], key=severity)
    (facts,) = data_of(path)["fonts"]
    assert facts["glyphs"] == len(font.glyph_names)
    assert [(f["glyph"], f["kind"], f["contour"], f["segment"], f["value"]) for f in facts["findings"]] == [
        (item.glyph, item.kind, item.contour, item.segment, item.value) for item in expected
    ]
    assert sum(facts["counts"].values()) == len(expected) > 100
    assert facts["findings"][0].keys() == {*gs.Finding.__dataclass_fields__}
    assert facts.keys() == {
        "font", "family", "style", "error", "glyphs", "counts", "repeated", "known", "scores", "axes", "findings",
        "failed", "unread",
    }  # fmt: skip


def test_a_glyph_has_one_score_in_table_json_csv_and_page(tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", FAULTS)
    facts = data_of(font)["fonts"][0]
    seen: dict[str, float] = {}
    for item in facts["findings"]:
        seen[item["glyph"]] = seen.get(item["glyph"], 0.0) + item["seen"]
    assert facts["scores"] == pytest.approx(seen)  # of an em of 1000 units
    contour = gs.open_source(font).outline("two").contours[0]
    lengths = [
        np.hypot(*np.diff(contour.at(np.linspace(k, k + 1, 200)), axis=0).T).sum() for k in (0, len(contour) - 1)
    ]
    assert seen["two"] == pytest.approx(2 / 12 * min(lengths), rel=0.02)
    assert seen["five"] == pytest.approx(2.5 * seen["two"], rel=0.02)
    head, *rows = lines_of(checked(font, "-l", "INFO"))
    assert {row[0]: row[head.index("score")] for row in rows} == {
        glyph: f"{score:.0f}" for glyph, score in seen.items()
    }
    lines = list(csv.DictReader(io.StringIO(checked(font, "--csv", "-").stdout)))
    assert {line["glyph"]: float(line["score"]) for line in lines} == facts["scores"]
    checked(font, "--html", tmp_path / "a.html")
    _, setup = page_of(tmp_path / "a.html")
    assert {row[1]: row[11] for row in setup["rows"]} == {glyph: round(score) for glyph, score in seen.items()}
    assert data_of(font, "--kinds", "short")["fonts"][0]["scores"] == facts["scores"]


def test_workers_find_the_same() -> None:
    path = FONTS / "kouzan-gyosho.ttf"
    result = runner.invoke(app, ["check", str(path), "--json", "--jobs", "2"])
    assert json.loads(result.stdout) == data_of(path)


def test_csv(tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", {**FAULTS, "=1+1": turning(4), 'q",;': turning(3)})
    to_file, to_output = checked(font, "--csv", tmp_path / "a.csv"), checked(font, "--csv", "-")
    assert to_file.exit_code == to_output.exit_code == 0
    text = (tmp_path / "a.csv").read_bytes().decode()
    assert text.replace("\r\n", "\n") == to_output.stdout.replace("\r\n", "\n")
    rows = list(csv.DictReader(io.StringIO(text, newline="")))
    assert tuple(rows[0]) == COLUMNS
    assert [row["glyph"] for row in rows] == ["five", "'=1+1", 'q",;', "two", "jump"]
    findings = data_of(font)["fonts"][0]["findings"]
    assert [(float(row["x"]), float(row["value"])) for row in rows] == [(f["point"][0], f["value"]) for f in findings]


def unescaped(text: str) -> str:
    """A cell's text as GitHub shows it."""
    plain = re.sub(r"^<code>(.*)</code>$", r"\1", text)
    return re.sub(r"&#(\d+);", lambda found: chr(int(found[1])), plain).replace("&amp;", "&")


def test_markdown_shows_names_as_they_are(tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", {EVIL: turning(5), "&lt;": turning(4), "jump": turning(0)})
    result = checked(font, "--ghmarkdown", "-")
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    table = [line for line in lines if line.startswith("|")]
    cells = [line.removeprefix("| ").removesuffix(" |").split(" | ") for line in table]
    assert cells[0] == ["glyph", "level", "score", "contour", "segment", "point", "finding"]
    assert [len(row) for row in cells] == [7, 7, 7, 7]
    assert [unescaped(row[0]) for row in cells[2:]] == [EVIL, "&lt;"]
    for row in cells[2:]:
        shown = row[0].removeprefix("<code>").removesuffix("</code>")
        assert not re.search(r"[|`*\[\]<>@_~$]|#(?!\d)", re.sub(r"&#\d+;", "", shown)), shown
    assert lines[0] == "### glyphspline check"
    assert lines[-1] == "Not listed, INFO: 1 jump."


def test_markdown_is_short_enough_for_a_comment(tmp_path: Path) -> None:
    checked(FONTS / "kouzan-kaisho.ttf", FONTS / "kouzan-gyosho.otf", "-l", "INFO", "--ghmarkdown", tmp_path / "a.md")
    text = (tmp_path / "a.md").read_text()
    assert text.count("\n| ") == 202
    assert re.search(r"^And \d+ more\.$", text, re.MULTILINE)
    assert len(text) < 65_536


def test_a_baseline_leaves_only_what_is_new_or_worse(tmp_path: Path) -> None:
    font, known = drawings(tmp_path / "font", FAULTS), tmp_path / "known.json"
    assert checked(font, "--write-baseline", known, "-e", "WARN").exit_code == 1
    again = checked(font, "--baseline", known, "-l", "INFO", "-e", "INFO")
    assert (again.exit_code, again.stdout) == (0, "")
    assert "not counted, as the baseline has them: 3" in again.stderr

    def later(number: int, **changed: str) -> Path:
        return drawings(tmp_path / str(number) / "font", {**FAULTS, **changed})

    assert checked(later(1, two=turning(2.001), five=turning(4)), "--baseline", known, "-e", "INFO").exit_code == 0
    worse = checked(later(2, two=turning(2.2)), "--baseline", known, "-e", "WARN")
    assert (worse.exit_code, [row[0] for row in lines_of(worse)[1:]]) == (1, ["two"])
    new = checked(later(3, new=turning(1)), "--baseline", known, "-e", "WARN", "--json")
    assert new.exit_code == 1
    (facts,) = json.loads(new.stdout)["fonts"]
    assert ([item["glyph"] for item in facts["findings"]], facts["known"]) == (["new"], 3)


def test_a_baseline_is_the_same_bytes_whatever_the_order_of_fonts(tmp_path: Path) -> None:
    one, other = drawings(tmp_path / "one", FAULTS), drawings(tmp_path / "other", {"a": turning(3)})
    files = [tmp_path / "a.json", tmp_path / "b.json"]
    checked(one, other, "--write-baseline", files[0])
    checked(other, one, "--write-baseline", files[1])
    assert files[0].read_bytes() == files[1].read_bytes()
    data = json.loads(files[0].read_text())
    assert list(data["fonts"]) == ["one Regular", "other Regular"]
    assert data["fonts"]["other Regular"] == [["a", "kink", 0, 0, [3.0]]]
    lines = files[0].read_text().splitlines()
    assert len(lines) == 1 + 4 + 2 * 2 + 1  # one finding a line, for readable differences


def found(value: float, kind: str = "kink", **more: Any) -> gs.Finding:
    given: Mapping[str, Any] = {"level": "WARN", "glyph": "a", "gid": 1, "contour": 0, "segment": 4, **more}
    return gs.Finding(
        kind, parameter=0.0, point=(0.0, 0.0), value=value, unit="", detail=None, other=None, sentence="", **given
    )


@pytest.mark.parametrize(
    ("kind", "before", "now", "new"),
    [
        ("kink", [3.0, 1.0], [3.0, 1.0], []),
        ("kink", [3.0, 1.0], [2.0, 2.9], [2.0]),  # the second is worse than the second was
        ("kink", [3.0], [2.0, 3.0], [2.0]),
        ("kink", [3.0, 1.0], [0.9], []),
        ("short", [2.0], [2.5], []),
        ("short", [2.0], [1.5], [1.5]),
        ("short", [2.0, 1.0], [1.5, 1.0], [1.5]),
    ],
)
def test_several_findings_of_one_place(kind: str, before: list[float], now: list[float], new: list[float]) -> None:
    baseline = Baseline()
    baseline.add("font", [found(value, kind) for value in before])
    fresh = baseline.new("font", [found(value, kind) for value in now])
    assert [item.value for item in fresh] == new
    assert len(baseline.new("another", [found(value, kind) for value in now])) == len(now)
    other_place = [found(value, kind, segment=5) for value in now]
    assert baseline.new("font", other_place) == other_place


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "is not JSON"),
        ("[]", "is no baseline"),
        ('{"format": "glyphspline baseline 2", "fonts": {}}', "is no baseline"),
        ('{"format": "glyphspline baseline 1"}', "is a broken baseline"),
        ('{"format": "glyphspline baseline 1", "fonts": {"a": [["b", "kink", 0]]}}', "is a broken baseline"),
    ],
)
def test_files_that_are_no_baseline(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "known.json").write_text(text)
    result = checked(drawings(tmp_path / "font", FAULTS), "--baseline", tmp_path / "known.json")
    assert result.exit_code == 2
    assert f"known.json: {words}" in result.stderr


def test_thresholds_come_from_files_and_the_command_line_wins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    font = drawings(tmp_path / "font", FAULTS)

    def used(*more: str) -> tuple[float, float, float, list[str]]:
        found = data_of(font, *more)
        own = found["thresholds"]
        glyphs = [item["glyph"] for item in found["fonts"][0]["findings"]]
        return own["kink"], own["corner_angle"], own["short"], glyphs

    assert used() == (0.5, 12.0, 3.0, ["five", "two", "jump"])
    project = (
        '[tool.glyphspline]\ntolerance = 4\n[tool.glyphspline.check]\nkink = 3\nkinds = ["kink"]\ncorner-angle = 20\n'
    )
    Path("pyproject.toml").write_text(project)
    assert used() == (3, 20.0, 3.0, ["five"])
    Path("mine.toml").write_text("[check]\nshort = 4.5\nkink = 1.5\n")
    assert used("--config", "mine.toml") == (1.5, 20.0, 4.5, ["five", "two"])
    assert used("--config", "mine.toml", "--thresholds", "kink=6") == (6, 20.0, 4.5, [])
    # A turn below the threshold of kinks is smooth, and its curvature is compared.
    assert used("--thresholds", "short=1", "--corner-angle", "30", "--kinds", "jump") == (3, 30.0, 1.0, ["jump", "two"])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[check]\nkinck = 3", "mine.toml: no option 'kinck'"),
        ("[check]\nkink = 'a lot'", "mine.toml: the threshold kink is above 0 and up to a million, not 'a lot'"),
        ("[check]\nkink = true", "mine.toml: the threshold kink is above 0"),
        ("[check]\nshort = 0", "mine.toml: the threshold short is above 0"),
        ("[check]\nthresholds = 'kink=1'", "mine.toml: no option 'thresholds'"),
        ("check = 3", "mine.toml: check is no table"),
        ("kink = 3", "mine.toml: has no table of settings for 'check'"),
        ("[check]\nloglevel = 'LOUD'", "LOUD"),
    ],
)
def test_settings_that_are_none_are_refused(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(text)
    result = checked(drawings(tmp_path / "font", FAULTS), "--config", tmp_path / "mine.toml")
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.replace("│", " ").split())


def test_no_other_command_reads_the_settings_of_check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pyproject.toml").write_text("[tool.glyphspline]\ncount = 20\n[tool.glyphspline.check]\nkink = 3\n")
    arguments = [
        "convert",
        str(FONTS / "kouzan-gyosho.ttf"),
        "--text",
        "O",
        "--out",
        "out",
        "--format",
        "svg",
        "-j",
        "0",
    ]
    result = runner.invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert json.loads(Path("out/run.json").read_text())["options"]["count"] == 20


def page_of(path: Path) -> tuple[str, dict[str, Any]]:
    text = path.read_text(encoding="utf-8")
    setup = re.search(r'<script type="application/json" id="setup">(.*?)</script>', text, re.DOTALL)
    assert setup
    return text, json.loads(setup[1])


def test_the_page_stands_alone_and_has_what_json_has(tmp_path: Path) -> None:
    font = drawings(tmp_path / "font", {**FAULTS, "<i>&": turning(3)})
    result = checked(font, "--html", tmp_path / "a.html")
    assert result.exit_code == 0, result.output
    text, setup = page_of(tmp_path / "a.html")
    assert not re.search(r'(?:src|href)="(?!#)|url\(|@import', text.split('id="setup"')[0])
    script = re.search(r"<script>(.*?)</script>", text, re.DOTALL)
    assert script
    assert b64encode(sha256(script[1].encode()).digest()).decode() in text.split("</head>")[0]
    findings = data_of(font)["fonts"][0]["findings"]
    kinds = [name for name, _ in setup["kinds"]]
    assert [(row[1], kinds[row[3]], *row[4:9]) for row in setup["rows"]] == [
        (f["glyph"], f["kind"], f["contour"], f["segment"], *f["point"], f["sentence"]) for f in findings
    ]
    source = gs.open_source(font)
    for row in setup["rows"]:
        drawn = setup["outlines"][row[10]]
        assert drawn.startswith("M")
        x, y = source.outline(row[1]).contours[row[4]].points[source.outline(row[1]).contours[row[4]].offsets[row[5]]]
        assert drawn.startswith(f"M{x:g} {-y:g}")
    switches = re.findall(r'data-kind="(\d+)" checked><i></i>(\w+) <span>(\d+)</span>', text)
    assert switches == [("0", "kink", "3"), ("1", "jump", "1")]


def test_every_kind_has_its_share_of_the_drawings() -> None:
    many = [found(9 - k / 1000, "kink", segment=k) for k in range(3000)]
    few = [found(9 - k / 1000, "short", level="INFO", segment=k) for k in range(40)]
    some = [found(9 - k / 1000, "jump", level="INFO", segment=k) for k in range(700)]
    every = sorted([*few, *many, *some], key=severity)
    drawn = [every[k] for k in sorted(to_draw(every, 1000))]
    counts = {kind: [item for item in drawn if item.kind == kind] for kind in ("kink", "jump", "short")}
    assert {kind: len(items) for kind, items in counts.items()} == {"kink": 480, "jump": 480, "short": 40}
    assert counts["kink"] == many[:480]
    assert len(to_draw(every[:10])) == 10


def test_every_kind_is_named_in_the_help() -> None:
    result = runner.invoke(app, ["check", "--help"], env={"COLUMNS": "200"})
    words = " ".join(result.stdout.split())
    assert all(re.search(rf"\b{kind.name}\b", words) for kind in KINDS)
