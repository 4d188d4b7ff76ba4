"""The parts of the report about one home."""

from hemma.report import figures
from hemma.report.figures.figure import IDENTIFICATION, Part, Picture
from hemma.report.figures.regret import REGRET_SECTION
from hemma.report.methods import main_method
from hemma.report.numbers import SPACE, degrees, money, seconds
from hemma.report.page.explanations import LIMITS, data_facts
from hemma.report.page.markup import (
    Row,
    RowGroup,
    bullets,
    by_group,
    definitions,
    figure,
    heading,
    paragraph,
    table,
)
from hemma.report.tables.recommendation import HEADINGS, recommendation_rows, recommendation_sentence
from hemma.report.tables.results import TableRow, is_proven
from hemma.results.results import HomeResults

REGRET_HEADINGS = ("Method", "Regret", "Not knowing the future", "Identified thermal model", "Policy")


def results_part(name: str, home: HomeResults, rows: list[TableRow], pictures: dict[str, Picture]) -> str:
    """The table, the figures of what the methods did, and which of them the home should have."""
    found = by_group({row.method: row.measures.values() for row in rows}, main_method(home.methods))
    headings = ("Method", *rows[0].measures)
    return (
        table("Mean over the seeds [95 % interval for other seeds]", headings, found)
        + _optimum_line(home)
        + _sections(Part.RESULTS, home, pictures)
        + recommendation_section(name, home)
    )


def background_part(home: HomeResults, pictures: dict[str, Picture]) -> str:
    """Training, identification and data."""
    return (
        _sections(Part.BACKGROUND, home, pictures)
        + heading(3, "Data, attribution and limits")
        + definitions(data_facts(home))
        + bullets((*home.notes, *LIMITS))
        + paragraph(f"SHA-256 of the traces: {home.traces_sha256 or 'not stated'}", "hash")
    )


def _sections(part: Part, home: HomeResults, pictures: dict[str, Picture]) -> str:
    """The sections of a part in the order of their first figures, each with all of its figures."""
    known = [one for one in figures.FIGURES if one.section is not None and one.section.part is part]
    text = ""
    for section in dict.fromkeys(one.section for one in known if one.section is not None):
        members = [one for one in known if one.section == section]
        shown = [figure(pictures[one.name], one.is_wide) for one in members if one.name in pictures]
        missing = [paragraph(one.missing, "faint") for one in members if one.name not in pictures]
        above = _identification(home) if section == IDENTIFICATION else ""
        below = _regret_table(home) if section == REGRET_SECTION else ""
        grid = f'<div class="figures">{"".join(shown)}</div>' if shown else ""
        text += heading(3, section.title) + above + grid + "".join(missing) + below
    return text


def _optimum_line(home: HomeResults) -> str:
    best = home.optimum
    if best is None or best.energy_cost is None:
        return ""
    gap = "" if best.relative_gap is None else f", a relative gap of {100 * best.relative_gap:.2g}{SPACE}%"
    unproven = "" if is_proven(home) else " It is not proven: a controller may cost as little as that bound."
    return paragraph(
        f"Perfect information costs {money(best.energy_cost, home.currency)} with a mean deviation of "
        f"{degrees(best.mean_temperature_deviation)}; its proven lower bound is "
        f"{money(best.bound, home.currency)}{gap}.{unproven}",
        "faint",
    )


def recommendation_section(name: str, home: HomeResults) -> str:
    """Sentence and table; nothing where no method was judged."""
    found = home.recommendation
    if found is None:
        return ""
    rows = [
        Row(first, rest, "main" if first == found.method else "")
        for first, *rest in recommendation_rows(home)
    ]
    return (
        heading(3, "Which controller this home should have")
        + paragraph(recommendation_sentence(name, home))
        + table("Judged on training days alone", HEADINGS, [RowGroup(rows)])
    )


def _regret_table(home: HomeResults) -> str:
    rows = {
        name: [money(part, home.currency) for part in (it.total, it.future, it.thermal_model, it.policy)]
        for name, it in home.regret.items()
    }
    if not rows:
        return ""
    groups = by_group(rows, main_method(home.methods))
    return table("Regret and its parts, means over the seeds", REGRET_HEADINGS, groups)


def _identification(home: HomeResults) -> str:
    if home.identification is None:
        return paragraph("No thermal model was identified for this home.")
    rows = [Row(horizon, [degrees(error)]) for horizon, error in home.identification.rmse_c.items()]
    return (
        paragraph("How far the network's indoor temperature is off after running on its own for so long.")
        + table("Root mean square error", ("Horizon", "Error"), [RowGroup(rows)])
        + paragraph(f"Fitting the network took {seconds(home.identification.seconds)}.")
    )
