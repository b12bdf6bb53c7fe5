"""A ring worn fast while temperatures are followed in time; its mesh moves twice or more."""

HEAT = (
    "mesh.degree=6",
    "mesh.elements=4",
    'bodies.punch.density="7800 kg/m^3"',
    'bodies.punch.specific_heat="460 J/(kg K)"',
    "heat.transient=true",
    'heat.initial="30 degC"',
    "motion.angular_velocity=1 rad/s",
    "wear.punch.coefficient=2e-5 1/MPa",
    "load.mean_pressure=5 MPa",
    "wear.update=0.002",
    'analysis={type="transient", end_time="200 s", tolerance=1e-3}',
)
