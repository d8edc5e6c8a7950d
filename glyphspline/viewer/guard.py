"""Access control: only pages of this server. A page elsewhere must not read a font through the visitor's browser."""

from __future__ import annotations

from collections.abc import Iterable

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

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


class Guard:
    """Answers only requests whose ``Host`` is one of ``hosts`` and whose ``Origin``, if any, is a page there.

    Checking the host prevents DNS rebinding: a foreign name that resolves to this machine.
    """

    def __init__(self, app: ASGIApp, hosts: Iterable[str]) -> None:
        self.app = app
        self.hosts = frozenset(hosts)
        self.origins = frozenset(f"http://{host}" for host in self.hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse the request, or pass it on and add the headers to the response."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":
            return
        refusal = self.refusal(scope["method"], Headers(scope=scope))
        app: ASGIApp = PlainTextResponse(refusal, status_code=403) if refusal else self.app

        async def send_guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        await app(scope, receive, send_guarded)

    def refusal(self, method: str, headers: Headers) -> str | None:
        """Why a request is refused, or None."""
        if headers.get("host") not in self.hosts:
            return "wrong host"
        if "origin" in headers and headers["origin"] not in self.origins:
            return "wrong origin"
        if headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            return "asked for by another site"
        if method == "POST" and headers.get("content-type") != "application/json":
            return "not JSON"
        return None
