"""Tables of the report: one module for each, `make(...)` from result files to a data frame."""
