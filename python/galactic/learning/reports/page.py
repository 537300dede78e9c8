"""Self-contained pages with the curves of one or several runs: they load nothing, and have a light
and a dark mode."""

from __future__ import annotations

import dataclasses
import html
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from galactic.learning.rollouts.episode_sums import LOG, MEASURE
from galactic.learning.setting_fields import typed

OF_VALIDATION = "validation_"


class Line(NamedTuple):
    """A line of a chart: a column, its label in the legend, and the number of its table in the
    page."""

    column: str
    label: str
    table: int = 0


class Table(NamedTuple):
    """The contents of a curves.csv."""

    columns: Sequence[str]
    rows: Sequence[Sequence[float | None]]


@dataclass(frozen=True)
class Chart:
    """A chart. `unit`: the unit of the vertical axis, whose range always includes the numbers of
    `axis`."""

    title: str
    unit: str
    lines: Sequence[Line]
    axis: Sequence[float] = ()


def _of_episodes(title: str, unit: str, column: str, axis: Sequence[float] = ()) -> Chart:
    lines = Line(column, "training"), Line(OF_VALIDATION + column, "validation")
    return Chart(title, unit, lines, axis)


EPISODES = (
    _of_episodes("Success", "share of episodes", "success", (0.0, 0.1)),
    _of_episodes("Target picked", "share of episodes", "picked", (0.0, 0.1)),
    _of_episodes("Return", "reward per episode", "return"),
    _of_episodes("Length", "steps per episode", "length", (0.0,)),
)
LEARNING = (
    Chart("Speed", "steps per second", (Line("sps", "training"),), (0.0,)),
    Chart("Value loss", "", (Line("value_loss", "value loss"),)),
    Chart("Policy loss", "", (Line("policy_loss", "policy loss"),)),
    Chart("Entropy", "nats", (Line("entropy", "entropy"),)),
    Chart("Divergence of an update", "nats", (Line("kl", "KL"),)),
    Chart("Clipped", "share of steps", (Line("clipped", "clipped"),), (0.0, 0.1)),
    Chart("Norm of the gradient", "", (Line("grad_norm", "norm"),)),
    Chart("Explained variance", "of the returns", (Line("explained_variance", "explained"),)),
    Chart("Learning rate", "", (Line("learning_rate", "rate"),)),
)


def _charts(columns: Sequence[str]) -> list[Chart]:
    """The charts for a page: those of every run, and one for each thing that a user-defined task
    reports."""
    measured = [
        _of_episodes(name.removeprefix(MEASURE), "mean of episodes", name)
        for name in columns
        if name.startswith(MEASURE)
    ]
    logged = [
        _of_episodes(name.removeprefix(LOG), "mean of steps", name)
        for name in columns
        if name.startswith(LOG) and name != "log_std"
    ]
    return [*EPISODES, *measured, *logged, *LEARNING]


MOST_POINTS = 1500
"""Rows of longer runs are thinned out for the page; the CSV has all of them."""


def curves_page(title: str, columns: Sequence[str], rows: Sequence[Sequence[float | None]],
                settings: Mapping[str, Any], breakdown: Sequence[tuple[str, float]]) -> str:  # fmt: skip
    """The page of a run as text. `breakdown`: names and shares of its time."""
    shares = table([(name, f"{100.0 * share:.1f} %") for name, share in breakdown])
    typed_settings = table([(name, str(typed(value))) for name, value in settings.items()])
    below = (
        f"<div><h2>Where the time went</h2>{shares}</div>"
        f"<div><h2>Settings</h2>{typed_settings}</div>"
    )
    return _page(title, [Table(columns, rows)], _charts(columns), below)


def overlaid_page(title: str, runs: Mapping[str, Table], below: str) -> str:
    """A page as text, on which each chart has a line for each of the named runs. `below`: HTML
    under the charts."""
    columns = dict.fromkeys(name for run in runs.values() for name in run.columns)
    charts = []
    for chart in _charts(list(columns)):
        for line in chart.lines:
            title_of = f"{chart.title}, {line.label}" if len(chart.lines) > 1 else chart.title
            lines = [Line(line.column, name, number) for number, name in enumerate(runs)]
            charts.append(dataclasses.replace(chart, title=title_of, lines=lines))
    # Validations come first, as policies are chosen by them.
    charts.sort(key=lambda chart: not chart.lines[0].column.startswith(OF_VALIDATION))
    return _page(title, list(runs.values()), charts, below)


