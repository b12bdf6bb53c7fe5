# %% [markdown]
# # A brake on a mesh of one's own
#
# A pad with a lining and a steel back is pressed on a sliding rail. The mesh is made with gmsh, has
# tags of its own, and the friction falls with speed and temperature.

# %%
from pathlib import Path

from mpi4py import MPI

import dolfinx
import gmsh
import numpy as np

import thermowear as tw

try:
    from dolfinx.io import gmshio
except ImportError:  # its name since dolfinx 0.10
    from dolfinx.io import gmsh as gmshio

RAIL, LINING, BACK = 101, 205, 7  # cells
RAIL_TOP, RAIL_BOTTOM, PAD_FACE, PAD_TOP = 32, 31, 41, 42  # facets

# %% [markdown]
# Lining and back share the nodes of their joint. The pad and the rail, that slide on each other, do
# not.


# %%
def brake_mesh(size):
    """Mesh of the section [m], with tags of cells and facets; `size` is that of the cells."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ, model = gmsh.model.occ, gmsh.model
    rail = occ.addRectangle(-0.06, -0.02, 0, 0.12, 0.02)
    lining = occ.addRectangle(-0.025, 0, 0, 0.05, 0.01)
    back = occ.addRectangle(-0.025, 0.01, 0, 0.05, 0.006)
    occ.fragment([(2, lining)], [(2, back)])
    occ.synchronize()
    for tag, surface in ((RAIL, rail), (LINING, lining), (BACK, back)):
        model.addPhysicalGroup(2, [surface], tag)
    places = {
        RAIL_TOP: (rail, 0.0),
        RAIL_BOTTOM: (rail, -0.02),
        PAD_FACE: (lining, 0.0),
        PAD_TOP: (back, 0.016),
    }
    for tag, (surface, height) in places.items():
        curves = [abs(c) for _, c in model.getBoundary([(2, surface)])]
        level = [c for c in curves if np.ptp([*model.getBoundingBox(1, c)[1::3], height]) < 1e-6]
        model.addPhysicalGroup(1, level, tag)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    model.mesh.generate(2)
    found = gmshio.model_to_mesh(model, MPI.COMM_WORLD, 0, gdim=2)
    gmsh.finalize()
    return found[:3]


mesh, cells, facets = brake_mesh(0.004)

# %% [markdown]
# The pad has two materials by cell tag; the rail consists of the cells with one tag. Quantities
# are text with units, or numbers in SI.

# %%
iron = tw.Material("110 GPa", 0.25, conductivity="48 W/(m K)", expansion="1.1e-5 1/K")
steel = tw.Material("200 GPa", 0.3, conductivity="50 W/(m K)", expansion="1.2e-5 1/K")
lining = tw.Material("1.2 GPa", 0.3, conductivity="1.2 W/(m K)", expansion="1.4e-5 1/K")

rail = tw.Body("rail", mesh, cells.find(RAIL), facets, iron, fixed=RAIL_BOTTOM)
pad = tw.Body("pad", mesh, cells, facets, {LINING: lining, BACK: steel})


def friction(p, v, T):
    """Coefficient of friction at pressures [Pa], speeds [m/s] and temperatures [K]."""
    return 0.32 + 0.1 * np.exp(-v / 0.5) - 2e-4 * (T - 293.15)


face = tw.Interface(
    pad.surface(PAD_FACE),
    rail.surface(RAIL_TOP),
    friction=friction,
    conductance="1e4 W/(m^2 K)",
    wear={pad: tw.PowerWear("3e-14 1/Pa")},
)
model = tw.Model(
    interfaces=[face],
    holders=[tw.Holder(pad.surface(PAD_TOP), ["z", "rotation"], "400 N", pivot=(0.0, 0.016))],
    motions={rail: tw.Translation("-2 m/s")},
    heat=tw.Heat(
        ambient="20 degC",
        cooling={rail.surface(RAIL_BOTTOM): "2000 W/(m^2 K)", pad.surface(PAD_TOP): 50.0},
    ),
    kinematics="plane-strain",
    thickness="10 mm",
)

# %% [markdown]
# The steady state of wear: pressure, temperatures and friction that belong together.

# %%
steady = model.steady()
pressure = steady.pressure(face)
print(f"largest pressure {np.max(pressure) / 1e6:.2f} MPa")
print(f"friction {steady.summary['friction_min']:.3f} to {steady.summary['friction_max']:.3f}")
print(f"highest temperature {steady.summary['max_temperature_K'] - 273.15:.0f} °C")

# %% [markdown]
# Fields come back as functions on the mesh above: of use in further forms, or in a picture.


# %%
def drawn(path):
    """Draw the temperature of both bodies, and the pressure along the face."""
    import matplotlib.pyplot as plt

    figure, (bodies, along) = plt.subplots(2, figsize=(7, 5), layout="constrained")
    levels = np.linspace(20, steady.summary["max_temperature_K"] - 273.15, 20)
    for body in (pad, rail):
        T = steady.temperature(body)
        linear = dolfinx.fem.functionspace(mesh, ("Lagrange", 1))
        corners = dolfinx.fem.Function(linear)
        corners.interpolate(T)
        x, y = linear.tabulate_dof_coordinates()[:, :2].T
        values = corners.x.array - 273.15
        triangles = linear.dofmap.list[~np.isnan(values[linear.dofmap.list]).any(axis=1)]
        shown = 1e3 * x, 1e3 * y, triangles, np.nan_to_num(values)
        shades = bodies.tricontourf(*shown, levels=levels)
    bodies.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    figure.colorbar(shades, ax=bodies, label="temperature [°C]")
    pressure.plot(along)
    figure.savefig(path, dpi=100)


drawn(Path("brake_own_mesh.png"))
