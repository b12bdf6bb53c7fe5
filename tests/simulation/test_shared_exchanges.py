"""Heat exchange of the faces, which cases of a sweep share."""

import numpy as np

import thermowear as tw
from tests.conftest import HOT
from thermowear.case import load

RUNNING_IN = (
    'analysis={type="transient", end_time="20 s"}',
    "mesh.degree=3",
    "mesh.elements=4",
)


def test_cases_that_share_exchanges_are_those_alone():
    """requirement: to the last digit, whatever the conductance, partition and friction before."""
    over = {
        "heat.conductance": ["1e4 W/(m^2 K)", "1e6 W/(m^2 K)"],
        "heat.partition": [0.3, 0.6],
        "contact.friction": [0.2, 0.3],
    }
    for values, shared in tw.sweep(load(HOT, RUNNING_IN), over):
        h, partition, mu = values.values()
        own = f'heat.conductance="{h}"', f"heat.partition={partition}", f"contact.friction={mu}"
        alone = tw.run(load(HOT, (*RUNNING_IN, *own)))
        for name in ("pressure", "temperature_1", "temperature_2", "wear_1"):
            both = (getattr(result.interface, name) for result in (shared, alone))
            assert np.array_equal(*both), name
