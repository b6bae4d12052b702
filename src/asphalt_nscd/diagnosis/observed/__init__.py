"""What was measured: the tests, what the machine says of them, and how far they scatter."""
