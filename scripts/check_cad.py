"""DXF files opened and extruded in a CAD kernel: OCCT, by FreeCAD's importer (freecadcmd).

    python -m scripts.check_cad [FONT …] [--text 龍g好] [--looks smooth,sharp,g2] [--kinds spline,…] [--brief]

For each character, and for smooth contours, corners, and cubics that share tangents, as splines, arcs and polylines:
the file is imported, its edges are joined to wires, the wires to a face with holes, and the face is extruded. Exit
status 1 if a wire is open or the solid not valid, or if the area inside the imported edges is not that of the curves
(of the polygons, for polylines), which is computed without the kernel, within 1e-5.

What the kernel says of the volume of the exact solid is printed as "said" and not judged: quadrature along an edge of
many spans is off by several per cent, and more. A contour that crosses or touches itself, or another, makes no valid
solid. Those that do by :mod:`glyphspline.curves.crossings` are named, and nothing of them is judged.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, get_args

import numpy as np

import glyphspline as gs
from glyphspline.curves.crossings import meetings
from glyphspline.curves.integrals import area
from glyphspline.outlines.outline import Contour, Contours
from glyphspline.outlines.polygons import flattened, polygons_of
from glyphspline.outlines.segments import all_cubics
from glyphspline.plugins.cad.dxf import holes, without_spurs
from glyphspline.writers.settings import DxfKind, Settings

from .survey import parser

SIZE = 20.0
"""Millimetres from descender to ascender."""

KINDS: tuple[DxfKind, ...] = get_args(DxfKind)

LOOKS = {
    "smooth": gs.Options(corners="smooth"),
    "sharp": gs.Options(corners="sharp"),
    "g2": gs.Options(corners="sharp", continuity="g2"),
}

IN_FREECAD = """
import json, sys
import FreeCAD, Import, Part
jobs = json.load(open({jobs!r}))
said = []
for job in jobs:
    document = FreeCAD.newDocument("check")
    try:
        Import.readDXF(job["path"], document.Name)
        shapes = [o.Shape for o in document.Objects if hasattr(o, "Shape") and not o.Shape.isNull()]
        edges = [edge for shape in shapes for edge in shape.Edges]
        wires = [Part.Wire(each) for each in Part.sortEdges(edges)]
        face = Part.makeFace(wires, "Part::FaceMakerBullseye")
        solid = face.extrude(FreeCAD.Vector(0, 0, job["height"]))
        area = 0.0
        for part in face.Faces:
            for wire in part.Wires:
                enclosed = 0.0
                for edge in wire.Edges:
                    p = edge.discretize(8000 if "Spline" in type(edge.Curve).__name__ else 2)
                    swept = sum(a.x * b.y - a.y * b.x for a, b in zip(p, p[1:])) / 2
                    enclosed += swept if edge.Orientation == "Forward" else -swept
                enclosed = abs(enclosed)
                area += enclosed if wire.isSame(part.OuterWire) else -enclosed
        kinds = sorted(set(type(edge.Curve).__name__ for edge in edges))
        smooth = sorted(set(edge.Curve.Continuity for edge in edges if hasattr(edge.Curve, "Continuity")))
        said.append(dict(edges=len(edges), kinds=kinds, continuity=smooth, wires=len(wires),
                         closed=all(wire.isClosed() for wire in wires), valid=solid.isValid(),
                         area=area, said=solid.Volume))
    except Exception as error:
        said.append(dict(error=repr(error)))
    FreeCAD.closeDocument("check")
json.dump(said, open({said!r}, "w"))
"""


def in_freecad(program: str, jobs: list[dict[str, Any]], folder: Path) -> list[dict[str, Any]]:
    """What FreeCAD makes of the files; its own importer reads them."""
    (folder / "jobs.json").write_text(json.dumps(jobs))
    macro = folder / "macro.py"
    macro.write_text(IN_FREECAD.format(jobs=str(folder / "jobs.json"), said=str(folder / "said.json")))
    # Without a script's end freecadcmd reads commands. The status says nothing: some builds crash when they close.
    environment = {**os.environ, "HOME": str(folder)}
    subprocess.run(
        [program, str(macro)], stdin=subprocess.DEVNULL, capture_output=True, timeout=60 * len(jobs), env=environment,
        check=False,
    )  # fmt: skip
    return json.loads((folder / "said.json").read_text())


def not_simple(result: gs.GlyphResult) -> dict[tuple[int, int], str]:
    """The contours that cross or touch themselves or others, spurs apart, and where first."""
    curves = Contours(without_spurs(contour.curve) for contour in result.contours).arrays
    cubics = all_cubics(curves)
    found, complete = meetings(cubics, curves.offsets, np.array([0, curves.num_contours]))
    assert complete.all()
    named: dict[tuple[int, int], str] = {}
    for c, d, segment in found[:, :3].astype(np.int64).tolist():
        x, y = cubics[curves.offsets[c] + segment, 0]
        named.setdefault((c, d), f"contour {c} meets {'itself' if c == d else d} near ({x:g}, {y:g})")
    return named


def true_area(result: gs.GlyphResult, kind: str) -> float:
    """Of the ink in square millimetres, if contours do not overlap: the outlines' areas less the holes'."""
    metrics = result.outline.metrics
    em, height = metrics.units_per_em, metrics.ascender - metrics.descender
    curves = [contour.curve for contour in result.contours]
    if kind == "polyline":
        polygons = polygons_of(flattened(result.arrays.curves, Settings().flatness_for(em))[0])
        curves = [Contour(points, np.ones(len(points), dtype=np.int64)) for points in polygons]
    areas = np.abs([area(curve.cubics()) for curve in curves])
    return float(np.where(holes(result), -areas, areas).sum()) * (SIZE / height) ** 2


def main() -> int:
    """Check, and print a line for each file; returns the exit status."""
    options = parser(__doc__, text="龍g好", height=5.0, looks=",".join(LOOKS), kinds=",".join(KINDS), brief=False)
    options.add_argument("fonts", nargs="*", default=["fonts_test/kouzan-kaisho.ttf"])
    given = options.parse_args()
    program = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if not program:
        print("freecadcmd is not here")
        return 1
    bad = contours = named = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder, jobs = Path(temporary), []
        for path in given.fonts:
            font = gs.open_font(path)
            for name in font.select(text=given.text):
                for look in given.looks.split(","):
                    result = gs.convert(font.outline(name), LOOKS[look])
                    meeting = not_simple(result)
                    for which in meeting.values():
                        print(f"not judged: {Path(path).name} {name} {look}: {which}")
                    contours, named = contours + len(result.contours), named + sum(c == d for c, d in meeting)
                    for kind in given.kinds.split(","):
                        file = folder / f"{Path(path).stem}-{name}-{look}-{kind}.dxf"
                        file.write_text(gs.to_dxf(result, size=f"{SIZE:g}mm", dxf=kind))
                        true = true_area(result, kind)
                        jobs.append({"path": str(file), "height": given.height, "area": true, "simple": not meeting})
        for job, said in zip(jobs, in_freecad(program, jobs, folder), strict=True):
            good = "error" not in said and said["closed"]
            if good and job["simple"]:
                said["off"] = said["area"] / job["area"] - 1
                good = said["valid"] and abs(said["off"]) < 1e-5
            bad += not good
            if not (good and given.brief):
                details = ", ".join(f"{key} {value}" for key, value in said.items())
                print(f"{'ok ' if good else 'BAD'} {Path(job['path']).stem}: {details}")
    print(f"{len(jobs)} files, {contours} contours of which {named} meet themselves: {bad or 'none'} bad")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
