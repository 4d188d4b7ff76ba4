"""The few pieces of HTML that the report is made of; all text goes through ``escape``."""

import base64
from collections.abc import Iterable, Sequence
from html import escape

from hemma.report.drawing.canvas import Picture


def paragraph(text: str, style: str = "") -> str:
    """A paragraph of plain text."""
    return f"<p{_class(style)}>{escape(text)}</p>"


def heading(level: int, text: str, anchor: str = "") -> str:
    """A heading; ``anchor`` is where links point to."""
    place = f' id="{escape(anchor)}"' if anchor else ""
    return f"<h{level}{place}>{escape(text)}</h{level}>"


def bullets(items: Iterable[str]) -> str:
    """A list of plain text."""
    return "<ul>" + "".join(f"<li>{escape(item)}</li>" for item in items) + "</ul>"


def definitions(entries: Iterable[tuple[str, str]]) -> str:
    """Terms and what they mean."""
    return "<dl>" + "".join(f"<dt>{escape(a)}</dt><dd>{escape(b)}</dd>" for a, b in entries) + "</dl>"


def table(caption: str, headings: Sequence[str], bodies: Iterable[str]) -> str:
    """A table with its column heads; ``bodies`` are finished ``tbody`` elements."""
    columns = "".join(f'<th scope="col">{escape(text)}</th>' for text in headings)
    return (
        f'<div class="wide"><table><caption>{escape(caption)}</caption>'
        f"<thead><tr>{columns}</tr></thead>{''.join(bodies)}</table></div>"
    )


def body(rows: Iterable[str], title: str = "", columns: int = 0) -> str:
    """A group of finished rows, under a title over all ``columns`` if it has one."""
    head = f'<tr><th class="group" scope="rowgroup" colspan="{columns}">{escape(title)}</th></tr>'
    return f"<tbody>{head if title else ''}{''.join(rows)}</tbody>"


def row(title: str, cells: Iterable[str], style: str = "") -> str:
    """A row of finished cells under its own head."""
    return f'<tr{_class(style)}><th scope="row">{escape(title)}</th>{"".join(cells)}</tr>'


def cell(text: str, detail: str = "", style: str = "") -> str:
    """A cell, with something smaller below."""
    small = f"<small>{escape(detail)}</small>" if detail else ""
    return f"<td{_class(style)}>{escape(text)}{small}</td>"


def figure(picture: Picture, style: str = "") -> str:
    """A figure with the image inside the page: an SVG of its own, so that no two share identifiers."""
    data = base64.b64encode(picture.svg).decode()
    return (
        f'<figure{_class(style)}><div class="scroll">'
        f'<img src="data:image/svg+xml;base64,{data}" alt="{escape(picture.alternative)}"></div>'
        f"<figcaption><strong>{escape(picture.title)}.</strong> {escape(picture.caption)}</figcaption>"
        "</figure>"
    )


def figure_or(picture: Picture | None, reason: str) -> str:
    """A figure over the whole width, or a sentence that says why there is none."""
    return figure(picture, "full") if picture else paragraph(reason, "faint")


def _class(style: str) -> str:
    return f' class="{escape(style)}"' if style else ""
