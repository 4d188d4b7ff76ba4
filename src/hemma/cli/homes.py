"""Which embedded homes are meant."""

from hemma.errors import HemmaError


def chosen_homes(home: list[int] | None, homes: str | None) -> tuple[int, ...]:
    """The numbers given with ``--home N`` (repeated) or ``--homes all|1,3,5``; empty where neither is given.

    Raises ``HemmaError`` where both are given, and for a list that is not one of homes that there are.
    """
    if homes is None:
        return tuple(home or ())
    if home:
        raise HemmaError("expected --home N or --homes LIST, got both; leave one of them out")
    from hemma.data import AUSTIN2021_HOMES

    if homes.strip() == "all":
        return AUSTIN2021_HOMES
    return _listed(homes, AUSTIN2021_HOMES)


def _listed(homes: str, known: tuple[int, ...]) -> tuple[int, ...]:
    listed = [text.strip() for text in homes.split(",")]
    for text in listed:
        found = repr(text) if text else "nothing"
        if text not in map(str, known):
            raise HemmaError(
                f"--homes: expected all, or numbers from {known[0]} to {known[-1]} with commas between them "
                f"such as 1,3,5, got {found} in {homes!r}. Correct it"
            )
        if listed.count(text) > 1:
            raise HemmaError(f"--homes: expected each home once, got {text} twice in {homes!r}. Correct it")
    return tuple(map(int, listed))
