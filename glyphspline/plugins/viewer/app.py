"""The viewer's server, on the loopback interface only: the page and its files, the font, and what the page asks for.

A page elsewhere must not read a font through the visitor's browser: :func:`guard` answers only pages of this server.
"""

from __future__ import annotations

import json
import socket
import webbrowser
from collections.abc import Callable, Collection, Iterable
from contextlib import closing
from dataclasses import asdict, replace
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.middleware.base import BaseHTTPMiddleware, RequestResponseEndpoint
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, Response
from starlette.routing import Route

from ... import compiled
from ...errors import GlyphsplineError
from ...fitting.options import PRESETS, Options
from ...readers.open import axis_facts
from ...report.gallery import measures
from ...writers.svg.comb import palette
from ...writers.svg.document import to_svg
from .conversion import COMPARED, Work, glyph_payload, instance_payload, result_payload, step_payload, steps
from .requests import PageState, read_state, search

HOST = "127.0.0.1"

PACKAGES = {
    **dict.fromkeys(("viewer.html", "viewer.css", "viewer_stage.js", "viewer_chart.js", "viewer.js"), __package__),
    **dict.fromkeys(("clicking.html", "clicking.css", "clicking.js"), __package__),
    **dict.fromkeys(("theme.css", "page.js", "shapes.js"), "glyphspline.report"),
}
"""All static files and their packages: no path of a request reaches the file system."""

KINDS = {"html": "text/html", "css": "text/css", "js": "text/javascript"}

