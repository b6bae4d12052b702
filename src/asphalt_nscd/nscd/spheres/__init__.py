"""Rigid spheres that fall, collide and come to rest."""
