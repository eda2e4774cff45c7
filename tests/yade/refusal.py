# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors that a test expects: raised, clear, and without effect."""

from __future__ import annotations

import re
from typing import Callable

import pytest
from yade import O


def _hasWords(text: str, words: tuple[str, ...]) -> None:
    for word in words:
        assert re.search(word, text), f"{word!r} is missing in the message: {text}"


def _places() -> list[str]:
    # As text, because what is no number is not equal to itself.
    return [" ".join(float(x).hex() for x in b.state.pos) for b in O.bodies if b]


def refused(*words: str, before_motion: bool = True) -> None:
    """The next step raises an error whose text has all `words` (patterns), and no body moves unless the mistake is found behind the integrator only."""
    before = _places()
    with pytest.raises((RuntimeError, ValueError)) as caught:
        O.step()
    _hasWords(str(caught.value), words)
    if before_motion:
        assert _places() == before, f"a body has moved before the error: {caught.value}"


def attribute_refused(make: Callable, attribute: str, value, words: tuple[str, ...], **good) -> None:
    """Neither an instance with admissible attributes `good` nor the constructor takes the value; the instance keeps its own."""
    instance = make(**good)
    before = str(getattr(instance, attribute))
    for attempt in (lambda: setattr(instance, attribute, value), lambda: make(**{attribute: value})):
        with pytest.raises(ValueError) as caught:
            attempt()
        _hasWords(str(caught.value), words)
    assert str(getattr(instance, attribute)) == before
