"""Frictional contact problems in files; the solver is `nscd.contacts`."""
