"""Content of diagnosis.json, typed, a file for each part of it; `whole` puts them together."""
