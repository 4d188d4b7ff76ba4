"""The error that a user's mistake raises: its text is the whole message, never a traceback."""

LONGEST = 60
"""Of what came, so much is shown."""


class HemmaError(ValueError):
    """Bad input (a file, a setting, a time stamp, an unknown home).

    The text says what was expected, what came and where, and what to do. The command line prints it and
    exits with status 2; code that calls Hemma may catch it as a ``ValueError``.
    """


def shortened(value: object) -> str:
    """A value as a message shows it: one line of at most ``LONGEST`` characters."""
    text = " ".join(str(value).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
