"""Fig. 14: influence of the Kelvin-Voigt viscosity on |E*| and phase."""

from asphalt_nscd.reporting.figures import sensitivity

draw = sensitivity.figure_of("eta_k")
