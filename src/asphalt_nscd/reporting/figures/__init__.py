"""Figures: one module each with `draw`, or with `figure_of` where one module draws several."""

# By its name: the module that draws a figure, and of what
SEVERAL = {
    "fig09": ("isotherms", "E_MPa"),
    "fig10": ("isotherms", "phase_deg"),
    "fig11": ("sensitivity", "Em"),
    "fig12": ("sensitivity", "eta_m"),
    "fig13": ("sensitivity", "Ek"),
    "fig14": ("sensitivity", "eta_k"),
}
