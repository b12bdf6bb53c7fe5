"""Loading of one contact problem on the full system."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..wear.edge_deflection import EdgeDeflection


@dataclass(frozen=True)
class Loading:
    """Gap, loads and local compliance of one contact problem.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap g at the points, wear and given approach included [m].
    load : ndarray, shape (k,)
        Load F on the free motions of the holder.
    compliance : ndarray, shape (n,)
        Local compliance c >= 0: gap opening per pressure at the point [m/Pa].
    nodal_loads : ndarray, shape (n_owned,)
        Nodal loads f [N].
    thermal_traction : ndarray, shape (n,)
        Normal traction s of body 1 at zero displacement [Pa].
    deflection : EdgeDeflection, optional
        Local deflection of the faces at the edge of the wear.
    """

    gap: np.ndarray
    load: np.ndarray
    compliance: np.ndarray
    nodal_loads: np.ndarray
    thermal_traction: np.ndarray
    deflection: EdgeDeflection | None = None

    def part(self, share: float) -> Loading:
        """Scaled loading; for a given approach the faces are in first contact at share 0."""
        lift = 0.0 if len(self.load) else max(0.0, -float(self.gap.min()))
        return replace(
            self,
            gap=self.gap + (1 - share) * lift,
            load=share * self.load,
            nodal_loads=share * self.nodal_loads,
            thermal_traction=share * self.thermal_traction,
        )
