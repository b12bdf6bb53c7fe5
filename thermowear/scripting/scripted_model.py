"""Model in Python: interfaces, holders and motions of bodies on users' meshes, and its analyses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np

from ..case.tables.driving import FreeMotion
from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws.distribution import InPlace
from ..laws.load_history import LoadHistory
from ..laws.time_course import TimeFunction
from ..model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ..model.heat import Heat
from ..model.holder import Holder
from ..model.interface import ContactMethod, HardnessConductance, Interface
from ..model.model import Discretisation, Model
from ..model.motion import Motion
from ..model.wear import FaceWear
from ..simulation.analyses.run import analyse, conclude, estimated
from ..simulation.model.building import build
from ..simulation.model.setup_cache import SetupCache
from ..simulation.model.system import System
from ..simulation.results.fields import sample
from ..simulation.runtime.history import Snapshot
from ..simulation.runtime.observer import Observer
from ..timer import Phases
from .body import BodySurface, MeshBody, require_surface
from .conversion import coefficient_law, number, optional, rate_law
from .march import MarchState, march
from .motion import Rotation, Translation
from .physics import by_surface
from .solution import ModelSolution
from .user_mesh import UserMeshes, user_meshes

_OF_SECTIONS = ("axisymmetric", "plane-strain", "plane-stress")


@dataclass(frozen=True, eq=False)
class FacePair:
    """Interface of two bodies.

    Attributes
    ----------
    one, other : BodySurface
        Contact faces, in any order.
    friction : float, str, InterfaceLaw or callable
        Coefficient of friction: a number, an expression, a law, or a function of some of p, v, T.
    conductance : float, str, InterfaceLaw, callable, HardnessConductance or None
        Contact conductance likewise; None: perfect contact [W/(m² K)].
    wear : mapping of MeshBody to (str, WearRate, callable or FaceWear)
        Wear rates of the bodies, also as functions of some of p, v, T, depth, mu [m/s].
    gap_conductance, partition, compliance, transverse_friction, pressure_degree, method
        See `model.interface.Interface`.
    friction_history : TimeFunction or None
        Time-dependent factor of the friction.
    """

    one: BodySurface
    other: BodySurface
    friction: Any = 0.0
    conductance: Any = None
    wear: Mapping[MeshBody, Any] = field(default_factory=dict)
    gap_conductance: Any = 0.0
    partition: float | Literal["effusivity"] = 0.5
    compliance: Any = 0.0
    transverse_friction: float = 0.0
    friction_history: TimeFunction | None = None
    pressure_degree: int | Literal["lobatto"] | None = None
    method: ContactMethod = field(default_factory=ContactMethod)

    def __post_init__(self):
        for face in self.faces:
            require_surface(face, "Interface")

    @property
    def faces(self) -> tuple[BodySurface, BodySurface]:
        """Contact faces."""
        return self.one, self.other

    def in_model(self, bodies: tuple[MeshBody, ...], closes_by_wear: bool) -> Interface:
        """Interface of a model, with the face of the held body first."""
        given = self.conductance
        if given is not None and not isinstance(given, HardnessConductance):
            given = coefficient_law(given, "Interface.conductance", "W/(m^2 K)", least=0.0)
        first, second = sorted(self.faces, key=lambda face: bodies.index(face.body))
        unknown = [body for body in self.wear if body not in bodies]
        if unknown:
            raise CaseError(f"Interface.wear: {unknown[0]!r} is no body of this interface")
        wear = {bodies.index(body): _face_wear(law, body) for body, law in self.wear.items()}
        gap = in_python(units.LeastHeatTransfer, self.gap_conductance, "Interface.gap_conductance")
        soft = self.compliance and in_python(
            units.Compliance, self.compliance, "Interface.compliance"
        )
        return Interface(
            faces=(first.name, second.name),
            friction=coefficient_law(self.friction, "Interface.friction", "", least=-np.inf),
            friction_history=self.friction_history,
            transverse_friction=number(self.transverse_friction, "Interface.transverse_friction"),
            conductance=given,
            gap_conductance=gap,
            partition=self.partition,
            wear=dict(sorted(wear.items())),
            closes_by_wear=closes_by_wear,
            compliance=soft,
            pressure_degree=self.pressure_degree,
            method=self.method,
        )


def _face_wear(given: Any, body: MeshBody) -> FaceWear:
    if isinstance(given, FaceWear):
        return given
    return FaceWear(rate_law(given, f"Interface.wear of {body.name!r}"), track=InPlace())


@dataclass(frozen=True, eq=False)
class SurfaceHolder:
    """Rigid holder of a surface, see `model.holder.Holder`.

    It presses along -y in a section and along -z in space.

    Attributes
    ----------
    surface : BodySurface
    free : sequence of str
    force, approach, tangential_force, moments, closing_moment
        Quantities; the moments about x, y and z.
    pivot, point : tuple of float or None
        By default the origin, and the pivot [m].
    history : LoadHistory or None
    surface_forces, surface_pressures : mapping of BodySurface to quantity
    """

    surface: BodySurface
    free: Sequence[str] = ("z",)
    force: Any = None
    approach: Any = None
    tangential_force: Any = 0.0
    moments: tuple[Any, Any, Any] = (0.0, 0.0, 0.0)
    closing_moment: Any = None
    pivot: tuple[Any, ...] | None = None
    point: tuple[Any, ...] | None = None
    history: LoadHistory | None = None
    surface_forces: Mapping[BodySurface, Any] = field(default_factory=dict)
    surface_pressures: Mapping[BodySurface, Any] = field(default_factory=dict)

    def __post_init__(self):
        require_surface(self.surface, "Holder")
        for name in self.free:
            if name not in get_args(FreeMotion):
                known = ", ".join(get_args(FreeMotion))
                raise CaseError(f"Holder.free: found {name!r}; must be some of: {known}")
        loads = self._largest("force"), self._largest("approach"), self.closing_moment
        given = sum(load is not None for load in loads)
        if given > 1 or not (given or self.surface_forces or self.surface_pressures):
            raise CaseError("Holder: needs one of force, approach and closing_moment")

    def in_model(self, dim: int) -> Holder:
        """Holder of a model in two or three dimensions."""
        pivot = (0.0,) * dim if self.pivot is None else self._position(self.pivot, "pivot", dim)
        point = pivot if self.point is None else self._position(self.point, "point", dim)
        force, approach = self._largest("force"), self._largest("approach")
        about_x, about_y, about_z = (
            in_python(units.SignedMoment, moment, "Holder.moments") for moment in self.moments
        )
        return Holder(
            press=(0.0,) * (dim - 1) + (-1.0,),
            pivot=pivot,
            point=point,
            free=tuple(self.free),
            force=optional(units.Force, force, "Holder.force"),
            approach=optional(units.Length, approach, "Holder.approach"),
            tangential_force=in_python(
                units.SignedForce, self.tangential_force, "Holder.tangential_force"
            ),
            moments=(about_x, about_y, about_z),
            closing_moment=optional(
                units.SignedMoment, self.closing_moment, "Holder.closing_moment"
            ),
            history=self.history,
            surface_forces=by_surface(units.Force, self.surface_forces, "Holder.surface_forces"),
            surface_pressures=by_surface(
                units.Pressure, self.surface_pressures, "Holder.surface_pressures"
            ),
        )

    def _largest(self, name: str) -> Any:
        """Load of a history at its maximum, or the constant one."""
        given = None if self.history is None else getattr(self.history, name)
        return getattr(self, name) if given is None else max(given)

    def _position(self, given: tuple[Any, ...], name: str, dim: int) -> tuple[float, ...]:
        if len(given) != dim:
            raise CaseError(f"Holder.{name}: has {len(given)} coordinates; needs {dim}")
        return tuple(in_python(units.Coordinate, x, f"Holder.{name}") for x in given)


@dataclass(frozen=True, eq=False)
class ScriptedModel:
    """Bodies in contact, with their holders and motions, and the analyses of them.

    ``dataclasses.replace`` makes a model with other loads, speeds or laws; what does not depend on
    them (mesh, factors, condensed operators) is computed once.

    Attributes
    ----------
    interfaces : sequence of FacePair
    holders : sequence of SurfaceHolder
    motions : mapping of MeshBody to (Rotation or Translation)
    heat : Heat or None
        None: isothermal.
    kinematics : str or None
        ``"axisymmetric"``, ``"plane-strain"`` or ``"plane-stress"``; None in space.
    thickness : float or quantity
        Thickness of plane models; twice that in a half model, as forces are those of the whole
        [m].
    degree : int
        Polynomial degree of displacement and temperature.
    symmetry : sequence of BodySurface
        Surfaces on planes of symmetry x = const.
    title : str

    Raises
    ------
    CaseError
        If it has more bodies, interfaces or holders than are supported, or an argument is invalid.
    """

    interfaces: Sequence[FacePair]
    holders: Sequence[SurfaceHolder]
    motions: Mapping[MeshBody, Rotation | Translation] = field(default_factory=dict)
    heat: Heat | None = None
    kinematics: Literal["axisymmetric", "plane-strain", "plane-stress"] | None = None
    thickness: Any = None
    degree: int = 2
    symmetry: Sequence[BodySurface] = ()
    title: str = ""
    _shared: dict[Any, Any] = field(default_factory=dict, repr=False)

    def __post_init__(self):
        faces = [face.body for pair in self.interfaces for face in pair.faces]
        bodies = set(faces) | {holder.surface.body for holder in self.holders} | set(self.motions)
        counts = len(self.interfaces), len(bodies), len(self.holders)
        if counts != (1, 2, 1) or len(set(faces)) != 2:
            raise CaseError(
                "Model: supported are one interface between two bodies and one holder; found "
                "{} interfaces, {} bodies and {} holders".format(*counts)
            )
        if len({body.name for body in bodies}) != len(bodies):
            raise CaseError("Model: both bodies have the same name")
        self._model(closes_by_wear=True)

    @cached_property
    def bodies(self) -> tuple[MeshBody, ...]:
        """The held body, then the other one."""
        held = self.holders[0].surface.body
        return tuple(sorted({f.body for f in self.interfaces[0].faces}, key=lambda b: b != held))

    @property
    def meshes(self) -> UserMeshes:
        """Mesh of both bodies, gathered once."""
        if self.bodies not in self._shared:
            self._shared[self.bodies] = user_meshes(self.bodies)
        return self._shared[self.bodies]

    def initial(self, observer: Observer | None = None) -> ModelSolution:
        """Contact of the unworn faces."""
        return self._solved(StaticAnalysis("initial"), observer)

    def steady(self, observer: Observer | None = None) -> ModelSolution:
        """Steady state of wear."""
        return self._solved(StaticAnalysis("steady"), observer)

    def stability(self, observer: Observer | None = None) -> ModelSolution:
        """Thermoelastic stability: critical speeds and modes."""
        return self._solved(StaticAnalysis("stability"), observer)

    def transient(
        self, until: Any, observer: Observer | None = None, **settings: Any
    ) -> ModelSolution:
        """Whole running-in; arguments as of `march`, with ``output_times`` [s]."""
        return self._solved(_transient(until, settings), observer)

    def march(
        self, until: Any, start: MarchState | None = None, **settings: Any
    ) -> Iterator[MarchState]:
        """States of a running-in, step by step; stop by leaving the loop.

        Parameters
        ----------
        until : float, quantity or ``"steady"``
            Time [s], or until the pressure is steady within ``steady_tolerance``.
        start : MarchState, optional
            State to continue from, of this model or of one with other loads, speeds or laws.
        **settings
            Other attributes of `model.analyses.TransientAnalysis`.
        """
        analysis = _transient(until, settings)
        yield from march(self.bodies, self.meshes, self._system(analysis), analysis, start)

    def fretting(self, observer: Observer | None = None, **settings: Any) -> ModelSolution:
        """Stick and slip under the history of the holder, see `model.analyses.FrettingAnalysis`."""
        return self._solved(FrettingAnalysis(**settings), observer)

    def reciprocating(
        self, amplitude: Any, frequency: Any, observer: Observer | None = None, **settings: Any
    ) -> ModelSolution:
        """Reciprocating sliding along x, see `model.analyses.ReciprocatingAnalysis`."""
        x = in_python(units.Length, amplitude, "reciprocating.amplitude")
        f = in_python(units.Frequency, frequency, "reciprocating.frequency")
        held = self.bodies[0]
        moving = replace(self, motions={held: Translation(4 * x * f)})
        analysis = ReciprocatingAnalysis(**settings, amplitude=x, frequency=f)
        return moving._solved(analysis, observer)

    def _solved(self, analysis: Analysis, observer: Observer | None) -> ModelSolution:
        """Solution of an analysis. Every rank calls."""
        observer = observer or Observer()
        system = self._system(analysis, observer)
        outcome = analyse(system, analysis, observer)
        outcome = estimated(system, analysis, outcome, observer)
        last = outcome.system or system
        fields = sample(last, outcome.state, outcome.motion)
        result = conclude(system, analysis, outcome, fields)
        if result.stopped is not None:
            raise result.stopped
        final = Snapshot(last, outcome.contact, outcome.motion, outcome.state, outcome.interface)
        return ModelSolution(self.bodies, self.meshes, final, result)

    def _system(self, analysis: Analysis, observer: Observer | None = None) -> System:
        observer = observer or Observer()
        model = self._model(closes_by_wear=not isinstance(analysis, FrettingAnalysis))
        parts = self._shared.setdefault("parts", SetupCache())
        return build(model, self.bodies[0].mesh.comm, Phases(observer.phase), parts=parts)

    def _model(self, closes_by_wear: bool) -> Model:
        held, meshes = self.holders[0].surface, self.meshes
        number(self.degree, "Model.degree", 1, 10)
        dim = meshes.tagged.points.shape[1]
        if self.kinematics not in (_OF_SECTIONS if dim == 2 else (None,)):
            raise CaseError(
                f"Model.kinematics: a mesh of a section needs one of {', '.join(_OF_SECTIONS)}, one "
                f"in space none of them; found {self.kinematics!r}"
            )
        thickness = optional(units.Length, self.thickness, "Model.thickness")
        if (self.kinematics in _OF_SECTIONS[1:]) is (thickness is None):
            raise CaseError("Model.thickness: needed for a plane model, and for no other")
        model = Model(
            kinematics=self.kinematics or "3d",
            bodies=tuple(
                body.in_model(meshes.surfaces_of(body), held if body is held.body else None)
                for body in self.bodies
            ),
            interfaces=(self.interfaces[0].in_model(self.bodies, closes_by_wear),),
            holders=(self.holders[0].in_model(dim),),
            meshes=meshes,
            discretisation=Discretisation(self.degree),
            motion=self._motion(),
            heat=self.heat,
            thickness=thickness,
            symmetry=tuple(surface.name for surface in self.symmetry),
            title=self.title,
        )
        _check_surfaces(model, meshes.tagged.surfaces)
        return model

    def _motion(self) -> Motion:
        if len(self.motions) > 1:
            raise CaseError("Model.motions: give the motion of one body, relative to the other")
        for body, motion in self.motions.items():
            return motion.relative(body is self.bodies[0], self.kinematics == "axisymmetric")
        return Motion()


def _check_surfaces(model: Model, known: Sequence[str]) -> None:
    """Reject surfaces whose facets do not bound their body."""
    holder, heat = model.holder, model.heat or Heat()
    supports = [name for body in model.bodies for name in (*body.fixed, *body.rollers)]
    loads = *holder.surface_forces, *holder.surface_pressures
    thermal = *heat.cooling, *heat.temperature, *heat.flux, *heat.power
    for name in (*model.interface.faces, *supports, *loads, *thermal, *model.symmetry):
        if name not in known:
            body, _, tag = name.rpartition(":")
            raise CaseError(f"Model: facets with the tag {tag} do not bound the body {body!r}")
    for body in model.bodies:
        if not (body.fixed or body.rollers):
            raise CaseError(f"Body {body.name!r}: is neither on a holder nor fixed")


def _transient(until: Any, settings: Mapping[str, Any]) -> TransientAnalysis:
    """Settings of a running-in until a time or the steady state."""
    if until == "steady":
        return TransientAnalysis(until="steady", **settings)
    return TransientAnalysis(end_time=in_python(units.Time, until, "march.until"), **settings)
