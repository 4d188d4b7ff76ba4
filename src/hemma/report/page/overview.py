"""The start of a report on several homes: every method over all of them."""

from hemma.report import figures
from hemma.report.figures.figure import Picture
from hemma.report.methods import main_method
from hemma.report.page.headline import at_a_glance
from hemma.report.page.markup import Row, RowGroup, by_group, figure, heading, paragraph, table
from hemma.report.tables.aggregate import INTERVALS, PAIRED_HEADINGS, aggregate_rows, paired_rows
from hemma.results.results import Results


def overview(results: Results, pictures: dict[str, Picture]) -> str:
    """All methods over all homes, who beats whom, the figures over homes, the homes at a glance."""
    shown = [
        heading(2, one.section.title if one.section else "") + figure(pictures[one.name], one.is_wide)
        for one in figures.FIGURES_OVER_HOMES
        if one.name in pictures
    ]
    glance = {name: at_a_glance(home) for name, home in results.finished.items()}
    headings = ("Home", *next(iter(glance.values())))
    rows = [RowGroup([Row(name, cells.values()) for name, cells in glance.items()])]
    return (
        _methods_tables(results)
        + "".join(shown)
        + heading(2, "The homes")
        + table("The homes at a glance; means over the seeds", headings, rows)
    )


def _methods_tables(results: Results) -> str:
    rows = aggregate_rows(results)
    if not rows:
        return paragraph("No statistics over homes in this folder.", "faint")
    main, paired = main_method(rows), paired_rows(results, main_method(rows))
    cells = {name: by_heading.values() for name, by_heading in rows.items()}
    counted = len((results.aggregate and results.aggregate.homes) or results.finished)
    caption = f"Every method over {counted} homes, means over homes and seeds"
    against = f"{main} against the others, home by home; percentage points, above zero {main} keeps more"
    return (
        table(caption, ("Method", *rows[main]), by_group(cells, main))
        + paragraph(f"{INTERVALS[0].upper()}{INTERVALS[1:]}.", "faint")
        + (table(against, PAIRED_HEADINGS, by_group(paired)) if paired else "")
    )
