"""The lines of a file of the authors' program by their words."""

from __future__ import annotations

import errno
import io
import math
import os
import stat
from typing import NoReturn

from ..errors import InputError

Vector = tuple[float, float, float]

type_count = 4  # of particles: 0 and 1 are fluids, 2 and 3 walls
first_wall = 2
longest_shown = 40  # of a word in a message


def number_text(x: float) -> str:
    """As the program writes numbers: the fewest digits that give the number again."""
    return repr(float(x)).removesuffix(".0")


def read_file(path: str) -> bytes:
    """The content of a regular file. Raises InputError."""
    try:
        mode = os.stat(path).st_mode
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if not stat.S_ISREG(mode):
        raise InputError(f"{path}: {os.strerror(errno.EISDIR if stat.S_ISDIR(mode) else errno.ENOTSUP)}")
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        raise InputError(f"{path}: cannot be read") from None


class Lines:
    """Goes over the lines that hold words, which blanks part; text after # is ignored. Every error is an InputError,
    "path:line: what"."""

    def __init__(self, path: str, content: bytes) -> None:
        self.path, self.size, self._line = path, len(content), 0
        self._rest = io.BytesIO(content.removeprefix(b"\xef\xbb\xbf"))  # the mark that some programs put before UTF-8
        self._words: list[bytes] = []

    def next(self) -> bool:
        """Whether there is a next line, which then is this one."""
        for line in self._rest:
            self._line += 1
            self._words = line.partition(b"#")[0].split()
            if self._words:
                return True
        return False

    def __len__(self) -> int:
        """Words of this line."""
        return len(self._words)

    @property
    def line(self) -> int:
        """The number of this line, from 1."""
        return max(self._line, 1)

    def word(self, place: int) -> str:
        return self._words[place].decode(errors="backslashreplace")

    def fail(self, what: str) -> NoReturn:
        raise InputError(f"{self.path}:{self.line}: {what}")

    def require_values(self, count: int, row: str) -> None:
        """Words beside the key; row: its name in the message."""
        if len(self) != count + 1:
            self.fail(f"{row}: expected {count} value{'' if count == 1 else 's'}, found {len(self) - 1}")

    def number(self, place: int) -> float:
        """A finite one."""
        word = self._words[place]
        try:
            x = float(word)
        except ValueError:
            x = math.nan
        # Python takes 1_000, and makes 0 of what is too small for a double.
        vanished = x == 0 and word.lower().partition(b"e")[0].strip(b"+-0.")
        if not math.isfinite(x) or b"_" in word or vanished:
            self.fail(f"expected a finite number, found '{self._shown(place)}'")
        return x

    def positive(self, place: int) -> float:
        x = self.number(place)
        if not x > 0:
            self.fail(f"expected a positive number, found '{self._shown(place)}'")
        return x

    def not_negative(self, place: int) -> float:
        x = self.number(place)
        if x < 0:
            self.fail(f"expected a number that is not negative, found {number_text(x)}")
        return x

    def vector(self, first: int) -> Vector:
        return self.number(first), self.number(first + 1), self.number(first + 2)

    def integer(self, place: int, least: int, most: int, what: str) -> int:
        word = self._words[place]
        digits = word.lstrip(b"+-")
        value = int(word) if len(word) <= longest_shown and digits.isdigit() and len(word) - len(digits) <= 1 else None
        if value is None or not least <= value <= most:
            self.fail(f"expected {what}, a whole number from {least} to {most}, found '{self._shown(place)}'")
        return value

    def type(self, place: int) -> int:
        return self.integer(place, 0, type_count - 1, "a type, 0 and 1 for fluids, 2 and 3 for walls")

    def _shown(self, place: int) -> str:
        word = self.word(place)
        return word if len(word) <= longest_shown else word[:longest_shown] + "..."
