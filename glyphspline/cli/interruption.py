"""The first Ctrl-C ends a command within two seconds, whatever it is doing.

Python acts on a signal between two of its own steps, and one step of the compiler may take half a minute.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from contextlib import suppress

from .status import INTERRUPTED

WORDS = "interrupted; the same command goes on from here"


def watch() -> None:
    """End this process soon after SIGINT, from a thread that nothing holds up. For the main thread to call."""
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_wait, args=(ours, theirs), daemon=True).start()


def _wait(ours: socket.socket, theirs: socket.socket) -> None:
    while ours.recv(1) != bytes([signal.SIGINT]):
        pass
    time.sleep(0.6)  # in which a command may end in its own way, with what it has done so far written down
    end()


def end() -> None:
    """Kill the worker processes, remove the copy of standard input, make the terminal usable, say so and exit."""
    with suppress(Exception):
        if "glyphspline.runs.pool" in sys.modules:
            from ..runs.pool import kill_all

            kill_all()
        if "glyphspline.readers.open" in sys.modules:
            from ..readers.open import forget_standard_input

            forget_standard_input()
    with suppress(Exception):
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K\x1b[?25h")  # an empty line, and the cursor, which a progress bar hides
        sys.stderr.write(f"{WORDS}\n")
        sys.stderr.flush()
    os._exit(INTERRUPTED)
