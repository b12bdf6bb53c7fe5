"""Solutions and states of a model: values at contact points, fields on its meshes, tables."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from dolfinx import fem

from ..errors import CaseError
from ..results import Result
from ..simulation.results.recording import Snapshot
from .body import MeshBody
from .user_mesh import UserMeshes


@dataclass(frozen=True)
class PointValues:
    """Quantity at the contact points; numpy functions take it as an array.

    Attributes
    ----------
    name : str
    unit : str
    values : ndarray, shape (n,)
    points : ndarray, shape (n, gdim)
        Positions on body 1 [m].
    position : ndarray, shape (n,)
        Arc length along the contact; NaN in space [m].
    weights : ndarray, shape (n,)
        Areas [m²].
    """

    name: str
    unit: str
    values: np.ndarray
    points: np.ndarray
    position: np.ndarray
    weights: np.ndarray

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        return np.array(self.values, dtype=dtype, copy=True)

    def plot(self, axes=None):
        """Draw the quantity along the contact, or over x and y in space; returns the axes."""
        import matplotlib.pyplot as plt

        axes = plt.figure().gca() if axes is None else axes
        if np.isnan(self.position).any():
            drawn = axes.scatter(*self.points[:, :2].T, c=self.values)
            axes.figure.colorbar(drawn, ax=axes, label=f"{self.name} [{self.unit}]")
            axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
            return axes
        axes.plot(self.position, self.values)
        axes.set(xlabel="position along the contact [m]", ylabel=f"{self.name} [{self.unit}]")
        return axes

    def to_dataframe(self):
        """Pandas frame of the points and values."""
        axes = dict(zip("xyz", self.points.T, strict=False))
        return frame(axes | {"s": self.position, "weight": self.weights, self.name: self.values})


def frame(columns: Any):
    """Pandas frame of columns, or of rows.

    Raises
    ------
    CaseError
        If pandas is not installed.
    """
    try:
        import pandas as pd
    except ImportError:
        raise CaseError("to_dataframe: needs pandas (Debian: python3-pandas)") from None
    return pd.DataFrame(columns)


class ContactResults(ABC):
    """Contact and bodies in one state of a model.

    Attributes
    ----------
    meshes : UserMeshes
    """

    meshes: UserMeshes

    @property
    @abstractmethod
    def snapshot(self) -> Snapshot:
        """Contact and solved bodies."""

    def pressure(self, face: Any) -> PointValues:
        """Contact pressure of an interface."""
        return self._at_points(face, "pressure", "Pa", self.snapshot.interface.pressure)

    def gap(self, face: Any) -> PointValues:
        """Gap of an interface, positive where it is open."""
        return self._at_points(face, "gap", "m", self.snapshot.interface.gap)

    def shape(self, face: Any) -> PointValues:
        """Height of the unloaded worn face above its lowest point."""
        return self._at_points(face, "shape", "m", self.snapshot.interface.shape)

    def wear(self, face: Any, body: MeshBody) -> PointValues:
        """Wear depth of the face of a body."""
        depths = self.snapshot.interface.wear_1, self.snapshot.interface.wear_2
        return self._at_points(face, "wear", "m", depths[self._side(face, body, "wear")])

    def surface_temperature(self, face: Any, body: MeshBody) -> PointValues:
        """Temperature of the face of a body; NaN without heat."""
        both = self.snapshot.interface.temperature_1, self.snapshot.interface.temperature_2
        values = both[self._side(face, body, "temperature")]
        return self._at_points(face, "temperature", "K", values)

    def temperature(self, body: MeshBody) -> fem.Function:
        """Temperature of a body on its mesh [K]; NaN outside of it. Every rank calls.

        Raises
        ------
        CaseError
            If the model has no heat, or the body has been remeshed.
        """
        system, heated = self.snapshot.system, self.snapshot.bodies.temperatures
        if system.thermal is None or heated is None:
            raise CaseError("temperature: the model has no heat")
        spaces, values = system.thermal.conduction.spaces, heated.rise + system.thermal.ambient
        return self.meshes.function(body, system, spaces, values, "temperature")

    def displacement(self, body: MeshBody) -> fem.Function:
        """Displacement of a body on its mesh, that of the holder included [m]; NaN outside of it.

        Every rank calls.
        """
        now, spaces = self.snapshot, self.snapshot.system.elastic.spaces
        return self.meshes.function(body, now.system, spaces, now.displacement, "displacement")

    def to_dataframe(self):
        """Pandas frame of the interface, a row per contact point; columns in SI."""
        interface = self.snapshot.interface
        return frame({f.name: getattr(interface, f.name) for f in fields(interface)})

    def _at_points(self, face: Any, name: str, unit: str, values: np.ndarray) -> PointValues:
        index, contacts = self._index(face, name), self.snapshot.system.contacts
        pairing = contacts.each[index]
        at = pairing.on_body_1, pairing.position, pairing.weights
        return PointValues(name, unit, values[contacts.ranges[index]], *at)

    def _index(self, face: Any, name: str) -> int:
        """Index of an interface in the model."""
        wanted = {surface.name for surface in getattr(face, "faces", ())}
        for index, interface in enumerate(self.snapshot.system.model.interfaces):
            if set(interface.faces) == wanted:
                return index
        raise CaseError(f"{name}: found {face!r}; must be an interface of the model")

    def _side(self, face: Any, body: MeshBody, name: str) -> int:
        """0 for the first body of an interface, 1 for the second one."""
        pair = self.snapshot.system.model.interfaces[self._index(face, name)].bodies
        if self.meshes.index(body) not in pair:
            raise CaseError(f"{name}: {body.name!r} is no body of this interface")
        return pair.index(self.meshes.index(body))


@dataclass(frozen=True)
class ModelSolution(ContactResults):
    """Solution of an analysis.

    Attributes
    ----------
    result : Result
        All tables and the summary, as of `thermowear.run`.
    """

    meshes: UserMeshes
    final: Snapshot
    result: Result

    @property
    def snapshot(self) -> Snapshot:
        return self.final

    @property
    def summary(self) -> dict:
        """Numbers in SI, the unit in each key."""
        return self.result.summary

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of the history in SI; empty for analyses without steps."""
        rows = [asdict(row) for row in self.result.history]
        return {key: np.array([row[key] for row in rows]) for key in (rows[0] if rows else ())}
