"""Compilation of forms with vectorised sums, and their assembly to numbers, vectors, matrices."""

from __future__ import annotations

import contextlib
import fcntl
import re
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from mpi4py import MPI
from petsc4py import PETSc

import ffcx
import numpy as np
import ufl
from dolfinx import default_scalar_type, fem, jit
from dolfinx.fem.petsc import assemble_matrix, assemble_vector, create_matrix

from .bodies import Bodies
from .kinematics import Kinematics

# The current folder may come from another person. dolfinx and FFCx read options from it, among them
# arguments of the compiler, which can run any command: make them read, which they do once, from a
# folder without such files. The user's options in the home folder remain valid.
with contextlib.chdir(Path(__file__).parent):
    ffcx.get_options()
    jit.get_options()

# These flags allow reordering of sums only, with no assumption about NaN and infinity. Element
# matrices of degree 8 are then assembled 2.7 times faster (measured, gcc 14).
_FLAGS = [
    "-O2",
    "-g0",
    "-ftree-vectorize",
    "-fassociative-math",
    "-fno-signed-zeros",
    "-fno-trapping-math",
    "-fno-math-errno",
]

_PATIENCE = 10
"""Time for which FFCx waits for a form that another process compiles [s]."""
_WAITED_IN_VAIN = re.compile(r"compilation timed out.*remove (?P<source>\S+\.c)\)")
_Compiled = TypeVar("_Compiled")


def compiled(form):
    """Compile a UFL form for assembly; reused from the cache on disk after the first time."""
    folder = _cache() / form.signature()[:2]
    options = {"cffi_extra_compile_args": _FLAGS, "timeout": _PATIENCE, "cache_dir": folder}
    return patiently(lambda: fem.form(form, jit_options=options), _comm_of(form))


def compiled_expression(expression: ufl.core.expr.Expr, points, comm: MPI.Comm) -> fem.Expression:
    """Compile a UFL expression for its values at points (n, dim) of the reference cell."""
    folder = _cache() / f"{zlib.crc32(points.tobytes()):08x}"[:2]
    options = {"timeout": _PATIENCE, "cache_dir": folder}
    return patiently(lambda: fem.Expression(expression, points, jit_options=options), comm)


def patiently(compile: Callable[[], _Compiled], comm: MPI.Comm) -> _Compiled:
    """Compile, also where another process is slow to compile the same, or was killed doing so.

    A process that finds a source in the cache waits for its compilation, in vain if the process
    that wrote it has been killed. All processes of this program compile under a shared lock: who
    gets it alone knows that nobody compiles, and removes the source. Every rank calls.

    Parameters
    ----------
    compile : callable
        Compiles without arguments.
    comm : MPI.Comm
        Ranks that compile together.
    """
    try:
        with _lock(fcntl.LOCK_SH):
            return compile()
    except (TimeoutError, RuntimeError) as error:  # RuntimeError of several ranks
        waited = _WAITED_IN_VAIN.search(str(error))
        if not comm.bcast(waited is not None):
            raise
    if waited is not None and comm.rank == 0:
        source = Path(waited["source"])
        with _lock(fcntl.LOCK_EX):
            if not source.with_suffix(".c.cached").exists():
                source.unlink(missing_ok=True)
    comm.barrier()
    with _lock(fcntl.LOCK_SH):
        return compile()


def _cache() -> Path:
    """Folder of compiled forms. FFCx lists the whole folder of a form to load it: with thousands of
    them (2 ms each time) in one, that takes a fifth of a short run, so that each has few.
    """
    return jit.get_options()["cache_dir"]


@contextlib.contextmanager
def _lock(kind: int) -> Iterator[None]:
    """Hold the lock of the cache of compiled forms."""
    folder = _cache()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / "thermowear.lock").open("a")
    except OSError:  # a cache that can only be read: nobody compiles into it
        yield
        return
    with file:
        fcntl.flock(file, kind)
        yield


def _comm_of(form) -> MPI.Comm:
    """Ranks of the mesh of a form."""
    return form.ufl_domains()[0].ufl_cargo().comm


def restricted(form: ufl.Form, cells: np.ndarray) -> ufl.Form:
    """Form integrated over some owned cells, and over those of its facets that are theirs."""
    domains: dict[str, list] = {"cell": [(1, cells)]}
    integrals = []
    for integral in form.integrals():
        kind = integral.integral_type()
        if kind not in domains:
            ((_, entities),) = integral.subdomain_data()
            facets = entities.reshape(-1, 2)  # cell and local facet
            domains[kind] = [(1, facets[np.isin(facets[:, 0], cells)].ravel())]
        integrals.append(integral.reconstruct(subdomain_id=1, subdomain_data=domains[kind]))
    return ufl.Form(integrals)


def assembled(form: fem.Form) -> np.ndarray:
    """Assemble a compiled linear form; owned values. Every rank calls."""
    vector = assemble_vector(form)
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    result = vector.getArray().copy()
    vector.destroy()
    return result


def surface_area(bodies: Bodies, kinematics: Kinematics, surface: str) -> float:
    """Area of a surface of the solid according to its kinematic model [m²]. Every rank calls."""
    area = 0.0
    for body in bodies.each:
        one = fem.Constant(body.mesh, default_scalar_type(1.0))
        form = kinematics.integral(body.mesh, one, body.surface_measure(surface))
        area += fem.assemble_scalar(compiled(form))
    return bodies.comm.allreduce(area, op=MPI.SUM)


def nodal_loads(space: fem.FunctionSpace, work: Callable) -> np.ndarray:
    """Load vector of a linear form, given as a function of its test function; owned values."""
    return assembled(compiled(work(ufl.TestFunction(space))))


def assembled_matrix(*forms, pattern: PETSc.Mat | None = None, blocked: bool = False) -> PETSc.Mat:
    """Assemble the sum of bilinear forms. Every rank calls.

    Parameters
    ----------
    forms : UFL forms
    pattern : petsc4py.PETSc.Mat, optional
        Matrix with the sparsity pattern of the result, by default that of the first form.
    blocked : bool
        True to store the block of two nodes by one index, for vector-valued elements: products
        with vectors take 0.4 of the time, and the matrix 0.7 of the memory (measured in space).
    """
    terms = [compiled(form) for form in forms]
    kind = PETSc.Mat.Type.BAIJ if blocked else None
    matrix = create_matrix(terms[0], kind) if pattern is None else pattern.duplicate()
    matrix.zeroEntries()
    for term in terms:
        assemble_matrix(matrix, term, [])  # type: ignore[arg-type]  # dispatches on it
    matrix.assemble()
    return matrix
