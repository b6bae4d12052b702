"""From results to what a reader sees: figures, tables, pages."""
