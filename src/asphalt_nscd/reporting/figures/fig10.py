"""Fig. 10: isotherms of the phase angle, simulated and measured."""

from asphalt_nscd.reporting.figures import isotherms

draw = isotherms.figure_of("phase_deg")
