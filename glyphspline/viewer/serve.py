"""Runs the viewer on the loopback interface only."""

from __future__ import annotations

import socket
import webbrowser
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from ..errors import GlyphsplineError
from .app import make_app

HOST = "127.0.0.1"


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
