"""The report of a study: a first page that says it all, and behind it every figure and table."""
