"""Writers of animations: GIF by Pillow, MP4 by ffmpeg."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from ....errors import CaseError
from ...files import atomic_write
from ..panels import BODIES

GIF, MP4 = ".gif", ".mp4"
_LAST_DURATION = 1.5  # duration of the last frame [s]
_MOST_COLORS = 255  # one more is reserved for unchanged pixels
_LINES = ("black", "0.45", "0.6", "tab:red", *BODIES)
_BLENDS = 6  # blends of a line with white, for antialiased edges


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
            duration=[round(100 * s) * 10 for s in shown],  # stored in hundredths of a second
            loop=0,
        )


def common_palette(pictures: list[np.ndarray], scale: str) -> np.ndarray:
    """Palette of the line colours and the best approximation of a colour map and of pictures.

    Parameters
    ----------
    pictures : list of ndarray of uint8, shape (height, width, 3)
    scale : str
        Name of a colour map.

    Returns
    -------
    ndarray of uint8, shape (k, 3)
        At most 255.
    """
    parts = np.linspace(0.0, 1.0, _BLENDS)[:, None]
    lines = np.concatenate([1 - parts * (1 - np.array(to_rgb(color))) for color in _LINES])
    fixed = np.unique(_as_bytes(lines), axis=0)
    height, width = pictures[0].shape[:2]
    steps = _as_bytes(mpl.colormaps[scale](np.linspace(0.0, 1.0, width))[:, :3])
    some = np.concatenate([*pictures, np.broadcast_to(steps, (height, width, 3))])
    rest = Image.fromarray(some).quantize(_MOST_COLORS - len(fixed)).getpalette()
    return np.concatenate([fixed, np.array(rest, dtype=np.uint8).reshape(-1, 3)])[:_MOST_COLORS]


def _as_bytes(colors: np.ndarray) -> np.ndarray:
    return np.round(255 * colors).astype(np.uint8)


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
    last = f"tpad=stop_mode=clone:stop_duration={_LAST_DURATION:g}"
    rest = f"-vf {last} -pix_fmt yuv420p -f mp4".split()
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
