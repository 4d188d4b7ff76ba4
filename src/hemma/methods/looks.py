"""How methods look, the same in every figure."""

from dataclasses import dataclass

BLACK, GREY = "#000000", "#8A8A8A"
ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE = (
    "#E69F00",
    "#56B4E9",
    "#009E73",
    "#0072B2",
    "#D55E00",
    "#CC79A7",
)
"""The palette of Okabe and Ito (2008), which people with any common colour blindness can tell apart."""

DASHED, DOTTED, MIXED = (0, (5, 2)), (0, (1.2, 1.4)), (0, (5, 1.5, 1.2, 1.5))


@dataclass(frozen=True)
class Look:
    """Colour, line and marker of a method: no two methods share both colour and line."""

    colour: str
    line: str | tuple = "-"
    marker: str = "o"


UNKNOWN = tuple(Look(colour, DASHED, "h") for colour in (PURPLE, SKY, VERMILLION, GREEN, BLUE, ORANGE))
"""For methods without a look of their own."""
