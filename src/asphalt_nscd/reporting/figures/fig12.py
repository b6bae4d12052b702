"""Fig. 12: influence of the Maxwell viscosity on |E*| and phase."""

from asphalt_nscd.reporting.figures import sensitivity

draw = sensitivity.figure_of("eta_m")
