"""From results to what a reader sees: figures, tables, pages, the audit of the paper."""
