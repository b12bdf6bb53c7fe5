"""Writers of animations: GIF by Pillow, MP4 by ffmpeg."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile

import numpy as np
from PIL import Image

from ....errors import CaseError
from ...atomic_write import atomic_write

GIF, MP4 = ".gif", ".mp4"
_LAST_DURATION = 1.5  # duration of the last frame [s]


def ffmpeg() -> str:
    """Path of the ffmpeg program.

    Raises
    ------
    CaseError
        If ffmpeg is not installed.
    """
    found = shutil.which("ffmpeg")
    if found is None:
        raise CaseError("MP4 needs ffmpeg, which is not installed; write a .gif instead")
    return found


def write_gif(path: Path, pictures: Iterator[np.ndarray], fps: float, palette: np.ndarray) -> None:
    """Write a GIF with one palette for all pictures, which avoids flicker.

    Parameters
    ----------
    path : Path
        File to write, replaced when the animation is complete.
    pictures : iterator of ndarray of uint8, shape (height, width, 3)
    fps : float
        Pictures per second.
    palette : ndarray of uint8, shape (k, 3)
    """
    colors = Image.new("P", (1, 1))
    colors.putpalette(palette.tobytes())
    frames = [
        Image.fromarray(picture).quantize(palette=colors, dither=Image.Dither.NONE)
        for picture in pictures
    ]
    shown = [1 / fps] * (len(frames) - 1) + [max(_LAST_DURATION, 1 / fps)]
    with atomic_write(path) as draft:
        frames[0].save(
            draft,
            format="GIF",
            save_all=True,
            append_images=frames[1:],
            duration=[
                round(100 * seconds) * 10 for seconds in shown
            ],  # GIF times are in hundredths of a second
            loop=0,
        )


def write_mp4(path: Path, pictures: Iterator[np.ndarray], fps: float) -> None:
    """Write an MP4; parameters as in `write_gif`.

    Raises
    ------
    CaseError
        If ffmpeg is not installed.
    OSError
        If ffmpeg fails.
    """
    first = next(pictures)
    height, width = (n - n % 2 for n in first.shape[:2])  # the encoder needs even numbers
    stream = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {fps:g} -i -".split()
    rest = [
        "-vf",
        f"tpad=stop_mode=clone:stop_duration={_LAST_DURATION:g}",
        "-pix_fmt",
        "yuv420p",
        "-f",
        "mp4",
    ]
    with atomic_write(path) as draft, TemporaryFile() as said:
        command = [ffmpeg(), "-y", "-loglevel", "error", *stream, *rest, str(draft)]
        encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert encoder.stdin is not None
        with suppress(BrokenPipeError):  # its error message is reported below
            for picture in chain([first], pictures):
                encoder.stdin.write(picture[:height, :width].tobytes())
            encoder.stdin.close()
        if encoder.wait() != 0:
            said.seek(0)
            lines = said.read().decode(errors="replace").strip().splitlines()
            raise OSError(f"ffmpeg: {lines[-1] if lines else f'exit code {encoder.returncode}'}")
