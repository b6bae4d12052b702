"""Complex modulus of asphalt concrete by nonsmooth contact dynamics."""

__version__ = "0.1.0"
