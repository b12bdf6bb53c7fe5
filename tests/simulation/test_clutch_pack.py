"""Packs of clutch disks: torque, temperatures, solutions where the plates are loaded only."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.bulk.elasticity.elasticity import ElasticGroup
from thermowear.case import load
from thermowear.contact.operators import exchange_matrix
from thermowear.verification.cases.assembly.clutch_pack import Pack, pack_checks
from thermowear.verification.check import computed

SMALL = Pack(4, elements=5, degree=2)


@pytest.mark.parametrize("pack", [SMALL, replace(SMALL, faces=2), replace(SMALL, heated=False)])
def test_a_pack_wears_uniformly(pack):
    """requirement: n mu F (r_o + r_i) / 2, p r constant, each face carries F; hottest inside."""
    checks = list(pack_checks(pack))
    assert len(checks) >= 5
    assert not [check for check in checks if not check.passed]


def running_in(pack):
    """Result of a few steps with temperatures in time."""
    tables = pack.tables()
    tables["heat"]["transient"] = True
    tables["analysis"] = {"type": "transient", "end_time": "1 s", "tolerance": 1e-2}
    return computed(load(tables))


def test_sparse_factors_of_the_exchange(monkeypatch):
    """requirement: the same pressures and temperatures with dense factors, to 1e-9."""
    found = running_in(SMALL).interface
    monkeypatch.setattr(exchange_matrix, "_PAIR", 100)
    expected = running_in(SMALL).interface
    for name in ("pressure", "wear_1", "temperature_1", "temperature_2", "heat_flux_2"):
        values = getattr(expected, name)
        atol = 1e-9 * np.abs(values).max()
        np.testing.assert_allclose(getattr(found, name), values, rtol=0.0, atol=atol)


def test_plates_are_solved_for_their_own_pressures(monkeypatch):
    """requirement: the number of elastic solutions grows linearly with the faces."""
    counts, solver = {}, ElasticGroup.solver_of_columns

    def counted(body):
        class Counting:
            def __enter__(self):
                self._inner = solver(body)
                solve = self._inner.__enter__()

                def count(loads):
                    counts[faces] = counts.get(faces, 0) + loads.shape[1]
                    return solve(loads)

                return count

            def __exit__(self, *error):
                return self._inner.__exit__(*error)

        return Counting()

    monkeypatch.setattr(ElasticGroup, "solver_of_columns", counted)
    for faces in (2, 4, 8):
        pack = replace(SMALL, faces=faces)
        computed(load(pack.tables() | {"analysis": {"type": "initial"}}))
    assert counts[4] == 2 * counts[2]
    assert counts[8] == 2 * counts[4]
