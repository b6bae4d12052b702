"""A page on this machine to drop measurements on: how they were read, the diagnosis, files to take away."""
