"""A study from a user's own table: cells, then quantities, then tests, then a configuration."""
