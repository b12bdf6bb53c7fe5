"""Inference from measurements: fits, identifiability, designs; uncertain inputs and sensitivity."""

from .distributions import (
    LogNormal,
    LogUniform,
    Normal,
    Triangular,
    TruncatedNormal,
    UncertainInput,
    Uniform,
)
from .fit import Fit, JointNormal, central_jacobian, fit, forward_jacobian
from .identifiability import (
    Combination,
    Identifiability,
    Settling,
    combinations,
    identify,
    settling,
)
from .parameters import ForwardModel, Observations, Parameter, ParameterSpace
from .posterior import Posterior, log_posterior, require_emcee, sample_posterior
from .propagation import (
    Band,
    ExpectedAccuracy,
    MeasurementDesign,
    SampleQuantiles,
    expected_accuracy,
    linear_band,
    quantiles,
    sample_quantiles,
)
from .sensitivity import (
    SaltelliDesign,
    Sample,
    SobolIndices,
    Swings,
    latin_hypercube,
    saltelli,
    sobol_indices,
    sobol_sequence,
    swing_points,
    swings,
)
