"""The Python interface: what `import asphalt_nscd as an` offers, each module one subject. See docs/python.md."""
