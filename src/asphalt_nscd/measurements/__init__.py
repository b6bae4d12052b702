"""Eqs. (1)-(5), records of force and displacement, geometries of tests, tables of tests and their isotherms."""
