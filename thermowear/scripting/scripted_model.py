"""Model in Python: interfaces, holders and motions of bodies on users' meshes, and its analyses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from typing import Any, Literal, get_args

from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StabilityAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ..model.body import Body
from ..model.conditions import Heat, Holder
from ..model.interface import Interface
from ..model.model import Discretisation, Model, Solver, hanging_holders
from ..model.relative_motion import relative_motion
from ..model.tie import glued_bodies, with_glued
from ..parallel import on_root
from ..simulation.analyses.run import needs_single_solution, solve
from ..simulation.runtime.observer import Observer
from ..simulation.system.building import build
from ..simulation.system.setup_cache import SetupCache
from ..simulation.system.system import System
from ..timer import Phases
from .body import BodySurface, MeshBody
from .conversion import by_surface, number
from .face_pair import FacePair
from .face_tie import FaceTie
from .holding import Rotation, SurfaceHolder, Translation
from .march import MarchState, march
from .model_checks import check, note_flat_facets
from .solution import ModelSolution
from .user_mesh import UserMeshes, user_meshes

SOLVERS = get_args(Solver)
_OF_SECTIONS = "axisymmetric", "plane-strain", "plane-stress"


@dataclass(frozen=True, eq=False)
class ScriptedModel:
    """Bodies in contact, with their holders and motions, and the analyses of them.

    ``dataclasses.replace`` makes a model with other loads, speeds or laws; what does not depend on
    them (mesh, factors, condensed operators) is computed once.

    Attributes
    ----------
    interfaces : sequence of FacePair
    holders : sequence of SurfaceHolder
        None where supports hold all bodies, or contacts that leave a single position.
    motions : mapping of MeshBody to (Rotation or Translation)
    heat : Heat or None
        None: isothermal.
    kinematics : str or None
        ``"axisymmetric"``, ``"plane-strain"`` or ``"plane-stress"``; None in space.
    thickness : float or quantity
        Thickness of plane models; twice that in a half model, forces are of the whole [m].
    degree : int
        Polynomial degree of displacement and temperature.
    solver : str
        Linear solver of bodies in space: ``"auto"`` (by size), ``"direct"`` or ``"multigrid"``.
    symmetry : sequence of BodySurface
        Surfaces on planes of symmetry x = const.
    ties : sequence of FaceTie
        Glued faces.
    surface_pressures : mapping of BodySurface to quantity
        Pressures on surfaces of any body, towards the body [Pa].
    title : str

    Raises
    ------
    CaseError
        If bodies, interfaces and holders do not fit together, or an argument is invalid.
    """

    interfaces: Sequence[FacePair]
    holders: Sequence[SurfaceHolder] = ()
    motions: Mapping[MeshBody, Rotation | Translation] = field(default_factory=dict)
    heat: Heat | None = None
    kinematics: Literal["axisymmetric", "plane-strain", "plane-stress"] | None = None
    thickness: Any = None
    degree: int = 2
    solver: Solver = "auto"
    symmetry: Sequence[BodySurface] = ()
    ties: Sequence[FaceTie] = ()
    surface_pressures: Mapping[BodySurface, Any] = field(default_factory=dict)
    title: str = ""
    _shared: dict[Any, Any] = field(default_factory=dict, repr=False)

    def __post_init__(self):
        if not self.interfaces:
            raise CaseError("Model: needs at least one interface")
        for pair in self.interfaces:
            if pair.one.body is pair.other.body:
                raise CaseError("Model: an interface has both faces on the same body")
        floating = [holder for holder in self.holders if holder.free and not holder.pressed]
        if self.holders and len(floating) == len(self.holders) and not self.surface_pressures:
            raise CaseError("Holder: needs one of force, approach and closing_moment")
        touching = {face.body for face in self._faces}
        apart = [body for body in (*self.bodies, *self.motions) if body not in touching]
        if apart:
            raise CaseError(f"Model: the body {apart[0].name!r} is at no interface")
        for kind, names in (
            ("bodies", [body.name for body in self.bodies]),
            ("interfaces", [i.name for i in self._model(StaticAnalysis("initial")).interfaces]),
        ):
            if len(set(names)) != len(names):
                raise CaseError(f"Model: two {kind} have the same name; one of: {', '.join(names)}")

    @cached_property
    def bodies(self) -> tuple[MeshBody, ...]:
        """The bodies on holders, then the others."""
        held = [surface.body for holder in self.holders for surface in holder.surfaces]
        return tuple(dict.fromkeys([*held, *(face.body for face in self._faces)]))

    @property
    def _faces(self) -> list[BodySurface]:
        """Faces in contact, then the glued ones."""
        pairs: list[FacePair | FaceTie] = [*self.interfaces, *self.ties]
        return [face for pair in pairs for face in pair.faces]

    @property
    def _is_pair(self) -> bool:
        alone = len(self.interfaces) == len(self.holders) == 1
        return len(self.bodies) == 2 and alone and not self._hanging

    @cached_property
    def _model_bodies(self) -> tuple[Body, ...]:
        held = {surface.body: surface for holder in self.holders for surface in holder.surfaces}
        surfaces_of = self.meshes.surfaces_of
        return tuple(body.in_model(surfaces_of(body), held.get(body)) for body in self.bodies)

    @cached_property
    def _groups(self) -> list[tuple[int, ...]]:
        return glued_bodies(len(self.bodies), [tie.in_model(self.bodies) for tie in self.ties])

    @cached_property
    def _hanging(self) -> tuple[Holder, ...]:
        """Free motions of the bodies that no holder and no clamped surface holds."""
        surfaces = [surface for holder in self.holders for surface in holder.surfaces]
        held = with_glued([self.bodies.index(surface.body) for surface in surfaces], self._groups)
        symmetry = [surface.name for surface in self.symmetry]
        given = self.kinematics or "3d", self._model_bodies, symmetry, self._groups, held
        return hanging_holders(*given)

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

    def stability(self, observer: Observer | None = None, **settings: Any) -> ModelSolution:
        """Stability; settings are attributes of `model.analyses.StabilityAnalysis`."""
        return self._solved(StabilityAnalysis(**settings), observer)

    def transient(
        self, until: Any, observer: Observer | None = None, **settings: Any
    ) -> ModelSolution:
        """Whole running-in; arguments as of `march`, with ``output_times`` [s]."""
        return self._solved(_transient(until, settings), observer)

    def march(
        self, until: Any, start: MarchState | str | PathLike[str] | None = None, **settings: Any
    ) -> Iterator[MarchState]:
        """States of a running-in, step by step; stop by leaving the loop.

        Parameters
        ----------
        until : float, quantity or ``"steady"``
            Time [s], or until the pressure is steady within ``steady_tolerance``.
        start : MarchState or path, optional
            State to continue from, or a file of it by `MarchState.save`: of this model or of one
            with other loads, speeds or laws.
        **settings
            Other attributes of `model.analyses.TransientAnalysis`.

        Raises
        ------
        CaseError
            If the file is not one of a state of these bodies.
        ComputationError
            If a step fails, or its balances do not hold.
        """
        analysis = _transient(until, settings)
        yield from march(self.meshes, self._system(analysis), analysis, start)

    def fretting(self, observer: Observer | None = None, **settings: Any) -> ModelSolution:
        """Stick and slip under the history of the holder, see `model.analyses.FrettingAnalysis`."""
        return self._solved(FrettingAnalysis(**settings), observer)

    def reciprocating(
        self, amplitude: Any, frequency: Any, observer: Observer | None = None, **settings: Any
    ) -> ModelSolution:
        """Reciprocating sliding along x, see `model.analyses.ReciprocatingAnalysis`.

        `moving` is by default the first body on a holder. Of several bodies, the first face of
        each interface passes over the second one, whichever moves.
        """
        x = in_python(units.Length, amplitude, "reciprocating.amplitude")
        f = in_python(units.Frequency, frequency, "reciprocating.frequency")
        motions = {settings.pop("moving", self.bodies[0]): Translation(4 * x * f)}
        analysis = ReciprocatingAnalysis(**settings, amplitude=x, frequency=f)
        return replace(self, motions=motions)._solved(analysis, observer)

    def _solved(self, analysis: Analysis, observer: Observer | None) -> ModelSolution:
        """Solution of an analysis. Every rank calls."""
        observer = observer or Observer()
        system = self._system(analysis, observer)
        end, result = solve(system, analysis, observer)
        if result.stopped is not None:
            raise result.stopped
        return ModelSolution(self.meshes, end, result)

    def _system(self, analysis: Analysis, observer: Observer | None = None) -> System:
        observer = observer or Observer()
        model = self._model(analysis)
        parts = self._shared.setdefault("parts", SetupCache())
        single = needs_single_solution(model, analysis)
        comm, phases = self.bodies[0].mesh.comm, Phases(observer.phase)
        return build(model, comm, phases, parts=parts, single=single)

    def _model(self, analysis: Analysis) -> Model:
        meshes = self.meshes
        number(self.degree, "Model.degree", 1, 10)
        if self.solver not in SOLVERS:
            raise CaseError(
                f"Model.solver: found {self.solver!r}; must be one of {', '.join(SOLVERS)}"
            )
        dim = meshes.tagged.points.shape[1]
        if self.kinematics not in (_OF_SECTIONS if dim == 2 else (None,)):
            raise CaseError(
                f"Model.kinematics: found {self.kinematics!r}; must be one of "
                f"{', '.join(_OF_SECTIONS)} for a mesh of a section, and None in space"
            )
        if self.heat is not None and self.heat.advection != "none" and len(self.motions) > 1:
            raise CaseError(
                "Heat.advection: is for one moving body that passes the others; found "
                f"{len(self.motions)} in Model.motions"
            )
        thickness = self.thickness
        if thickness is not None:
            thickness = in_python(units.Length, thickness, "Model.thickness")
        if (self.kinematics in _OF_SECTIONS[1:]) is (thickness is None):
            raise CaseError("Model.thickness: needed for a plane model, and for no other")
        model = Model(
            kinematics=self.kinematics or "3d",
            bodies=self._model_bodies,
            interfaces=tuple(self._interface(pair, analysis) for pair in self.interfaces),
            holders=(*(self._holder(holder, dim) for holder in self.holders), *self._hanging),
            meshes=meshes,
            discretisation=Discretisation(self.degree, solver=self.solver),
            heat=self.heat,
            thickness=thickness,
            symmetry=tuple(surface.name for surface in self.symmetry),
            title=self.title,
            ties=tuple(tie.in_model(self.bodies) for tie in self.ties),
            surface_pressures=self._surface_pressures(),
        )
        check(model, meshes.tagged.surfaces)
        on_root(self.bodies[0].mesh.comm, lambda: note_flat_facets(model, meshes.tagged))
        return model

    def _surface_pressures(self) -> dict[str, float]:
        """Pressures of the model and those given with its holders."""
        found: dict[str, float] = {}
        each = [("Model", self.surface_pressures)]
        each += [("Holder", holder.surface_pressures) for holder in self.holders]
        for owner, given in each:
            found |= by_surface(units.Pressure, given, f"{owner}.surface_pressures")
        return found

    def _interface(self, pair: FacePair, analysis: Analysis) -> Interface:
        """Interface with the faces in their order, of a pair with the held one first."""
        order = self.bodies if self._is_pair else [face.body for face in pair.faces]
        first, second = sorted(pair.faces, key=lambda face: order.index(face.body))
        one, other = (
            None if given is None else given.in_model()
            for given in (self.motions.get(face.body) for face in (first, second))
        )
        motion = relative_motion(one, other, self.kinematics == "axisymmetric")
        if self._is_pair and motion.center is None:  # seen from body 1
            passes = motion.passes and motion.moving_side == 1
            motion = replace(motion, passes=passes, moving_side=1)
        closes = not isinstance(analysis, FrettingAnalysis)
        found = pair.in_model(self.bodies, (first, second), motion, closes)
        return replace(found, name="") if self._is_pair else found

    def _holder(self, holder: SurfaceHolder, dim: int) -> Holder:
        found = holder.in_model(dim, self.bodies)
        found = replace(found, bodies=with_glued(found.bodies, self._groups))
        return replace(found, name="") if self._is_pair else found


def _transient(until: Any, settings: Mapping[str, Any]) -> TransientAnalysis:
    """Settings of a running-in until a time or the steady state."""
    if until == "steady":
        return TransientAnalysis(until="steady", **settings)
    return TransientAnalysis(end_time=in_python(units.Time, until, "march.until"), **settings)
