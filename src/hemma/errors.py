"""The error that a user's mistake raises: its text is the whole message, never a traceback."""

LONGEST = 60
"""Of what came, so much is shown."""


class HemmaError(ValueError):
    """Bad input (a file, a setting, a time stamp, an unknown home).

    The text says what was expected, what came and where, and what to do. The command line prints it and
    exits with status 2; code that calls Hemma may catch it as a ``ValueError``.
    """


class ParameterError(HemmaError):
    """A parameter that makes no sense: kept in parts, so that a settings file can tell it by its own keys."""

    def __init__(self, owner: str, expected: str, came: object):
        """``expected`` is in the names of the parameters."""
        super().__init__(f"{owner}: expected {expected}, got {shortened(came)}; correct this setting")
        self.owner, self.expected, self.came = owner, expected, came


def shortened(value: object, longest: int = LONGEST) -> str:
    """A value as a message shows it: one line, at most ``longest`` characters of it."""
    text = " ".join(str(value).split())
    return text if len(text) <= longest else f"{text[:longest]}... ({len(text)} characters)"
