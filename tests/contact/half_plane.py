"""A contact without finite elements: similar half-planes by boundary elements."""

import numpy as np

from thermowear.contact.friction.frictional_contact import frictional_contact
from thermowear.contact.friction.stick_slip_state import Loads
from thermowear.contact.operators.rigid_motion import HeldMotion
from thermowear.laws.motions import translation

PRESS = HeldMotion(translation((0.0, -1.0)), role="press")
SLIDE = HeldMotion(translation((1.0, 0.0)), role="slide")


def loaded(
    normal_force=None, approach=None, tangential_force=None, tangential_displacement=None
) -> Loads:
    """Loads of body 1 of a pair; without tangential ones it can only be pressed."""
    pairs = [(normal_force, approach)]
    if (tangential_force, tangential_displacement) != (None, None):
        pairs.append((tangential_force, tangential_displacement))
    return Loads(*np.array(pairs, dtype=float).T)


def half_plane(line, cells, extent=1.25):
    """The contact of a `MindlinLine` on equal cells of constant traction.

    Surface displacements of a strip of traction on a half-plane, up to a rigid one (Johnson,
    Contact Mechanics, 1985, section 2.5); similar bodies, no coupling.
    """
    half = extent * line.normal.half_width
    step = 2 * half / cells
    x = -half + step * (np.arange(cells) + 0.5)
    distance = np.subtract.outer(x, x)
    upper, lower = distance + step / 2, distance - step / 2
    far = 4 * half  # where the displacement is counted from; makes the compliance positive
    logs = upper * np.log(np.abs(upper) / far) - lower * np.log(np.abs(lower) / far)
    response = -2 / (np.pi * line.modulus) * (logs - step)
    nothing = np.zeros_like(response)
    responses = np.array([np.hstack([response, nothing]), np.hstack([nothing, response])])
    rigid = np.zeros((2, cells, 2))
    rigid[0, :, 0], rigid[1, :, 1] = 1.0, -1.0
    gap = x**2 / (2 * line.radius)
    weights = np.full(cells, step)
    travel, held = np.array([[0.0, 1.0]]), (PRESS, SLIDE)
    contact = frictional_contact(
        np.eye(cells), weights, gap, responses, rigid, travel, held, responses[0, :0]
    )
    return x, contact
