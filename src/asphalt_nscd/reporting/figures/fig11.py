"""Fig. 11: influence of the Maxwell modulus on |E*| and phase."""

from asphalt_nscd.reporting.figures import sensitivity

draw = sensitivity.figure_of("Em")