def _page(title: str, tables: Sequence[Table], charts: Sequence[Chart], below: str) -> str:
    data = {
        "tables": [_thinned_out(one) for one in tables],
        "charts": [dataclasses.asdict(chart) for chart in charts],
    }
    # "<" would let a string end the script.
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return _PAGE.format(title=html.escape(title), data=text, below=below)


def _thinned_out(whole: Table) -> dict[str, Any]:
    """The part of a table for the page: all validations, and every n-th of the other rows."""
    columns, rows = whole
    stride = max(1, math.ceil(len(rows) / MOST_POINTS))
    validated = [n for n, name in enumerate(columns) if name.startswith(OF_VALIDATION)]
    kept = [
        row
        for number, row in enumerate(rows)
        if number % stride == 0
        or number == len(rows) - 1
        or any(row[column] is not None for column in validated)
    ]
    return {"columns": list(columns), "rows": [[_short(value) for value in row] for row in kept]}


def _short(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(f"{value:.6g}")


def table(rows: Sequence[Sequence[str]]) -> str:
    """An HTML table; the first cell of each row is its heading."""
    lines = (
        f"<tr><th>{html.escape(name)}</th>{''.join(f'<td>{html.escape(one)}</td>' for one in cells)}</tr>"
        for name, *cells in rows
    )
    return '<div class="wide"><table>' + "".join(lines) + "</table></div>"


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
:root {{ color-scheme: light dark; --back: #fff; --ink: #1c2024; --faint: #8b9198; --grid: #e4e7ea;
  --line0: #2563b0; --line1: #d9730d; --line2: #1a8f5a; --line3: #b8336a; --line4: #7a4fc0; --line5: #8a6d1f;
  --line6: #1b8fa3; --line7: #63707c; }}
@media (prefers-color-scheme: dark) {{
  :root {{ --back: #16191c; --ink: #e6e8ea; --faint: #8b9198; --grid: #2c3136; --line0: #6ea8ec;
    --line1: #f0a35e; --line2: #5fce98; --line3: #ee7fae; --line4: #b79af0; --line5: #d8bd6a; --line6: #63cfe0;
    --line7: #a8b3bd; }} }}
body {{ background: var(--back); color: var(--ink); font: 15px/1.45 system-ui, sans-serif;
  margin: 1.5rem; }}
h1 {{ font-size: 1.3rem; margin: 0 0 .2rem; }}
h2 {{ font-size: .95rem; margin: 0; }}
h2 small {{ color: var(--faint); font-weight: normal; }}
#now, label {{ color: var(--faint); }}
#charts {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(21rem, 1fr)); gap: 1.2rem;
  margin: 1rem 0 2rem; }}
svg {{ width: 100%; display: block; overflow: visible; }}
svg text {{ fill: var(--faint); font-size: 11px; font-variant-numeric: tabular-nums; }}
.grid {{ stroke: var(--grid); }}
.line {{ fill: none; stroke-width: 1.6; stroke-linejoin: round; }}
.legend span {{ margin-right: .8rem; white-space: nowrap; display: inline-block; }}
table {{ border-collapse: collapse; font-size: .85rem; }}
th, td {{ text-align: left; font-weight: normal; padding: .08rem 1.2rem .08rem 0; }}
th {{ color: var(--faint); }}
.tables {{ display: flex; gap: 3rem; flex-wrap: wrap; }}
.wide {{ overflow-x: auto; max-width: 100%; }}
</style>
</head>
<body>
<h1>{title}</h1>
<p id="now"></p>
<label>Against <select id="axis"><option value="steps">steps</option>
<option value="seconds">wall clock</option></select></label>
<div id="charts"></div>
<div class="tables">{below}</div>
<script>
"use strict";
const data = {data};
const colors = 8;
const style = (what, number) => `${{what}}:var(--line${{number % colors}})`;
const dashes = number => number < colors ? "" : `;stroke-dasharray:${{4 * Math.floor(number / colors)}} 3`;
const svg = (tag, attributes, text) => {{
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}};
const short = v => {{
  const a = Math.abs(v);
  if (a >= 1e9) return +(v / 1e9).toPrecision(3) + " G";
  if (a >= 1e6) return +(v / 1e6).toPrecision(3) + " M";
  if (a >= 1e4) return +(v / 1e3).toPrecision(3) + " k";
  if (a > 0 && a < 1e-3) return v.toExponential(1);
  return String(+v.toPrecision(3));
}};
const clock = s => s < 120 ? Math.round(s) + " s" : s < 7200 ? +(s / 60).toFixed(1) + " min"
  : +(s / 3600).toFixed(2) + " h";
const ticks = (low, high, count) => {{
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(k => k * power).find(s => s >= rough);
  const found = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + step * 1e-9; v += step) found.push(v);
  return found;
}};
function chart(spec, axis) {{
  const lines = spec.lines.map(([name, label, table], number) => {{
    const {{ columns, rows }} = data.tables[table], x = columns.indexOf(axis), y = columns.indexOf(name);
    const points = y < 0 ? [] : rows.filter(r => r[x] !== null && r[y] !== null).map(r => [r[x], r[y]]);
    return {{ label, number, points, isSparse: name.startsWith("validation_") || points.length === 1 }};
  }}).filter(line => line.points.length);
  if (!lines.length) return null;
  const all = lines.flatMap(line => line.points), ys = all.map(p => p[1]);
  const right = Math.max(...all.map(p => p[0])) || 1;
  let low = Math.min(...ys, ...spec.axis), high = Math.max(...ys, ...spec.axis);
  if (high - low < 1e-12) {{ low -= .5; high += .5; }}
  const W = 400, H = 220, L = 46, R = 8, T = 10, B = 24;
  const px = v => L + (W - L - R) * v / right, py = v => T + (H - T - B) * (high - v) / (high - low);
  const root = svg("svg", {{ viewBox: `0 0 ${{W}} ${{H}}`, role: "img", "aria-label": spec.title }});
  for (const v of ticks(low, high, 5)) {{
    root.append(svg("line", {{ class: "grid", x1: L, x2: W - R, y1: py(v), y2: py(v) }}),
      svg("text", {{ x: L - 6, y: py(v) + 4, "text-anchor": "end" }}, short(v)));
  }}
  for (const v of ticks(0, right, 4)) root.append(svg("text", {{ x: px(v), y: H - 6,
    "text-anchor": "middle" }}, axis === "steps" ? short(v) : clock(v)));
  for (const line of lines) {{
    root.append(svg("polyline", {{ class: "line", style: style("stroke", line.number) + dashes(line.number),
      points: line.points.map(p => px(p[0]).toFixed(1) + "," + py(p[1]).toFixed(1)).join(" ") }}));
    if (line.isSparse) for (const p of line.points)
      root.append(svg("circle", {{ cx: px(p[0]), cy: py(p[1]), r: 2.5, style: style("fill", line.number) }}));
  }}
  const box = document.createElement("div"), head = document.createElement("h2");
  head.textContent = spec.title + " ";
  const unit = document.createElement("small");
  unit.textContent = spec.unit;
  head.append(unit);
  box.append(head, root);
  if (spec.lines.length > 1) {{
    const legend = document.createElement("div");
    legend.className = "legend";
    for (const line of lines) {{
      const name = document.createElement("span");
      name.style = style("color", line.number);
      name.textContent = line.label + " " + short(line.points[line.points.length - 1][1]);
      legend.append(name);
    }}
    box.append(legend);
  }}
  return box;
}}
function draw() {{
  const axis = document.getElementById("axis").value;
  document.getElementById("charts").replaceChildren(
    ...data.charts.map(spec => chart(spec, axis)).filter(Boolean));
}}
const [{{ columns, rows }}] = data.tables, last = rows[rows.length - 1];
if (last && data.tables.length === 1) document.getElementById("now").textContent =
  short(last[columns.indexOf("steps")]) + " steps in " + clock(last[columns.indexOf("seconds")]);
document.getElementById("axis").addEventListener("change", draw);
draw();
</script>
</body>
</html>
"""
