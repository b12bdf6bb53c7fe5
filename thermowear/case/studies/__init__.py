"""Tables of calibrations and studies: parameters, observations, distributions of inputs."""
