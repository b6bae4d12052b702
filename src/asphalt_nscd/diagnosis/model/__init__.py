"""What measurements follow: a law, causes, a discrepancy and scatter, fitted together."""
