"""The whole report as one page that needs nothing outside itself."""

from collections.abc import Iterator
from html import escape
from typing import Any

from hemma.report.figures.figure import Picture
from hemma.report.page.explanations import method_meanings, metric_meanings
from hemma.report.page.headline import headline, range_of_shares
from hemma.report.page.home import background_part, results_part
from hemma.report.page.markup import Row, RowGroup, definitions, document, heading, paragraph, table
from hemma.report.page.overview import overview
from hemma.report.pictures import Pictures
from hemma.report.tables.results import results_table
from hemma.results.results import Results


def report_page(results: Results, pictures: Pictures) -> str:
    """The HTML of the report."""
    title = _title(results)
    parts = [_home_part(results, name, pictures.homes[name]) for name in results.finished]
    background = [
        heading(2, f"Training, model and data of {name}") + background_part(home, pictures.homes[name])
        for name, home in results.finished.items()
    ]
    content = "".join([*parts, _reading_section(results), *background, _settings_section(results)])
    return document(title, _opening(results, title, pictures), content)


def _home_part(results: Results, name: str, pictures: dict[str, Picture]) -> str:
    """A home's results; of one home alone the page's opening has said the sentences already."""
    rows, home = [row for row in results_table(results) if row.home == name], results.homes[name]
    said = paragraph(headline(name, home).text, "lead") if len(results.finished) > 1 else ""
    return heading(2, f"Results on {name}") + said + results_part(name, home, rows, pictures)


def _title(results: Results) -> str:
    (name, home), *others = results.finished.items()
    if not others:
        return headline(name, home).title
    shares = range_of_shares(list(results.finished.values()))
    counted = f"{len(others) + 1} homes"
    return f"{counted}: {shares} of the possible savings kept" if shares else f"Results on {counted}"


def _opening(results: Results, title: str, pictures: Pictures) -> str:
    missing = ", ".join(results.unfinished)
    (name, home), *others = results.finished.items()
    return (
        paragraph(f"Hemma {results.hemma}: home energy management that learns from an optimiser", "kicker")
        + heading(1, title)
        + (overview(results, pictures.over_homes) if others else paragraph(headline(name, home).text, "lead"))
        + (paragraph(f"Not finished yet: {missing}.") if missing else "")
    )


def _reading_section(results: Results) -> str:
    return (
        heading(2, "How to read it")
        + definitions(metric_meanings(results))
        + heading(3, "The methods")
        + definitions(method_meanings(results))
    )


def _settings_section(results: Results) -> str:
    rows = [Row(name, [value]) for name, value in _flattened("", results.settings)]
    settings = table("Settings", ("Setting", "Value"), [RowGroup(rows)], "text")
    return (
        heading(2, "Settings, and how to get this again")
        + (settings if rows else paragraph("No settings are stored with these results."))
        + paragraph(f"Computed by Hemma {results.hemma} with:")
        + f"<pre>{escape(results.command)}</pre>"
        + paragraph("This report was written from the files of the results folder alone.")
    )


def _flattened(prefix: str, value: Any) -> Iterator[tuple[str, str]]:
    """Nested settings as dotted names, lists of plain values on one line."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flattened(f"{prefix}.{key}" if prefix else str(key), inner)
    elif isinstance(value, list) and any(isinstance(inner, (dict, list)) for inner in value):
        for position, inner in enumerate(value):
            yield from _flattened(f"{prefix}.{position}", inner)
    elif isinstance(value, list):
        yield prefix, ", ".join(str(inner) for inner in value)
    else:
        yield prefix, "not set" if value is None else str(value)
