"""DXF files opened and extruded in CAD kernels: FreeCAD's importer (freecadcmd), and OCCT (the module OCP), if found.

    python scripts/check_cad.py [FONT …] [--text 龍g好] [--looks smooth,sharp,g2] [--kinds spline,…] [--brief]

For each character, and for smooth contours, corners, and cubics that share tangents, as splines, arcs and polylines:
the file is imported, its edges are joined to wires, the wires to a face with holes, and the face is extruded. Exit
status 1 if a kernel finds a wire open or the solid not valid, or if the area inside the imported edges is not that of
the curves (of the polygons, for polylines), which is computed without the kernel, within 1e-5; or if the volume of
OCCT's mesh is not this area times the height within 2 %. A wall with the corners of a contour in one face takes OCCT
tens of seconds to mesh, so that of splines is not.

What a kernel says of the volume of the exact solid is printed as "said" and not judged: quadrature along an edge of
many spans is off by several per cent, and more. A contour that crosses or touches itself, or another, makes no valid
solid. Those that do by :mod:`glyphspline.curves.crossings` are named, and nothing of them is judged.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import numpy as np

import glyphspline as gs
from glyphspline.curves.crossings import meetings
from glyphspline.curves.integrals import area
from glyphspline.outlines.outline import Contour, Contours
from glyphspline.outlines.polygons import flattened, polygons_of
from glyphspline.outlines.segments import all_cubics
from glyphspline.types import FloatArray
from glyphspline.writers.dxf import holes, without_spurs
from glyphspline.writers.settings import DxfKind, Settings

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


def in_freecad(jobs: list[dict[str, Any]], folder: Path) -> list[dict[str, Any]]:
    """What FreeCAD makes of the files; its own importer reads them."""
    (folder / "jobs.json").write_text(json.dumps(jobs))
    macro = folder / "macro.py"
    macro.write_text(IN_FREECAD.format(jobs=str(folder / "jobs.json"), said=str(folder / "said.json")))
    program = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    assert program is not None
    # Without a script's end freecadcmd reads commands. The status says nothing: some builds crash when they close.
    environment = {**os.environ, "HOME": str(folder)}
    subprocess.run(
        [program, str(macro)], stdin=subprocess.DEVNULL, capture_output=True, timeout=60 * len(jobs), env=environment,
        check=False,
    )  # fmt: skip
    return json.loads((folder / "said.json").read_text())


def in_occt(job: dict[str, Any]) -> dict[str, Any]:
    """What OCCT makes of the entities as ezdxf reads them, knots and control points as they are."""
    import ezdxf
    from OCP.BRep import BRep_Tool
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.Geom import Geom_BSplineCurve
    from OCP.gp import gp_Pnt, gp_Vec
    from OCP.GProp import GProp_GProps
    from OCP.TColgp import TColgp_Array1OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
    from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_ListOfShape

    def edges(entity: Any) -> list[Any]:
        if entity.dxftype() == "LWPOLYLINE":
            return [
                BRepBuilderAPI_MakeEdge(gp_Pnt(*line.dxf.start), gp_Pnt(*line.dxf.end)).Edge()
                for line in entity.virtual_entities()
            ]
        if entity.dxftype() == "LINE":
            return [BRepBuilderAPI_MakeEdge(gp_Pnt(*entity.dxf.start), gp_Pnt(*entity.dxf.end)).Edge()]
        values, counts = np.unique(np.array(entity.knots), return_counts=True)
        poles = TColgp_Array1OfPnt(1, len(entity.control_points))
        knots, multiplicities = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
        for k, point in enumerate(entity.control_points, 1):
            poles.SetValue(k, gp_Pnt(*map(float, point)))
        for k, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True), 1):
            knots.SetValue(k, value)
            multiplicities.SetValue(k, count)
        curve = Geom_BSplineCurve(poles, knots, multiplicities, entity.dxf.degree, False)
        return [BRepBuilderAPI_MakeEdge(curve).Edge()]

    def triangles(solid: Any) -> FloatArray:
        found, faces = [], TopExp_Explorer(solid, TopAbs_FACE)
        while faces.More():
            face = TopoDS.Face_s(faces.Current())
            place = TopLoc_Location()  # top and bottom are one face at two places
            mesh = BRep_Tool.Triangulation_s(face, place)
            move = place.Transformation()
            points = np.array([mesh.Node(k).Transformed(move).Coord() for k in range(1, mesh.NbNodes() + 1)])
            corners = np.array([mesh.Triangle(k).Get() for k in range(1, mesh.NbTriangles() + 1)]) - 1
            found.append(points[corners if face.Orientation() == TopAbs_FORWARD else corners[:, ::-1]])
            faces.Next()
        return np.concatenate(found)

    document = ezdxf.readfile(job["path"])  # type: ignore[attr-defined]
    group_of = {entity.dxf.handle: name for name, group in document.groups for entity in group}
    contours: dict[str, list[Any]] = {}
    for entity in document.modelspace():
        contours.setdefault(group_of.get(entity.dxf.handle, entity.dxf.handle), []).append(entity)
    count, area, volume, said, closed, invalid = 0, 0.0, 0.0, 0.0, True, []
    for k, contour in enumerate(contours.values()):  # each contour a solid: holes are not told whose they are
        sign = 1.0 if contour[0].dxf.layer == "outlines" else -1.0
        builder, parts = BRepBuilderAPI_MakeWire(), TopTools_ListOfShape()
        for edge in (edge for entity in contour for edge in edges(entity)):
            parts.Append(edge)
            count += 1
        builder.Add(parts)
        wire = builder.Wire()
        closed &= wire.Closed()
        face = BRepBuilderAPI_MakeFace(wire, True).Face()
        solid = BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, job["height"])).Shape()
        if not BRepCheck_Analyzer(solid).IsValid():
            invalid.append(k)
        found = GProp_GProps()
        BRepGProp.VolumeProperties_s(solid, found)
        said += sign * abs(found.Mass())
        if job["kind"] != "spline":
            # Millimetres between a mesh and its solid.
            BRepMesh_IncrementalMesh(solid, 0.02, False, 0.5, False)
            volume += sign * abs(float(np.linalg.det(triangles(solid)).sum()) / 6)
        found = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, found, 1e-6, False)
        area += sign * abs(found.Mass())
    facts = {"edges": count, "wires": len(contours), "closed": closed, "valid": not invalid, "invalid": invalid}
    return facts | {"area": area, "said": said} | ({"volume": volume} if job["kind"] != "spline" else {})


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
    """Check, and print a line for each file and kernel; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fonts", nargs="*", default=["fonts_test/kouzan-kaisho.ttf"])
    parser.add_argument("--text", default="龍g好")
    parser.add_argument("--height", type=float, default=5.0)
    parser.add_argument("--looks", default=",".join(LOOKS))
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--brief", action="store_true", help="print what is bad alone")
    given = parser.parse_args()
    kernels: dict[str, Callable[[list[dict[str, Any]], Path], list[dict[str, Any]]]] = {}
    if shutil.which("freecadcmd") or shutil.which("FreeCADCmd"):
        kernels["FreeCAD"] = in_freecad
    if importlib.util.find_spec("OCP"):
        kernels["OCCT"] = lambda jobs, _: list(map(in_occt, jobs))
    if not kernels:
        print("neither freecadcmd nor OCP is here")
        return 1
    bad, contours, named = 0, 0, 0
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
                    itself = [c for c, d in meeting if c == d]
                    contours, named = contours + len(result.contours), named + len(itself)
                    for kind in given.kinds.split(","):
                        file = folder / f"{Path(path).stem}-{name}-{look}-{kind}.dxf"
                        file.write_text(gs.to_dxf(result, size=f"{SIZE:g}mm", dxf=kind))
                        area = true_area(result, kind)
                        jobs.append({
                            "path": str(file), "height": given.height, "kind": kind, "area": area,
                            "itself": itself, "simple": not meeting,
                        })  # fmt: skip
        for kernel, check in kernels.items():
            for job, said in zip(jobs, check(jobs, folder), strict=True):
                good, true = "error" not in said and said["closed"], job["area"]
                if good and (job["simple"] or (kernel == "OCCT" and not job["itself"])):
                    off = said["off"] = [
                        said["area"] / true - 1,
                        float(said.get("volume", true * given.height)) / true / given.height - 1,
                    ]
                    good = said["valid"] and abs(off[0]) < 1e-5 and abs(off[1]) < 0.02
                elif "invalid" in said:
                    good &= {*said["invalid"]} <= {*job["itself"]}
                bad += not good
                if not (good and given.brief):
                    details = ", ".join(f"{key} {value}" for key, value in said.items())
                    print(f"{'ok ' if good else 'BAD'} {kernel} {Path(job['path']).stem}: {details}")
    met = f"{contours} contours of which {named} meet themselves"
    print(f"{len(jobs)} files, {met}; {', '.join(kernels)}: {bad or 'none'} bad")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
