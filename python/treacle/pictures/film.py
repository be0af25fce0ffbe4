"""Films by ffmpeg: pictures go to it through a pipe, and the file appears when it is whole."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NoReturn

from .arrays import Array
from .errors import PictureError

# What ffmpeg is told by the ending of the file. H.264 with yuv420p is what every player and browser shows.
codecs = {
    ".mp4": [
        "-c:v",
        "libx264",
        "-preset",
        "medium",
        "-crf",
        "18",
        "-pix_fmt",
        "yuv420p",
        "-movflags",
        "+faststart",
        "-f",
        "mp4",
    ],
    ".webm": ["-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0", "-row-mt", "1", "-pix_fmt", "yuv420p", "-f", "webm"],
    ".webp": ["-c:v", "libwebp_anim", "-quality", "75", "-loop", "0", "-f", "webp"],
}


def ffmpeg() -> str:
    """The program of the system, else that of the package imageio-ffmpeg. Raises PictureError."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    try:
        import imageio_ffmpeg

        packaged: str = imageio_ffmpeg.get_ffmpeg_exe()
        return packaged
    except (ImportError, RuntimeError):
        raise PictureError(
            "ffmpeg is missing; expected that of the system (apt install ffmpeg), or that of pip install '.[pictures]'"
        ) from None


def checked(path: str | Path) -> Path:
    """The path of a film whose ending says what it is. Raises PictureError."""
    path = Path(path)
    if path.suffix.lower() not in codecs:
        raise PictureError(f"{path}: expected a name that ends in {', '.join(codecs)}")
    if not path.parent.is_dir():
        raise PictureError(f"{path}: no such directory: {path.parent}")
    return path


class Film:
    """A film that is being made; with `with` it is whole at the end, or not there."""

    def __init__(self, path: str | Path, size: tuple[int, int], fps: float) -> None:
        self.path = checked(path)
        self.size = size
        self.fps = fps

    def __enter__(self) -> Film:
        self.hidden = self.path.with_name(f".{self.path.name}.tmp")
        command = [
            ffmpeg(),
            "-hide_banner",
            "-loglevel",
            "error",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-s",
            "{}x{}".format(*self.size),
        ]
        command += ["-r", f"{self.fps:g}", "-i", "-", "-an", *codecs[self.path.suffix.lower()], str(self.hidden)]
        self.messages = tempfile.TemporaryFile()
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=self.messages)
        return self

    def add(self, picture: Array) -> None:
        """Pixels, rows from the top: bytes of shape height, width, 3. Raises PictureError if ffmpeg has ended."""
        assert self.process.stdin is not None  # a pipe was asked for
        assert picture.shape == (self.size[1], self.size[0], 3)
        try:
            self.process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            self._fail()

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is not None:
                self.process.kill()
            assert self.process.stdin is not None
            with contextlib.suppress(BrokenPipeError):
                self.process.stdin.close()
            if self.process.wait() != 0 and kind is None:
                self._fail()
            if kind is None:
                self.hidden.replace(self.path)
        finally:
            self.process.wait()
            self.messages.close()
            self.hidden.unlink(missing_ok=True)

    def _fail(self) -> NoReturn:
        code = self.process.wait()
        self.messages.seek(0)
        said = self.messages.read().decode(errors="replace").strip() or "it said nothing"
        raise PictureError(f"{self.path}: ffmpeg ended with code {code}: {said}")
