"""The few pieces of HTML that the report is made of; all text goes through ``escape``."""

import base64
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files

from hemma.report.figures.figure import Picture
from hemma.report.methods import grouped
from hemma.report.numbers import DASH
from hemma.report.tables.cells import Cell

_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
"""What the browser may load for a page: nothing from anywhere."""
_STYLESHEET = (files("hemma.report.page") / "report.css").read_text(encoding="utf-8")
"""One column that fits any screen, dark where the reader wants it, plain on paper."""


@dataclass(frozen=True)
class Row:
    """A row of a table under its own head."""

    title: str
    cells: Iterable[Cell | str]
    style: str = ""


@dataclass(frozen=True)
class RowGroup:
    """Rows that belong together, under a title if they have one."""

    rows: Iterable[Row]
    title: str = ""


def document(title: str, opening: str, content: str) -> str:
    """A whole page from finished HTML."""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>\n{_STYLESHEET}</style></head><body>"
        f"<header>{opening}</header><main>{content}</main></body></html>\n"
    )


def paragraph(text: str, style: str = "") -> str:
    """A paragraph of plain text; nothing for no text."""
    return f"<p{_class(style)}>{escape(text)}</p>" if text else ""


def heading(level: int, text: str) -> str:
    """A heading."""
    return f"<h{level}>{escape(text)}</h{level}>"


def bullets(items: Iterable[str]) -> str:
    """A list of plain text; nothing for no items."""
    listed = "".join(f"<li>{escape(item)}</li>" for item in items)
    return f"<ul>{listed}</ul>" if listed else ""


def definitions(meanings: Mapping[str, str]) -> str:
    """Terms and what they mean."""
    terms = (f"<dt>{escape(term)}</dt><dd>{escape(text)}</dd>" for term, text in meanings.items())
    return f"<dl>{''.join(terms)}</dl>"


def by_group(rows: Mapping[str, Iterable[Cell | str]], main: str = "") -> list[RowGroup]:
    """Rows by method under the titles of their groups; that of the ``main`` method stands out."""
    return [
        RowGroup([Row(name, rows[name], "main" if name == main else "") for name in names], title)
        for title, names in grouped(rows).items()
    ]


def table(caption: str, headings: Sequence[str], groups: Iterable[RowGroup], style: str = "") -> str:
    """A table with its column heads. Every cell knows its own: a narrow screen shows rows as cards."""
    columns = "".join(f'<th scope="col" role="columnheader">{escape(text)}</th>' for text in headings)
    bodies = "".join(_body(group, headings) for group in groups)
    return (
        f'<div class="wide" tabindex="0"><table role="table"{_class(style)}>'
        f'<caption>{escape(caption)}</caption><thead><tr role="row">{columns}</tr></thead>'
        f"{bodies}</table></div>"
    )


def figure(picture: Picture, is_wide: bool = True) -> str:
    """A figure with the image inside the page: an SVG of its own, so that no two share identifiers."""
    data, words = base64.b64encode(picture.svg).decode(), picture.words
    return (
        f'<figure{_class("full" if is_wide else "")}><div class="scroll">'
        f'<img src="data:image/svg+xml;base64,{data}" alt="{escape(words.alternative)}"></div>'
        f"<figcaption><strong>{escape(words.title)}.</strong> {escape(words.caption)}</figcaption>"
        "</figure>"
    )


def _body(group: RowGroup, headings: Sequence[str]) -> str:
    head = (
        f'<tr role="row"><th class="group" scope="rowgroup" role="rowheader" colspan="{len(headings)}">'
        f"{escape(group.title)}</th></tr>"
    )
    rows = "".join(_row(row, headings) for row in group.rows)
    return f'<tbody role="rowgroup">{head if group.title else ""}{rows}</tbody>'


def _row(row: Row, headings: Sequence[str]) -> str:
    cells = "".join(_cell(one, heading) for one, heading in zip(row.cells, headings[1:], strict=True))
    head = f'<th scope="row" role="rowheader">{escape(row.title)}</th>'
    return f'<tr role="row"{_class(row.style)}>{head}{cells}</tr>'


def _cell(one: Cell | str, heading: str) -> str:
    cell = Cell(one) if isinstance(one, str) else one
    small = f"<small>{escape(cell.detail)}</small>" if cell.detail else ""
    empty = "empty" if str(cell) == DASH else ""
    return f'<td role="cell"{_class(empty)} data-label="{escape(heading)}">{escape(cell.value)}{small}</td>'


def _class(style: str) -> str:
    return f' class="{escape(style)}"' if style else ""
