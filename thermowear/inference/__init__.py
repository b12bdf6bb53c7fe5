"""Inference from measurements: fits, identifiability, designs; uncertain inputs and sensitivity."""

from .combinations import Combination, combinations
from .design import ExpectedAccuracy, MeasurementDesign, expected_accuracy
from .distributions import (
    LogNormal,
    LogUniform,
    Normal,
    Triangular,
    TruncatedNormal,
    UncertainInput,
    Uniform,
)
from .fit import Fit, fit
from .forward import ForwardModel
from .identifiability import Identifiability, Settling, identify, settling
from .jacobian import central_jacobian, forward_jacobian
from .joint_normal import JointNormal
from .observations import Observations
from .parameters import Parameter, ParameterSpace
from .posterior import Posterior, log_posterior, require_emcee, sample_posterior
from .propagation import Band, SampleQuantiles, linear_band, quantiles, sample_quantiles
from .sampling import SaltelliDesign, Sample, latin_hypercube, saltelli, sobol_sequence
from .sensitivity import SobolIndices, Swings, sobol_indices, swing_points, swings
