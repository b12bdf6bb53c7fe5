"""Systems of cases, as the analyses begin with."""

from mpi4py import MPI

from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.from_case import model_of
from thermowear.simulation.system.building import build
from thermowear.timer import Phases


def built(case, comm=MPI.COMM_WORLD):
    """System on the mesh for the contact zone that the case expects."""
    return build(model_of(case), comm, Phases())


def prepared(case, comm=MPI.COMM_WORLD):
    """System on the mesh of a run, fitted to the contact edges where the case wants it."""
    return prepare(model_of(case), comm, Phases())
