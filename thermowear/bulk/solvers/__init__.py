"""Linear solvers of the bodies: direct ones, multigrid, and the choice between them by size."""
