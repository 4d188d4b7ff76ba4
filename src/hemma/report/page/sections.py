"""The sections of the report about one home."""

from hemma.report.methods import grouped, main_method
from hemma.report.numbers import SPACE, degrees, money, seconds
from hemma.report.page.explanations import LIMITS, data_facts
from hemma.report.page.markup import (
    body,
    bullets,
    cell,
    definitions,
    figure,
    figure_or,
    heading,
    paragraph,
    row,
    table,
)
from hemma.report.page.sections_comparisons import comparisons_section
from hemma.report.pictures import HomePictures
from hemma.report.tables.results import TABLE_HEADINGS, TableRow
from hemma.results.results import HomeResults


def results_section(home: HomeResults, rows: list[TableRow], pictures: HomePictures) -> str:
    """The table and the figures of what the methods did."""
    wide = ("", "", "", "", "full", "full")
    return (
        _method_table(home, rows)
        + _optimum_line(home)
        + heading(3, "The six panels")
        + '<div class="figures">'
        + "".join(figure(picture, style) for picture, style in zip(pictures.panels, wide, strict=True))
        + "</div>"
        + figure(pictures.powers, "full")
        + heading(3, "A week of every method")
        + figure_or(pictures.traces, "No schedule in this folder.")
        + comparisons_section(home, pictures)
    )


def background_section(name: str, home: HomeResults, pictures: HomePictures) -> str:
    """Training, identification and data."""
    return (
        heading(2, f"Training, model and data of {name}")
        + heading(3, "Learning curves")
        + figure_or(pictures.learning, "No training curve in this folder.")
        + (figure(pictures.diagnostics, "full") if pictures.diagnostics else "")
        + heading(3, "Identification")
        + _identification(home, pictures)
        + heading(3, "Data, attribution and limits")
        + definitions(data_facts(home))
        + bullets((*home.notes, *LIMITS))
        + paragraph(f"SHA-256 of the traces: {home.traces_sha256 or 'not stated'}", "hash")
    )


def _method_table(home: HomeResults, rows: list[TableRow]) -> str:
    main = main_method(home.methods)
    by_method = {entry.method: entry for entry in rows}
    bodies = [
        body([_method_row(by_method[name], name == main) for name in names], title, len(TABLE_HEADINGS))
        for title, names in grouped(home.methods).items()
    ]
    return table("Mean over the seeds [95 % interval]", TABLE_HEADINGS, bodies)


def _method_row(entry: TableRow, is_main: bool) -> str:
    cells = (cell(measure.value, measure.detail) for measure in entry.measures)
    return row(entry.method, cells, "main" if is_main else "")


def _optimum_line(home: HomeResults) -> str:
    best = home.optimum
    if best is None or best.energy_cost is None:
        return ""
    gap = "" if best.relative_gap is None else f", a relative gap of {100 * best.relative_gap:.2g}{SPACE}%"
    return paragraph(
        f"Perfect information costs {money(best.energy_cost, home.currency)} with a mean deviation of "
        f"{degrees(best.mean_temperature_deviation)}; its proven lower bound is "
        f"{money(best.bound, home.currency)}{gap}.",
        "faint",
    )


def _identification(home: HomeResults, pictures: HomePictures) -> str:
    if home.identification is None:
        return paragraph("No thermal model was identified for this home.")
    cells = [row(horizon, [cell(degrees(error))]) for horizon, error in home.identification.rmse_c.items()]
    errors = table(
        "Root mean square error",
        ("Horizon", "Error"),
        [body(cells)],
    )
    took = paragraph(f"Fitting the network took {seconds(home.identification.seconds)}.")
    meaning = paragraph(
        "How far the network's indoor temperature is off after running on its own for so long."
    )
    return meaning + errors + took + (figure(pictures.free_run, "full") if pictures.free_run else "")
