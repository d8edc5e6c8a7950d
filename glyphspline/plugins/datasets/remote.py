"""Files in folders and behind URLs, by the same calls.

URLs go through fsspec: object stores such as S3, and for reading whatever else fsspec knows.

Credentials come from the environment or from a profile of the provider, as its own tools read them, and are written
nowhere.
"""

from __future__ import annotations

import os
import re
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from hashlib import file_digest, sha256
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO, TypeVar, cast
from urllib.parse import unquote, urlsplit

from ...errors import FontError, GlyphsplineError, OutputError, words_of
from ...extras import need
from ...files import is_url, local_path, make_folder, remove_partials, replacing, sizes, writing

WHOLE = frozenset({"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "memory"})
"""Protocols of stores that have a file whole or not at all."""

PATIENCE = 60.0
"""Seconds for which a store that does not answer is asked again."""

PASSING = ("ConnectionError", "TimeoutError", "HTTPClientError", "ClientConnectionError", "ServerTimeoutError")
"""Errors of a connection, by the names of their classes: libraries of providers have types of their own."""

Value = TypeVar("Value")


def shown(url: str) -> str:
    """A URL for a message, without a user's name and without a query, which may be a signature."""
    protocol, _, rest = url.partition("://")
    host, slash, path = rest.partition("/")
    path = path.partition("?")[0] if protocol.lower() in ("http", "https") else path
    return f"{protocol}://{host.rpartition('@')[2]}{slash}{path}"


def file_system(url: str) -> tuple[Any, str]:
    """The file system of a URL, and the path in it.

    Raises:
        GlyphsplineError: fsspec or what it needs for the URL is not installed; there is no such protocol; or the URL
            has credentials in it, which messages and records would repeat.
    """
    need("remote")
    from fsspec.core import url_to_fs

    if "@" in url.partition("://")[2].partition("/")[0]:
        raise GlyphsplineError(
            "credentials do not belong into a URL, but into the environment or a profile of the provider",
            font=shown(url),
        )
    try:
        system, path = url_to_fs(url, use_listings_cache=False)
    except ImportError as error:
        raise GlyphsplineError(f"{error}: pip install 'glyphspline[remote]' brings s3fs", font=shown(url)) from error
    except Exception as error:
        raise GlyphsplineError(f"is no URL that can be used: {error}", font=shown(url)) from error
    return system, str(path)


def asked(url: str, action: Callable[[Any, str], Value], kind: type[GlyphsplineError] = OutputError) -> Value:
    """What an action returns, on a URL's file system and the path in it.

    While the store does not answer, it is tried again for a minute.

    Raises:
        FileNotFoundError: there is no such file.
        GlyphsplineError: as in :func:`file_system`; or of that kind, as the store refuses or does not answer.
    """
    system, path = file_system(url)
    until, pause = time.monotonic() + PATIENCE, 0.5
    while True:
        try:
            return action(system, path)
        except (FileNotFoundError, GlyphsplineError):
            raise
        except Exception as error:  # each provider's library has its own
            passing = any(base.__name__ in PASSING for base in type(error).__mro__)
            if not passing or time.monotonic() + pause > until:
                said = " ".join(str(error).split()) or type(error).__name__
                raise kind(
                    f"the store {'does not answer' if passing else 'refuses'}: {said}", font=shown(url)
                ) from error
        time.sleep(pause)
        pause = min(2 * pause, 8.0)


def place_of(out: str | Path) -> str:
    """An output folder's absolute path or URL, without a slash at its end.

    Raises:
        GlyphsplineError: the URL cannot be used, or is not that of an object store.
    """
    local = local_path(str(out))
    if local is not None:
        return str(Path(local).absolute())
    check_whole(str(out))
    file_system(str(out))
    return str(out).rstrip("/")


def check_whole(url: str) -> None:
    """Refuse to write where others could see half a file.

    Raises:
        OutputError: the URL is not that of an object store.
    """
    if (scheme := urlsplit(url).scheme.lower()) not in WHOLE:
        stores = ", ".join(sorted(WHOLE))
        raise OutputError(f"{scheme}:// is not written to, only folders and object stores: {stores}", font=shown(url))


def put(path: str, write: Callable[[BinaryIO], object]) -> None:
    """Have a file written whole: into a store by one put; else under a temporary name, synced, then renamed.

    Raises:
        OutputError: it cannot be written; a file of this name remains unchanged.
    """
    if not is_url(path):
        make_folder(Path(path).parent)
        with replacing(Path(path), durable=True) as file:
            write(file)
        return
    check_whole(path)
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as folder:
        whole = Path(folder) / "whole"
        with writing(whole), open(whole, "xb") as file:
            write(file)
        try:
            asked(path, lambda system, there: system.put_file(str(whole), there))
        except FileNotFoundError as error:
            raise OutputError(f"cannot be written: {error}", font=shown(path)) from error


def size(path: str) -> int | None:
    """The size of a file in bytes; None if there is no file of that name."""
    if not is_url(path):
        return os.path.getsize(path) if os.path.isfile(path) else None
    with suppress(FileNotFoundError):
        found = asked(path, lambda system, there: system.info(there))
        return int(found["size"]) if found["type"] == "file" else None
    return None


def listing(folder: str) -> list[str]:
    """The names of a folder's files, sorted; none if there is no such folder. Half written files are removed."""
    if not is_url(folder):
        remove_partials(Path(folder))
        return sorted(sizes(Path(folder)))
    with suppress(FileNotFoundError):
        found = asked(folder, lambda system, there: system.ls(there, detail=True))
        return sorted(PurePosixPath(item["name"]).name for item in found if item["type"] == "file")
    return []


def read(path: str) -> BinaryIO:
    """A file open for reading at any place; of a file in a store little more than what is read is fetched.

    Raises:
        OSError: it cannot be opened.
    """
    if not is_url(path):
        return open(path, "rb")
    with missing(path, OutputError):
        # Bytes that are fetched at once of a file that is read by parts.
        return cast(BinaryIO, asked(path, lambda system, there: system.open(there, "rb", block_size=1 << 16)))


def remove(path: str) -> None:
    """Remove a file.

    Raises:
        OSError: there is no such file.
    """
    if not is_url(path):
        os.unlink(path)
        return
    with missing(path, OutputError):
        asked(path, lambda system, there: system.rm_file(there))


@contextmanager
def missing(url: str, kind: type[GlyphsplineError]) -> Iterator[None]:
    """Turn a FileNotFoundError within into an error of a kind."""
    try:
        yield
    except FileNotFoundError as error:
        raise kind("there is no such file", font=shown(url)) from error


def fetch_fonts(url: str, suffixes: frozenset[str]) -> list[Path]:
    """Copies of the fonts behind a URL, in the user's cache, each in a folder named by its content.

    Args:
        url: of a file, a folder (searched to the bottom) or a glob. suffixes: of fonts in a folder.

    Raises:
        FontError: there are none, or the store refuses or does not answer.
        OutputError: the cache cannot be written to.
    """
    path = file_system(url)[1]
    is_web = urlsplit(url).scheme.lower() in ("http", "https")
    with missing(url, FontError):
        if not is_web and re.search(r"[*?[]", path):
            found = sorted(asked(url, lambda system, path: system.glob(path), FontError))
        elif not is_web and asked(url, lambda system, path: system.info(path), FontError)["type"] == "directory":
            every = asked(url, lambda system, path: system.find(path), FontError)
            found = sorted(item for item in every if PurePosixPath(item).suffix.lower() in suffixes)
        else:
            found = [path]
        if not found:
            raise FontError("there are no fonts", font=shown(url))
        folder = cache_folder("fonts")
        with ThreadPoolExecutor(8) as threads:
            return list(threads.map(lambda item: _fetched(url, item, folder), found))


def _fetched(url: str, path: str, folder: Path) -> Path:
    """A copy of a file in a folder named by its content."""
    handle, partial = tempfile.mkstemp(prefix=".", suffix=".part", dir=folder)
    os.close(handle)
    try:
        asked(url, lambda system, _: system.get_file(path, partial), FontError)
        with open(partial, "rb") as file:
            digest = file_digest(file, "sha256").hexdigest()
        place = folder / digest / file_name(path)
        if not place.is_file():
            place.parent.mkdir(exist_ok=True)
            os.replace(partial, place)
        return place
    finally:
        Path(partial).unlink(missing_ok=True)


def file_name(path: str) -> str:
    """The name of a file behind a URL, such as any system has it."""
    path = urlsplit(path).path if path.startswith(("http://", "https://")) else path
    name = re.sub(r'[\\/:*?"<>|\x00-\x1f]', "_", unquote(path).rstrip("/").rpartition("/")[2])[-100:]
    return name if name.strip(".") else "font"


@contextmanager
def folder_of_record(out: str) -> Iterator[Path]:
    """The folder with the record of a run: the output folder, or for a URL one in the user's cache, if there is one."""
    if not is_url(out):
        yield Path(out)
        return
    name = re.sub(r"[^A-Za-z0-9]+", "-", out)[-50:] + f"-{sha256(out.encode()).hexdigest()[:16]}"
    with tempfile.TemporaryDirectory(prefix="glyphspline-") as passing:
        try:
            folder = cache_folder("runs") / name
        except OutputError:  # the run goes on after the last finished shard
            folder = Path(passing) / name
        yield folder
        with suppress(OSError):  # another run has begun there
            folder.rmdir()


def cache_folder(name: str) -> Path:
    """A folder of that name in the user's cache.

    Raises:
        OutputError: it cannot be made.
    """
    from platformdirs import user_cache_dir

    folder = Path(user_cache_dir("glyphspline", appauthor=False)) / name
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError as error:
        raise OutputError(f"cannot be made: {words_of(error)}", font=str(folder)) from error
    return folder
