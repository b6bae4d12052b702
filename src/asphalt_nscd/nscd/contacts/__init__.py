"""Contacts with Coulomb friction, solved together: sweeps, Newton's method, interior points."""
