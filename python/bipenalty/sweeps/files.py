"""Files that are there wholly or not at all, and the check that a store belongs to the call."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bipenalty.errors import InputError


def replace(path: Path, content: bytes, partial: Path | None = None) -> None:
    """Write a file by way of another one, `partial`, that takes its name once it is on the disk."""
    partial = path.with_name(f".{path.name}.part") if partial is None else partial
    with partial.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    os.replace(partial, path)


def sync(path: Path) -> None:
    """Put a file on the disk, if it exists."""
    with contextlib.suppress(FileNotFoundError):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def chunk_in(attrs: Mapping[str, Any]) -> int | None:
    """Runs of a task, from the attributes of a store."""
    chunk = attrs.get("chunk")
    return chunk if isinstance(chunk, int) and chunk > 0 else None


def check_call(path: Path, found: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    """Raise an InputError unless a store was made by the call that opens it."""
    theirs, ours = found.get("fingerprint"), wanted["fingerprint"]
    if theirs is None:
        raise InputError(f'store "{path}": holds no sweep, must be new or made by sweep or grid; give another path')
    if theirs != ours:
        raise InputError(
            f'store "{path}": fingerprint = {str(theirs)[:12]}, must be {ours[:12]}, that of this call: it was made by '
            f"another one ({found.get('version', 'an unknown version')} of the package; scene, axes, time step or "
            "options differ); give another path, or remove it to start anew"
        )
    if found.get("chunk") != wanted["chunk"]:
        raise InputError(f'store "{path}": has just been made by another driver of this sweep; call once more')
