"""Numbers as people read them: units, signs, digits, and an en dash where there is no number."""

DASH = "–"
"""Stands where a number does not exist."""
SPACE = "\u00a0"


def money(value: float | None, currency: str, digits: int = 2) -> str:
    """``$31.20``, or ``31.20 SEK`` for a currency of several letters."""
    if value is None:
        return DASH
    amount = decimals(abs(value), digits)
    sign = "−" if value < 0 and float(amount) != 0 else ""
    return f"{sign}{currency}{amount}" if len(currency) == 1 else f"{sign}{amount}{SPACE}{currency}"


def decimals(value: float | None, digits: int) -> str:
    """A fixed number of digits, with a true minus sign and no negative zero."""
    if value is None:
        return DASH
    return f"{round(value, digits) + 0.0:.{digits}f}".replace("-", "−")


def hundredths(fraction: float | None) -> str:
    """``95.1`` of the fraction 0.951."""
    return DASH if fraction is None else decimals(100 * fraction, 1)


def percent(fraction: float | None) -> str:
    """``95.1 %`` of the fraction 0.951."""
    return DASH if fraction is None else f"{hundredths(fraction)}{SPACE}%"


def fine(value: float | None) -> str:
    """``0.0042``, ``<0.0001``, ``0``, and ``66.1`` from ten on: only zero reads as zero."""
    if value is None:
        return DASH
    if value == 0:
        return "0"
    if abs(value) < 0.00005:
        return "<0.0001" if value > 0 else ">−0.0001"
    return decimals(value, 4 if abs(value) < 10 else 1)


def degrees(value: float | None) -> str:
    """``0.0042 °C``."""
    return DASH if value is None else f"{fine(value)}{SPACE}°C"


def seconds(value: float | None) -> str:
    """``74 s``, with one digit more below ten."""
    if value is None:
        return DASH
    return f"{decimals(value, 0 if abs(value) >= 9.95 else 1)}{SPACE}s"


def rough(value: float) -> str:
    """``0.151`` for 0.151476: three digits say enough of a value that was swept."""
    return f"{value:.3g}".replace("-", "−")


def plain(value: float) -> str:
    """``15`` for 15.0, ``0.5`` for 0.5."""
    return f"{value:g}".replace("-", "−")
