# %% [markdown]
# # A wear law of one's own, stepped by hand
#
# A carbon block slides on a steel plate. Its wear rate is Archard's at first. A transfer film then
# forms on the plate and protects the block: the rate falls with the worn depth to a third of its
# first value. Such a law is a plain function of arrays; its derivatives are computed numerically.

# %%
from dataclasses import replace

from mpi4py import MPI

import numpy as np
from dolfinx.mesh import CellType, create_rectangle, locate_entities_boundary, meshtags

import thermowear as tw

FILM, PROTECTED = 2e-6, 1 / 3  # m; relative to the wear rate of the bare plate


def filmed(p, v, depth):
    """Wear rate [m/s] at pressures [Pa], speeds [m/s] and worn depths [m]."""
    return 1e-14 * p * v * (PROTECTED + (1 - PROTECTED) * np.exp(-depth / FILM))


# %% [markdown]
# Each body has a mesh of its own, with tags of its own: bottoms are tagged 7, tops 205.


# %%
def rectangle(left, bottom, width, height, cells):
    """Mesh of a rectangle [m], and its facets with tags."""
    corners = [[left, bottom], [left + width, bottom + height]]
    mesh = create_rectangle(MPI.COMM_WORLD, corners, cells, CellType.quadrilateral)
    below = locate_entities_boundary(mesh, 1, lambda x: np.isclose(x[1], bottom))
    above = locate_entities_boundary(mesh, 1, lambda x: np.isclose(x[1], bottom + height))
    facets = np.concatenate([below, above])
    tags = np.repeat(np.array([7, 205], dtype=np.int32), [len(below), len(above)])
    order = np.argsort(facets)
    return mesh, meshtags(mesh, 1, facets[order], tags[order])


steel = tw.Material("210 GPa", 0.3)
carbon = tw.Material("12 GPa", 0.2)

mesh, facets = rectangle(-0.03, -0.02, 0.06, 0.02, (18, 6))
plate = tw.Body("plate", mesh, None, facets, steel, fixed=7)
mesh, facets = rectangle(-0.01, 0.0, 0.02, 0.01, (12, 6))
block = tw.Body("block", mesh, None, facets, carbon)

face = tw.Interface(block.surface(7), plate.surface(205), friction=0.15, wear={block: filmed})
model = tw.Model(
    interfaces=[face],
    holders=[tw.Holder(block.surface(205), force="2 kN")],
    motions={block: tw.Translation("0.5 m/s")},
    kinematics="plane-strain",
    thickness="10 mm",
)

# %% [markdown]
# The running-in is a loop over accepted states. It is left when the film has formed everywhere.

# %%
for state in model.march(until="10 h"):
    depth = np.asarray(state.wear(face, block))
    if depth.min() > 3 * FILM:
        break
filmed_at, pressure = state.time, state.pressure(face)
print(f"{state.progress.state.number} steps; film after {filmed_at / 60:.1f} min of sliding")
print(f"largest pressure {np.max(pressure) / 1e6:.2f} MPa, worn {1e6 * depth.max():.2f} µm")

# %% [markdown]
# The run goes on from there at twice the load. What does not depend on the load (mesh, factors,
# condensed operators) is used again.

# %%
heavier = replace(model, holders=[replace(model.holders[0], force="4 kN")])
*_, last = heavier.march(until=2 * filmed_at, start=state)
area = pressure.weights.sum()
mean_depth = last.row.wear_volume_1 / area
print(f"after {last.time / 60:.1f} min: mean depth {1e6 * mean_depth:.2f} µm")

# %% [markdown]
# The mean pressure and the depth give the mean wear rate: the film protects the block.

# %%
rate = filmed(np.array([4e3 / area]), 0.5, mean_depth)[0]
print(f"wear rate {3.6e9 * rate:.2f} µm/h; without a film {3.6e9 * 1e-14 * 4e3 / area * 0.5:.2f}")
