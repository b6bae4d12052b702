"""The one exception a user is meant to read."""


class InputError(Exception):
    """Input that cannot be used.

    The message is one sentence that names the file, the row or key, and the mend. The command
    line prints it alone, without a traceback, and exits with status 2.
    """
