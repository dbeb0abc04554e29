"""One driver at a time on a store: a lock that the operating system takes back from a driver that was killed."""

from __future__ import annotations

import contextlib
import fcntl
import os
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

from bipenalty.errors import InputError

_guard = threading.Lock()
_held: set[Path] = set()


@contextlib.contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold `.name.lock` beside a store for as long as the block runs.

    A record lock of the process, not one of the open file: the workers a driver has forked do not inherit it, so it
    is gone with the driver even where they live on. It does not keep threads of one process apart; a set does.

    Raises
    ------
    InputError : another driver holds it.
    """
    file = path.with_name(f".{path.name}.lock").resolve()
    with _guard:
        if file in _held:
            raise _in_use(path, "another thread of this process")
        handle = _acquire(path, file)
        _held.add(file)
    try:
        yield
    finally:
        with _guard, contextlib.suppress(FileNotFoundError):
            _held.discard(file)
            file.unlink()
        os.close(handle)


def _acquire(path: Path, file: Path) -> int:
    while True:
        handle = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            owner = os.read(handle, 200).decode(errors="replace").strip() or "another process"
            os.close(handle)
            raise _in_use(path, owner) from None
        # The driver before may have removed the file between the two calls: then this lock is on nothing.
        with contextlib.suppress(FileNotFoundError):
            if os.fstat(handle).st_ino == file.stat().st_ino:
                break
        os.close(handle)
    os.ftruncate(handle, 0)
    os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
    return handle


def _in_use(path: Path, owner: str) -> InputError:
    return InputError(f'store "{path}": is in use by {owner}, must be free; wait for it or end it')
