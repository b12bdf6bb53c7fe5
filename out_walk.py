import sys; sys.path.insert(0,'.')
from tests.simulation.test_step_walk import *
for name in CASES:
    v=of_a_step(*CASES[name])
    print(name, sorted({f for f,_ in v}), [x for x in v if 'model/' in x[0] or 'laws/' in x[0]])
