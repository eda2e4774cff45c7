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


def refused(*words: str) -> None:
    """The next step raises an error whose text has all `words` (patterns), and no body moves."""
    before = [tuple(b.state.pos) for b in O.bodies if b]
    with pytest.raises((RuntimeError, ValueError)) as caught:
        O.step()
    _hasWords(str(caught.value), words)
    assert [tuple(b.state.pos) for b in O.bodies if b] == before


def attribute_refused(make: Callable, attribute: str, value, words: tuple[str, ...], **good) -> None:
    """Neither an instance with admissible attributes `good` nor the constructor takes the value; the instance keeps its own."""
    instance = make(**good)
    before = str(getattr(instance, attribute))
    for attempt in (lambda: setattr(instance, attribute, value), lambda: make(**{attribute: value})):
        with pytest.raises(ValueError) as caught:
            attempt()
        _hasWords(str(caught.value), words)
    assert str(getattr(instance, attribute)) == before
