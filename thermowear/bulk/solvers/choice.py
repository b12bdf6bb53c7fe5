"""Choice of the linear solver of the bodies by their size: direct (MUMPS) or multigrid.

Bodies in space are factorised as long as the factor fits into the memory. Sections always are.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from petsc4py import PETSc

import numpy as np

from ...errors import CaseError
from ..bodies import Bodies
from ..joints import NO_JOINTS, Joints
from ..spaces import Spaces, groups_of, reference_element
from .direct import GroupSolvers
from .groups import AnyFactor, factorised, group_solvers
from .multigrid import MultigridSolver

AnySolver = AnyFactor | GroupSolvers | MultigridSolver
"""Solver of the equations of the bodies; all have the same methods."""

_MEASURED = 61_605, 0.49e9, 1.40
"""Unknowns and bytes of a factor in space, and its growth exponent: measured for bodies of one
block with elements of degree 2, from 6e4 to 1.8e5 unknowns."""
_PART = 0.4
"""Part of the available memory that the factors of all bodies may take: those of heat, the matrices
and the workspace of the factorisation need the rest."""
_PART_MEANWHILE = 0.6
"""Part of it that the factor of one body may take while its compliance is computed."""
_MANY = {"tetrahedron": 60_000, "hexahedron": 300_000}
"""Unknowns from which a single solution is faster by multigrid than by a factorisation (measured).
Flat hexahedra of degree 3, as of graded meshes of blocks, need 36 to 42 iterations, and at 2.7e5
unknowns as long as a factorisation."""
_LOW_DEGREE = 3
"""Highest degree for which multigrid converges as fast as measured."""
_LIMIT = "/sys/fs/cgroup/memory.max"


@dataclass(frozen=True)
class SolverChoice:
    """Linear solver of the bodies, and the estimate that it follows from.

    Attributes
    ----------
    name : str
        ``"direct"`` or ``"multigrid"``.
    unknowns : int
        Unknowns of the displacement.
    factor_memory : float
        Estimated memory of the factors of the stiffness; NaN in a section [bytes].
    largest_factor : float
        That of the body, or of glued ones, with most unknowns [bytes].
    available : float
        Memory available on this machine [bytes].
    single : bool
        True if the analysis needs a single solution, and no compliance.
    reason : str
    one_at_a_time : bool
        True if factors of bodies are made when they are needed, and only one of them is kept.
    """

    name: str = "direct"
    unknowns: int = 0
    factor_memory: float = float("nan")
    largest_factor: float = float("inf")
    available: float = float("nan")
    single: bool = False
    reason: str = "default"
    one_at_a_time: bool = False

    @property
    def iterative(self) -> bool:
        """True for multigrid."""
        return self.name == "multigrid"

    @property
    def solves_once(self) -> bool:
        """True if multigrid serves a single solution, after which its levels are given back."""
        return self.iterative and self.single

    @property
    def factorises_columns(self) -> bool:
        """True if a body is factorised for the time of its condensation alone."""
        return self.iterative and self.largest_factor <= _PART_MEANWHILE * self.available

    @property
    def factorises_heat_columns(self) -> bool:
        """True if conduction is factorised for the time of its condensation alone.

        A scalar factor has a ninth of the entries of a vector-valued one on the same nodes.
        """
        return self.iterative and self.factor_memory / 9 <= _PART_MEANWHILE * self.available

    def require_direct(self) -> None:
        """Refuse multigrid for glued bodies.

        Raises
        ------
        CaseError
        """
        if self.iterative:
            raise CaseError(
                "mesh.solver: glued bodies are solved by a factor only, not by multigrid; an "
                f"estimated {self.factor_memory / 1e9:.2g} GB of {self.available / 1e9:.2g} GB "
                "available; use fewer elements, a lower degree, or one mesh for the glued bodies"
            )

    def note(self) -> str | None:
        """Line for the console; None for small bodies and sections, which are factorised."""
        if not self.iterative and not self.unknowns >= min(_MANY.values()):
            return None
        return (
            f"solver: {self.name} ({self.reason}); {self.unknowns} unknowns, estimated memory of a "
            f"factor {self.factor_memory / 1e9:.2g} GB of {self.available / 1e9:.2g} GB available"
        )

    def summary(self) -> dict:
        """Keys of ``summary.json``."""
        known = np.isfinite(self.factor_memory)
        memory = float(self.factor_memory) if known else None
        return {"solver": self.name, "factor_memory_estimate_bytes": memory}


def choose_solver(
    asked: str,
    bodies: Bodies,
    degree: int,
    single: bool,
    glued: Sequence[tuple[str, str]] = (),
) -> SolverChoice:
    """Choose the linear solver of bodies. Every rank calls.

    Parameters
    ----------
    asked : str
        ``"auto"``, ``"direct"`` or ``"multigrid"``; sections stay direct.
    bodies : Bodies
    degree : int
        Degree of the displacement.
    single : bool
        True if the analysis needs a single solution and no compliance.
    glued : sequence of tuple of str
        Pairs of glued surfaces. Glued bodies are solved by one factor, never by multigrid.

    Raises
    ------
    CaseError
        If multigrid is asked for, or needed, and bodies are glued.
    """
    if bodies.dim == 2:
        return SolverChoice(reason="section")
    joined = [(bodies.index_of(first), bodies.index_of(second)) for first, second in glued]
    each = [count_unknowns(body.mesh, degree) for body in bodies.each]
    groups = groups_of(len(each), joined)
    sizes = [sum(each[k] for k in group) for group in groups]
    factors, unknowns = [factor_memory(size) for size in sizes], sum(sizes)
    memory = sum(factors)
    kind = bodies.each[int(np.argmax(each))].cell_type
    available = bodies.comm.bcast(available_memory(), root=0)
    name, reason = asked, "as given"
    if asked == "auto":
        name, reason = "direct", "the factor fits into the memory"
        if memory > _PART * available:
            name, reason = "multigrid", "the factor would not fit into the memory"
        elif single and not joined and unknowns >= _MANY[kind] and degree <= _LOW_DEGREE:
            name, reason = "multigrid", "faster for a single solution"
    choice = SolverChoice(name, unknowns, memory, max(factors), available, single, reason)
    if joined:
        choice.require_direct()
    return choice


def count_unknowns(mesh, degree: int) -> int:
    """Number of displacement unknowns of a degree on a mesh. Every rank calls."""
    element, topology = reference_element(mesh, degree), mesh.topology
    count = 0
    for dim, of_entities in enumerate(element.num_entity_dofs):
        if any(of_entities):
            topology.create_entities(dim)
            count += of_entities[0] * topology.index_map(dim).size_global
    return int(count * mesh.geometry.dim)


def factor_memory(unknowns: int) -> float:
    """Estimated memory of the factor of the stiffness of a body in space [bytes]."""
    reference, size, exponent = _MEASURED
    return size * (unknowns / reference) ** exponent


def available_memory() -> float:
    """Memory available to this process: of the machine, or of its control group [bytes]."""
    free = float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        sizes = {name: value for name, _, value in (line.partition(":") for line in lines)}
        free = 1024.0 * float(sizes["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        pass  # not Linux
    try:
        return min(free, float(Path(_LIMIT).read_text(encoding="ascii")))
    except (OSError, ValueError):  # no control group, or without limit
        return free


def linear_solver(
    choice: SolverChoice,
    matrix: PETSc.Mat,
    spaces: Spaces,
    fixed: np.ndarray,
    symmetry: str = "definite",
    coarse: Callable[[Spaces], PETSc.Mat] | None = None,
    coupled: bool = False,
    joints: Joints = NO_JOINTS,
) -> AnySolver:
    """Set up the chosen solver of a matrix. Every rank calls.

    Parameters
    ----------
    choice : SolverChoice
    matrix : petsc4py.PETSc.Mat
        Assembled, with the rows and columns of fixed values eliminated.
    spaces : Spaces
    fixed : ndarray of bool, shape (n_owned,)
    symmetry : str
        See `DirectSolver`; indefinite symmetric matrices are always factorised.
    coarse : callable, optional
        See `MultigridSolver`.
    coupled : bool
        True if the matrix couples the bodies.
    joints : Joints
        Joints of glued bodies.
    """
    if joints.count:
        choice.require_direct()
    if choice.iterative and symmetry in ("definite", "none"):
        return MultigridSolver(matrix, spaces, fixed, coarse, symmetric=symmetry == "definite")
    if coupled or len(spaces.groups) == 1:
        border = joints.border(range(len(spaces.each)), slice(None))
        return factorised(matrix, border, fixed, symmetry, spaces.dim)
    return group_solvers(matrix, spaces, joints, fixed, symmetry, choice.one_at_a_time)
