"""Contacts with Coulomb friction, solved together (`solve_contacts` in friction): sweeps, Newton, interior points."""
