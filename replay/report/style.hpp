// SPDX-License-Identifier: MIT
// The style sheet of the HTML report: light, dark and print, and the classes of the pictures (svg.hpp).
#pragma once

#include <string_view>

namespace servotrace::report {

inline constexpr std::string_view kStyle = R"css(
:root{--ink:#1c2128;--soft:#596370;--line:#d5dbe1;--paper:#fff;--panel:#f5f7f9;--accent:#0a58b4;--bar:#6f90b4;--bar-ink:#10243a;--bad:#b3261e;--bad-ink:#fff;--bad-soft:#fbe9e7;--warn:#855700;--warn-soft:#fdf3dc;--note:#3f6478;--good:#1b6b36;--good-soft:#e6f4ea;--mark:#fff0bf;--stripe:#f8fafb}
@media (prefers-color-scheme:dark){:root{--ink:#e4eaf0;--soft:#a0acb8;--line:#36404a;--paper:#13171c;--panel:#1b2127;--accent:#7fbcff;--bar:#4a709a;--bar-ink:#f6faff;--bad:#ff8b7d;--bad-ink:#2a0b07;--bad-soft:#3a1f1d;--warn:#e9b950;--warn-soft:#352a12;--note:#93bdd4;--good:#76d093;--good-soft:#16301f;--mark:#4b3e12;--stripe:#171c21}}
*{box-sizing:border-box}
html{scroll-behavior:smooth}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","Liberation Sans",sans-serif;color:var(--ink);background:var(--paper);margin:0 auto;max-width:1180px;padding:28px 32px 64px}
h1{font-size:1.7rem;line-height:1.25;margin:0 0 2px;overflow-wrap:anywhere}
h2,section h3{font-size:1.3rem;margin:44px 0 10px;border-bottom:2px solid var(--line);padding-bottom:5px}
h3,section h4{font-size:1.08rem;margin:28px 0 8px}
h4,section h5{font-size:.95rem;margin:20px 0 4px}
h2.capture{font-size:1.7rem;border:0;margin-bottom:2px;overflow-wrap:anywhere}
a{color:var(--accent);text-underline-offset:2px}
p{margin:6px 0}
.eyebrow{color:var(--soft);text-transform:uppercase;letter-spacing:.07em;font-size:.75rem;font-weight:600;margin:0}
.facts{color:var(--soft);margin:0 0 10px;overflow-wrap:anywhere}
.figures{display:flex;flex-wrap:wrap;gap:10px;margin:16px 0;padding:0}
.figures div{background:var(--panel);border:1px solid var(--line);border-radius:8px;padding:8px 16px;min-width:104px}
.figures dt{color:var(--soft);font-size:.8rem}.figures dd{margin:0;font-size:1.3rem;font-weight:650;font-variant-numeric:tabular-nums}
.figures .error dd{color:var(--bad)}.figures .warning dd{color:var(--warn)}
nav ul{display:flex;flex-wrap:wrap;gap:4px 18px;list-style:none;padding:0;margin:10px 0 0;font-size:.92rem}
.verdict{border:1px solid var(--line);border-left:7px solid var(--good);background:var(--good-soft);padding:16px 20px;border-radius:8px}
.verdict.fault{border-left-color:var(--bad);background:var(--bad-soft)}.verdict.violations{border-left-color:var(--warn);background:var(--warn-soft)}.verdict.nothing{border-left-color:var(--soft);background:var(--panel)}
.verdict .headline{font-size:1.2rem;line-height:1.4;font-weight:650;margin:0 0 8px}
table{border-collapse:collapse;width:100%;margin:8px 0;font-size:.9rem}
th,td{border-bottom:1px solid var(--line);padding:5px 10px;text-align:left;vertical-align:top}
thead th,thead td{color:var(--soft);font-weight:600;font-size:.82rem;border-bottom-width:2px;white-space:nowrap}
tbody th{font-weight:600;color:var(--soft);width:16rem}
tbody tr:nth-child(even){background:var(--stripe)}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
tr>.number:first-child,tr>.number:first-child+.number,tr>.number:first-child+.number+.number{width:1%}
td.section,td.who{white-space:nowrap}
tr.fault-row td{background:var(--bad-soft);font-weight:600}
.wide{overflow-x:auto}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(430px,1fr));gap:0 28px}
.pair>div{min-width:0}
td.differs{background:var(--mark);font-weight:600}
code,.evidence{font-family:ui-monospace,"SF Mono","DejaVu Sans Mono",Consolas,monospace;font-size:.82rem}
.evidence{margin:2px 0 2px 16px;overflow-wrap:anywhere;color:var(--soft)}
.evidence b{color:var(--ink);font-weight:600}
.severity,.chip{display:inline-block;font-weight:600;font-size:.78rem;line-height:1.35;white-space:nowrap;border:1px solid currentColor;border-radius:999px;padding:0 8px}
.severity.error{color:var(--bad)}.severity.warning{color:var(--warn)}.severity.note{color:var(--note)}
.chip.yes{color:var(--good)}.chip.maybe{color:var(--soft)}
ol.causes{padding-left:24px}ol.causes li{margin:7px 0}
.finding{margin:10px 0 2px}
details{margin:8px 0}summary{cursor:pointer;color:var(--accent)}
figure{margin:10px 0}figcaption{color:var(--soft);font-size:.85rem}
svg{width:100%;height:auto;display:block;background:var(--paper)}
svg text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","Liberation Sans",sans-serif;fill:var(--ink)}
svg .tick{fill:var(--soft);font-size:11px}svg .state{fill:var(--soft);font-size:11px}svg .lane-name{font-weight:650;font-size:13px}svg .in-bar{fill:var(--bar-ink);font-size:10px}svg .in-bar.on-bad{fill:var(--bad-ink)}
svg .grid{stroke:var(--line);stroke-width:.7}svg .lane{stroke:var(--line);stroke-width:1}svg .lane-back{fill:var(--stripe)}
svg .bar{fill:var(--bar)}svg .bar.bad{fill:var(--bad)}
svg .error{fill:var(--bad)}svg .warning{fill:var(--warn)}svg .note{fill:var(--note)}
svg .episode{stroke-width:3;opacity:.7}svg .episode.error{stroke:var(--bad)}svg .episode.warning{stroke:var(--warn)}svg .episode.note{stroke:var(--note)}
svg .first-fault{stroke:var(--bad);stroke-width:1.6;stroke-dasharray:5 3}svg .first-fault-text{fill:var(--bad);font-weight:650}
svg .violation-line{stroke:var(--warn);stroke-width:1;stroke-dasharray:2 3}
svg .curve{fill:none;stroke:var(--accent);stroke-width:1.5;stroke-linejoin:round}
section{margin-top:72px}td a{overflow-wrap:break-word}a.rule{white-space:nowrap}
.skip{position:absolute;left:-9999px}.skip:focus{left:16px;top:8px;background:var(--paper);padding:4px 10px}
footer{margin-top:56px;color:var(--soft);font-size:.85rem;border-top:1px solid var(--line);padding-top:8px}
@media (max-width:640px){body{padding:16px}.pair{grid-template-columns:1fr}}
@media print{:root{--ink:#000;--soft:#444;--line:#bbb;--paper:#fff;--panel:#f4f4f4;--accent:#003a8c;--bar:#6f8dae;--bar-ink:#000;--bad:#a01010;--bad-ink:#fff;--bad-soft:#fdf0ee;--warn:#6d4600;--warn-soft:#fff8e6;--note:#345;--good:#0d5a28;--good-soft:#f0f8f2;--mark:#ffe9a8;--stripe:#fafafa}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}
@page{margin:14mm}section{break-before:page}body{max-width:none;padding:0;font-size:9.5pt}h2,h3,h4,h5,thead{break-after:avoid}h2,section h3{margin-top:26px}figure,tr,.verdict,.figures,.finding{break-inside:avoid}
nav,.skip,summary,details.long{display:none}details::details-content{content-visibility:visible;display:block}.wide{overflow:visible}.pair{grid-template-columns:1fr 1fr;gap:0 14px}.pair table{font-size:7.5pt}table{font-size:8.5pt}thead th,thead td{font-size:8pt}th,td{padding:2px 5px}.evidence{font-size:7.5pt}}
)css";

}  // namespace servotrace::report
