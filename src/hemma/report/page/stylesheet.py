"""The look of the report: one column that fits any screen, dark where the reader wants it, plain on paper."""

STYLESHEET = """
:root { color-scheme: light dark; --ink: #1d2125; --faint: #5a6169; --paper: #ffffff; --card: #f5f6f8;
  --line: #d9dde2; --accent: #0067a3; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7e9ec; --faint: #a4abb3; --paper: #16191d;
  --card: #20242a; --line: #3a4048; --accent: #6cc0f5; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
main, header { max-width: 80rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 2rem; }
h1 { font-size: clamp(1.5rem, 4vw, 2.1rem); line-height: 1.2; margin: 0 0 .6rem; text-wrap: balance; }
h2 { font-size: 1.35rem; margin: 2.6rem 0 .6rem; padding-top: 1rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.08rem; margin: 1.8rem 0 .5rem; }
p, dl, ul { max-width: 46rem; }
.lead { font-size: 1.1rem; }
.kicker, .faint, figcaption, caption { color: var(--faint); }
.kicker { margin: 0 0 .4rem; font-size: .9rem; }
code, pre { font-family: ui-monospace, SFMono-Regular, Menlo, Consolas, monospace; font-size: .9em; }
pre { background: var(--card); padding: .8rem 1rem; border-radius: .4rem; overflow-x: auto; }
.hash { overflow-wrap: anywhere; font-size: .88rem; }
.wide { overflow-x: auto; margin: .8rem 0; scrollbar-width: thin; background:
  linear-gradient(to right, var(--paper) 40%, transparent) left / 3rem 100% no-repeat local,
  linear-gradient(to left, var(--paper) 40%, transparent) right / 3rem 100% no-repeat local,
  linear-gradient(to left, var(--faint), transparent) right / .7rem 100% no-repeat scroll; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding-bottom: .5rem; font-size: .88rem; }
th, td { padding: .32rem .55rem; text-align: right; vertical-align: top;
  border-bottom: 1px solid var(--line); }
th { font-weight: 600; }
thead th { vertical-align: bottom; border-bottom: 2px solid var(--faint); }
tbody th, thead th:first-child { text-align: left; padding-left: 0; white-space: nowrap; }
td { white-space: nowrap; }
tbody th:not(.group), thead th:first-child { position: sticky; left: 0; background: var(--paper); }
tbody th.group { color: var(--faint); font-weight: 400; font-size: .82rem; padding-top: .9rem; }
tr.main th:not(.group), tr.main td { background: color-mix(in srgb, var(--accent) 12%, var(--paper));
  font-weight: 600; }
tr.main th { padding-left: .4rem; }
td small { display: block; white-space: normal; color: var(--faint); font-size: .8em; font-weight: 400; }
table.text td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.figures { display: grid; gap: 1.2rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); }
.figures figure.full { grid-column: 1 / -1; }
figure { margin: 0 0 1.2rem; break-inside: avoid; }
figure .scroll { background: #ffffff; border: 1px solid var(--line); border-radius: .4rem; padding: .6rem; }
figure img { display: block; width: 100%; height: auto; }
figcaption { font-size: .88rem; margin-top: .45rem; max-width: 46rem; }
figure.full .scroll { overflow-x: auto; }
figure.full img { min-width: 36rem; }
figure.full { max-width: 72rem; }
dl { display: grid; grid-template-columns: minmax(8rem, 12rem) 1fr; gap: .55rem 1.2rem; max-width: 58rem; }
dt { font-weight: 600; }
dd { margin: 0; }
@media (max-width: 40rem) { dl { display: block; } dt { margin-top: .7rem; } }
@media screen and (max-width: 60rem) {
  .wide { overflow: visible; background: none; }
  table, caption, tbody, tr, td, th { display: block; }
  thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
  tbody tr { display: grid; grid-template-columns: repeat(auto-fill, minmax(8.2rem, 1fr)); gap: .3rem .8rem;
    padding: .5rem .4rem; border-bottom: 1px solid var(--line); }
  tbody tr.main { background: color-mix(in srgb, var(--accent) 12%, var(--paper)); }
  tbody th, tbody td, tbody th:not(.group) { border: 0; padding: 0; text-align: left; white-space: normal;
    background: none; }
  tbody th { grid-column: 1 / -1; position: static; }
  td.empty { display: none; }
  td::before { content: attr(data-label); display: block; color: var(--faint); font-size: .8em;
    font-weight: 400; }
  figure.full figcaption::before { content: "Scroll the figure sideways. "; }
}
@media screen and (min-width: 40rem) { figure.full figcaption::before { content: none; } }
@media print { body { font-size: 10pt; --paper: #ffffff; --ink: #000000; --faint: #444444; --line: #bbbbbb; }
  main, header { max-width: none; padding: 0; } h2, h3 { break-after: avoid; }
  .figures { grid-template-columns: 1fr 1fr; }
  tr, figure { break-inside: avoid; } .wide, figure.full .scroll { overflow: visible; }
  figure.full img { min-width: 0; } table { font-size: 7.5pt; }
  th, td { padding: .2rem .3rem; } pre { white-space: pre-wrap; } }
"""
