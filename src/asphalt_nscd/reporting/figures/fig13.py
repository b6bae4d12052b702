"""Fig. 13: influence of the Kelvin-Voigt modulus on |E*| and phase."""

from asphalt_nscd.reporting.figures import sensitivity

draw = sensitivity.figure_of("Ek")
