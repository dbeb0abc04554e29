"""Exceptions: one root, and bad input is also a ValueError."""

from __future__ import annotations


class BipenaltyError(Exception):
    """Root of everything this package raises on purpose."""


class InputError(BipenaltyError, ValueError):
    """Bad input; the message names the object, the value, the bound and the remedy."""


class RunError(BipenaltyError, RuntimeError):
    """A run ended early; `result` holds what it had recorded."""

    def __init__(self, message: str, result: object = None) -> None:
        super().__init__(message)
        self.result = result
