"""Fig. 9: isotherms of the norm of the complex modulus, simulated and measured."""

from asphalt_nscd.reporting.figures import isotherms

draw = isotherms.figure_of("E_MPa")
