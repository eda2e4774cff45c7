# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in one piece, and the same run through a file: what the tests of the bits of one scene have in common."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from yade import O

from scenes import isolated, steps


@dataclass(frozen=True)
class Halves:
    """`build` makes the scene, `bits` writes its numbers, `first` and `second` are the steps before and after the file.

    With less than `fewest` contacts that carry an impulse at the end the comparison would say little.
    """

    build: Callable[[], object]
    bits: Callable[[], str]
    first: int
    second: int
    steps: Callable[[int], None] = steps
    fewest: int = 60

    def straight(self, result: str) -> None:
        """The whole run."""
        self.build()
        self.steps(self.first + self.second)
        self._write(result)

    def until_half(self, scene: str) -> None:
        """The first part, saved."""
        self.build()
        self.steps(self.first)
        O.save(scene)

    def from_half(self, scene: str, result: str) -> None:
        """The second part, from a file."""
        import contactdynamics  # noqa: F401  (a script that only loads a scene needs the classes)

        O.load(scene)
        steps(self.second)
        self._write(result)

    def _write(self, result: str) -> None:
        assert O.iter == self.first + self.second
        text = self.bits()
        assert text.count("sliding") + text.count("sticking") >= self.fewest, "the scene has too few contacts to tell anything"
        with open(result, "w") as file:
            file.write(text)


def same_bits(module: str, folder: Path) -> None:
    """The functions straight, until_half and from_half of a module of cases, each in a process of its own, with one and with two threads."""
    isolated("yade", module, "straight", folder / "one")
    isolated("yade", module, "straight", folder / "two", threads=2)
    isolated("yade", module, "until_half", folder / "half.yade.gz", threads=2)
    isolated("yade", module, "from_half", folder / "half.yade.gz", folder / "second")
    expected = (folder / "one").read_text()
    assert (folder / "two").read_text() == expected
    assert (folder / "second").read_text() == expected
