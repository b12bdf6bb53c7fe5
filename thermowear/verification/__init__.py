"""Verification of the program against references, for ``thermowear verify`` and the tests."""

from __future__ import annotations

from .cases.assembly.clutch_pack import clutch_pack
from .cases.assembly.face_seal import face_seal
from .cases.assembly.floating_caliper import floating_caliper
from .cases.assembly.layer_instability import layer_instability
from .cases.assembly.pad_disk_pad import pad_disk_pad
from .cases.assembly.two_shoes import two_shoes
from .cases.contact.contact_methods import methods_agree, patch
from .cases.contact.glued_blocks import glued_blocks
from .cases.contact.hertz import flat_punch, hertz_line, hertz_sphere
from .cases.contact.hertz_in_space import hertz_elliptical, hertz_sphere_3d, hertz_sphere_3d_fine
from .cases.contact.patch_in_space import patch_3d
from .cases.cycles.fretting import fretting_cylinder, fretting_wear, mindlin
from .cases.cycles.fuel_fretting import fuel_fretting
from .cases.cycles.reciprocating import reciprocating
from .cases.cycles.reciprocating_in_space import reciprocating_3d
from .cases.cycles.spheres import fretting_sphere, mindlin_sphere
from .cases.heat.blocks import pressure_conductance, temperature_dependent, two_slabs
from .cases.heat.growth import tei_growth
from .cases.heat.hot_spots import tei_layer_antisymmetric, tei_layer_symmetric, tei_ring
from .cases.heat.instability import half_plane_instability, sliding_rod
from .cases.heat.moving_band import moving_band
from .cases.heat.transient_heat import braking_stop, step_flux
from .cases.inference.calibration import calibration
from .cases.inference.identifiability import identifiability
from .cases.inference.sobol import sobol
from .cases.steady.annular_punch import annular_punch, running_in
from .cases.steady.cad_part import cad_part
from .cases.steady.finite_elements import optimal_shape
from .cases.steady.minimality import minimality
from .cases.steady.ring_in_space import ring_3d, ring_3d_whole
from .cases.steady.special_cases import SPECIAL_CASES
from .cases.wear.beam_shakedown import beam_shakedown
from .cases.wear.coated_bush import coated_bush
from .cases.wear.coating import coating
from .cases.wear.composite_face import composite_face
from .cases.wear.deep_wear_in_space import deep_wear_3d
from .cases.wear.geometry_updates import block_on_ring, deep_wear, pin_on_disc
from .cases.wear.growing import growing_cylinder, growing_sphere
from .cases.wear.pin_on_disk_in_space import pin_on_disk_3d
from .check import Check, all_checks, compare, identified

_CASES = SPECIAL_CASES | dict.fromkeys((
    annular_punch, running_in, patch, patch_3d, hertz_line, hertz_sphere, hertz_sphere_3d,
    hertz_sphere_3d_fine, hertz_elliptical, flat_punch,
    methods_agree, mindlin, growing_cylinder, growing_sphere, block_on_ring, pin_on_disc,
    deep_wear, deep_wear_3d, beam_shakedown, fretting_wear, fretting_cylinder, fuel_fretting,
    mindlin_sphere, fretting_sphere,
    reciprocating, reciprocating_3d, moving_band, two_slabs, pressure_conductance,
    temperature_dependent, minimality, step_flux, braking_stop, sliding_rod,
    half_plane_instability, tei_layer_antisymmetric, tei_layer_symmetric, tei_ring,
    tei_growth, optimal_shape,
    ring_3d, ring_3d_whole, pin_on_disk_3d, composite_face, coating, coated_bush,
    glued_blocks, pad_disk_pad, clutch_pack, face_seal, two_shoes, floating_caliper,
    layer_instability, cad_part, identifiability, sobol, calibration,
), ())  # fmt: skip
CASES = {
    id: identified(id, case, *runs)
    for case, runs in _CASES.items()
    if (id := case.__name__.replace("_", "-"))
}
"""Verification cases by id in the order of ``verify``; each yields its checks."""

SLOW = frozenset({"deep-wear", "fretting-sphere", "hertz-sphere-3d-fine", "ring-3d-whole"})
"""Cases of several minutes or much memory."""

__all__ = ["CASES", "SLOW", "Check", "all_checks", "compare"]
