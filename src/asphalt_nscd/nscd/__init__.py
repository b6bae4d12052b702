"""The compiled core: arrays in, arrays out.

Imports nothing else of this package. Sign convention throughout: relative velocity positive =
opening, reaction on the second body positive = repulsion.
"""
