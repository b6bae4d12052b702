"""The modulus of a mix from its binder and its recipe."""
