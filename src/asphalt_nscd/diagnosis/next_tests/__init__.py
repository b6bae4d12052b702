"""Which further tests would answer most of what is open."""
