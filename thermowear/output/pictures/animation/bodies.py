"""Panels of the bodies and of their contact face, with one colour range for all frames."""

from __future__ import annotations

import numpy as np

from ....results import FIELDS
from ..maps import draw_colors, triangulated
from ..panels import label_coordinates
from ..scales import COLORS, add_color_bar, color_limits, contact_window, inside, proportion, whole
from ..section import read_section
from .states import FrameSequence, FrameState, ScenePanel

_SCALE = 0.05  # width of the colour bar relative to the panel


class SectionPanel(ScenePanel):
    """Panel with deformed 2D bodies: whole, or a window around a small contact."""

    def __init__(self, frames: FrameSequence):
        self._frames = frames
        self.sections = {s.time: read_section(s.file).displaced() for s in frames.states}
        sections = self.sections.values()
        points = np.concatenate([section.points for section in sections])
        interfaces = [state.interface for state in frames.states]
        self.window = contact_window(interfaces, points) or whole(points)
        self.shape = proportion(self.window)
        seen = [s.fields[frames.field][inside(s.points, self.window)] for s in sections]
        self.limits = color_limits(*seen)
        self._largest = max(values.max() for values in seen)
        self._drawn: list = []

    def prepare(self, axis) -> None:
        self._axis, name = axis, self._frames.field
        label_coordinates(axis, self._frames.states[-1].interface)
        axis.set_anchor("W")
        axis.grid(visible=False)
        place = axis.inset_axes([1.03, 0.0, _SCALE * min(1.0, self.shape), 1.0])
        options = {"cax": place, "label": FIELDS[name].axis}
        add_color_bar(axis, COLORS[name], self.limits, self._largest, **options)

    def show(self, state: FrameState) -> None:
        while self._drawn:
            self._drawn.pop().remove()
        section = self.sections[state.time]
        self._drawn = section.draw(self._axis, self._frames.field, self.limits, self.window)


class SolidPanel(ScenePanel):
    """Panel with undeformed 3D bodies and a fixed camera."""

    def __init__(self, frames: FrameSequence):
        from .. import solids

        self._frames, self._solids = frames, solids
        self.shape = solids.PIXELS[1] / solids.PIXELS[0]
        self._y = solids.middle(frames.states[-1].interface)
        surfaces = (self._surfaces(state) for state in frames.states)
        self.limits = color_limits(
            *(np.concatenate([surface[frames.field] for surface in parts]) for parts in surfaces)
        )

    def prepare(self, axis) -> None:
        name, (width, height) = self._frames.field, self._solids.PIXELS
        axis.set_axis_off()
        options = {"ax": axis, "label": FIELDS[name].axis, "shrink": 0.8}
        add_color_bar(axis, COLORS[name], self.limits, self.limits[1], **options)
        blank = np.full((height, width, 3), 255, dtype=np.uint8)
        self._image = axis.imshow(blank, interpolation="antialiased")

    def show(self, state: FrameState) -> None:
        surfaces = self._surfaces(state)
        self._image.set_data(self._solids.render(surfaces, self._frames.field, self.limits))

    def _surfaces(self, state: FrameState) -> list:
        return self._solids.clipped(self._solids.read_grid(state.file), self._y)


class FaceMap(ScenePanel):
    """Panel with a map of a quantity over the contact face."""

    def __init__(self, frames: FrameSequence, name: str):
        self._frames, self._name = frames, name
        highest = max(float(state.interface.drawn(name).max()) for state in frames.states)
        self._limits = (0.0, highest)
        self._drawn: list = []

    def prepare(self, axis) -> None:
        self._axis, data = axis, self._frames.states[-1].interface
        label_coordinates(axis, data)
        window = whole(np.stack([data.drawn("x"), data.drawn("y")], axis=1))
        axis.set(xlim=window[:2], ylim=window[2:])
        axis.grid(visible=False)
        colors = COLORS[self._name.split("_")[0]]
        options = {"ax": axis, "label": data.quantities[self._name].wrapped}
        add_color_bar(axis, colors, self._limits, self._limits[1], **options)

    def show(self, state: FrameState) -> None:
        while self._drawn:
            self._drawn.pop().remove()
        x, y, values = map(state.interface.drawn, ("x", "y", self._name))
        low, high = self._limits
        colored = draw_colors(
            self._axis, triangulated(x, y), values, self._name, vmin=low, vmax=high
        )
        self._drawn.append(colored)


def face_maps(frames: FrameSequence) -> list[FaceMap]:
    """Maps of the pressure, and of the wear depth of the body with the deeper wear."""
    depths = {name: frames.states[-1].interface[name].max() for name in ("wear_1", "wear_2")}
    deepest = max(depths, key=lambda name: depths[name])
    return [FaceMap(frames, name) for name in ("pressure", *([deepest] * (depths[deepest] > 0)))]
