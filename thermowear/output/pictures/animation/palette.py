"""Colour palette of a GIF, limited to 256 colours."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from ..panels import BODIES

_MOST = 255  # one more is reserved for unchanged pixels
_LINES = ("black", "0.45", "0.6", "tab:red", *BODIES)
_BLENDS = 6  # blends of a line with white, for antialiased edges


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
    rest = Image.fromarray(some).quantize(_MOST - len(fixed)).getpalette()
    return np.concatenate([fixed, np.array(rest, dtype=np.uint8).reshape(-1, 3)])[:_MOST]


def _as_bytes(colors: np.ndarray) -> np.ndarray:
    return np.round(255 * colors).astype(np.uint8)