FIRST = "龍龙好gSa"
"""The first of these in the font is shown first: the paper's characters, or some with curves."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:;"
    " base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


async def guard(hosts: Collection[str], request: Request, answer: RequestResponseEndpoint) -> Response:
    """Answer a request, or refuse it unless its ``Host`` is one of ``hosts`` and its ``Origin``, if any, a page there.

    Checking the host prevents DNS rebinding: a foreign name that resolves to this machine.
    """
    refusal, headers = None, request.headers
    if headers.get("host") not in hosts:
        refusal = "wrong host"
    elif headers.get("origin") not in (None, *(f"http://{host}" for host in hosts)):
        refusal = "wrong origin"
    elif headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
        refusal = "asked for by another site"
    elif request.method == "POST" and headers.get("content-type") != "application/json":
        refusal = "not JSON"
    response = PlainTextResponse(refusal, status_code=403) if refusal else await answer(request)
    response.headers.update(HEADERS)
    return response


def serve(
    path: Path,
    face_index: int = 0,
    *,
    port: int = 0,
    browser: bool = True,
    announce: Callable[[str], None] | None = None,
) -> None:
    """Serve until interrupted.

    Args:
        path: the font file. face_index: which font of a collection.
        port: to listen on; 0 takes any free port. browser: open a page in the visitor's browser.
        announce: called with the address once it is known.

    Raises:
        FontError: the font cannot be opened. GlyphsplineError: the port is taken.
    """
    import uvicorn

    with closing(socket.socket(socket.AF_INET, socket.SOCK_STREAM)) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((HOST, port))
            listener.listen()  # from here on a page that opens early waits
        except OSError as error:
            raise GlyphsplineError(f"port {port} cannot be had: {error.strerror}") from error
        port = listener.getsockname()[1]
        app = make_app(path, face_index, hosts=(f"{HOST}:{port}", f"localhost:{port}"))
        address = f"http://{HOST}:{port}/"
        if announce:
            announce(address)
        if browser:
            webbrowser.open(address)
        config = uvicorn.Config(app, log_level="warning", access_log=False, server_header=False, lifespan="off")
        uvicorn.Server(config).run(sockets=[listener])


def make_app(path: Path, face_index: int = 0, *, hosts: Iterable[str]) -> Starlette:
    """The viewer of one font as an ASGI application.

    Args:
        path: the font file. face_index: which font of a collection.
        hosts: accepted ``Host`` headers, as in "127.0.0.1:8642".

    Raises:
        FontError: the font cannot be opened.
    """
    work = Work(path, face_index)
    routes = [
        Route("/", static),
        Route("/static/{name}", static),
        Route("/api/font", _answer(lambda request: font_facts(work))),
        Route("/api/glyphs", _answer(lambda request: search(work.font, request.query_params.get("words", "")[:200]))),
        Route("/api/compiling", _answer(lambda request: {"words": compiled.hint()})),
        *(Route(f"/api/{name}", _computed(work, make), methods=["POST"]) for name, make in ANSWERS.items()),
    ]
    return Starlette(routes=routes, middleware=[Middleware(BaseHTTPMiddleware, dispatch=partial(guard, tuple(hosts)))])


def static(request: Request) -> Response:
    """The page, the same for every font, or one of its files."""
    name = request.path_params.get("name", "viewer.html")
    if name not in PACKAGES:
        return Response("no such file", status_code=404)
    return Response(files(PACKAGES[name]).joinpath(name).read_bytes(), media_type=KINDS[name.rpartition(".")[2]])


def font_facts(work: Work) -> dict[str, Any]:
    """The facts of the font that the page needs."""
    font = work.font

    def choices(**given: Any) -> dict[str, Any]:
        options = Options(**given)
        chosen = {name: getattr(options, name) for name in ("corners", "continuity", "effort")}
        return chosen | {"sampling": "tolerance", "amount": options.tolerance_for(work.em)}

    return {
        "family": font.family,
        "style": font.style,
        "glyphs": len(font.glyph_names),
        "metrics": asdict(font.metrics),
        "axes": [axis_facts(axis) for axis in font.axes],
        "first": first_glyph(work),
        "defaults": {"variant": Options.variant} | choices(),
        "measures": measures(),
        "scale": work.scale,
        "presets": {name: choices(**values) for name, values in PRESETS.items()},
        "palette": palette(),
    }


def first_glyph(work: Work) -> str:
    """The glyph shown first: one of ``FIRST``, or else one with contours; ``.notdef`` only where there is no other."""
    font = work.font
    mapped = [font.cmap[ord(c)] for c in FIRST if ord(c) in font.cmap]
    others = [name for name in dict.fromkeys([*font.cmap.values(), *font.glyph_names]) if name != ".notdef"]
    candidates = [*mapped, *others[:200]]
    return next(filter(work.has_ink, candidates), (candidates or font.glyph_names)[0])


def glyph_answer(work: Work, state: PageState) -> dict[str, Any]:
    """The glyph by the variant of the state, and the command that converts it."""
    result = work.result(state)
    return glyph_payload(result.outline) | result_payload(result) | {"command": work.command(state)}


def compare_answer(work: Work, state: PageState) -> dict[str, Any]:
    """The polygon by the variants 1, 2 and 3, all measured, so that the same numbers are shown for each."""
    state = replace(state, options=replace(state.options, measure=True))
    return {"results": [result_payload(work.result(state, each)) for each in COMPARED]}


def masters_answer(work: Work, state: PageState) -> dict[str, Any]:
    """The glyph, converted in all masters at once, at a location; and the command that draws it along an axis."""
    if not work.font.axes:
        raise GlyphsplineError("not a variable font: it has no axes", font=str(work.path))
    result = work.in_all_masters(state.glyph, state.options)
    return instance_payload(result, dict(state.location)) | {
        "command": work.command(state, along=work.font.axes[0].tag)
    }


ANSWERS: dict[str, Callable[[Work, PageState], dict[str, Any]]] = {
    "glyph": glyph_answer,
    "compare": compare_answer,
    "masters": masters_answer,
    "steps": lambda work, state: {"steps": [step_payload(m, curves) for m, curves in steps(work.result(state))]},
    "text": lambda work, state: dict(zip(("svg", "notes"), work.text(state), strict=True)),
    "svg": lambda work, state: {"svg": to_svg(work.result(state))},
}
"""By route: the glyph; its polygon by the variants 1, 2 and 3; the glyph in all masters; the iteration of its closed
curves; the line of text; the SVG file."""


def _answer(make: Callable[[Request], Any]) -> Callable[[Request], Any]:
    async def endpoint(request: Request) -> Response:
        return JSONResponse(await run_in_threadpool(make, request))

    return endpoint


def _computed(work: Work, make: Callable[[Work, PageState], dict[str, Any]]) -> Callable[[Request], Any]:
    """An endpoint that reads a state; errors in it, or in the glyph, are answers too."""

    async def endpoint(request: Request) -> Response:
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > 200_000:  # moved vertices take most of it
                return JSONResponse({"error": "too long"}, status_code=413)
        try:
            state = read_state(json.loads(body), work.em)
            return JSONResponse(await run_in_threadpool(make, work, state))
        except (GlyphsplineError, ValueError) as error:
            return JSONResponse({"error": str(error)}, status_code=400)

    return endpoint
