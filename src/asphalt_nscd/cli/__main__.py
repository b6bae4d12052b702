"""`python -m asphalt_nscd.cli`: the command where it is not installed."""

from asphalt_nscd.cli import main

if __name__ == "__main__":
    main()
