"""Bonded bodies: laws, strength, operators, devices at the head."""
