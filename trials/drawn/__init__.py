"""Mixes, designs and what real tables show that no law has, for trials that draw tables; nothing of the package."""
