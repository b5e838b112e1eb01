#pragma once

namespace hgmm::evaluation {

/// Only tables are wider than a phone: they scroll within their own boxes, the names of the
/// maps staying in sight.
constexpr const char* kReportStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1240px; padding: 16px; background: #fff; color: #1b1b1b;
  font: 16px/1.45 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.7em; line-height: 1.2; margin: .2em 0; }
h2 { font-size: 1.25em; margin: 1.6em 0 .4em; border-bottom: 1px solid #ccc; }
h3 { font-size: 1.05em; margin: 0 0 .3em; }
.note { color: #505050; font-size: .9em; max-width: 75em; }
.warning { border-left: 5px solid #d55e00; background: #fdf0e6; padding: .5em .8em; }
.facts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 300px), 1fr));
  gap: .5em 1.5em; margin: 1em 0; }
.facts dt { color: #505050; font-size: .85em; }
.facts dd { margin: 0; }
.scroll { overflow-x: auto; margin: .8em 0; }
table { border-collapse: collapse; font-size: .88em; font-variant-numeric: tabular-nums; }
th, td { padding: .3em .65em; text-align: right; overflow-wrap: normal; }
td { white-space: nowrap; }
thead th { vertical-align: bottom; border-bottom: 2px solid #444; min-width: 5.8em; }
th small { display: block; font-weight: 400; color: #505050; }
tr > :first-child { text-align: left; position: sticky; left: 0; background: #fff;
  min-width: 10.5em; max-width: 17em; }
tbody tr + tr > * { border-top: 1px solid #e4e4e4; }
tbody th { overflow-wrap: anywhere; }
tbody.unranked tr:first-child > * { border-top: 2px solid #444; }
tbody.unranked td, tbody.unranked th { color: #505050; }
.grid { display: grid; gap: 1em; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr)); }
figure { margin: 0; border: 1px solid #ddd; border-radius: 6px; padding: .6em; min-width: 0; }
figure svg, figure img { display: block; width: 100%; height: auto; }
figcaption { color: #505050; font-size: .85em; margin-top: .4em; }
.map { margin: 0 0 1.2em; }
.map p { margin: .1em 0; }
.options { font-size: .85em; color: #333; }
.options span { display: inline-block; margin-right: 1.1em; }
@media print {
  @page { margin: 12mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  .scroll { overflow: visible; }
  table { font-size: 7pt; }
  th, td { padding: .2em .3em; }
  thead th { min-width: 0; }
  tr > :first-child { position: static; min-width: 0; }
  .grid { grid-template-columns: 1fr 1fr; }
  figure, tr, .map { break-inside: avoid; }
  h2 { break-after: avoid; }
}
)";

}  // namespace hgmm::evaluation
