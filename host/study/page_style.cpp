#include "page.hpp"

namespace postfx::host::study {

std::string page_style() {
    return R"(:root{--page:#f6f4ee;--card:#fffefb;--text:#1f2733;--muted:#5f6b7a;--edge:#e0ddd3;--link:#1f5fa8;
--warm:#b8500f;
--shade:#f1eee5}
@media (prefers-color-scheme:dark){:root{--page:#101318;--card:#181c23;--text:#e6e8ec;--muted:#9aa5b4;
--edge:#2b313b;
--link:#82b6f5;--warm:#f2a365;--shade:#1f242d}}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--page);color:var(--text);
font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
header,main{max-width:1180px;margin:0 auto;padding:0 20px}
header{padding-top:40px}
h1{font-size:clamp(28px,5vw,42px);line-height:1.15;margin:0;letter-spacing:-.02em}
h2{font-size:24px;letter-spacing:-.01em;margin:0 0 4px}
h3{font-size:18px;margin:24px 0 8px}
h4{font-size:16px;margin:20px 0 4px}
h4 small{font-weight:400;color:var(--muted)}
.lead{font-size:18px;color:var(--muted);max-width:44em;margin:10px 0 0}
section{background:var(--card);border:1px solid var(--edge);border-radius:12px;padding:24px;margin:24px 0;
min-width:0}
section p{max-width:52em;margin:8px 0}
.effect>.help{color:var(--muted);margin-top:0}
.first{font-size:17.5px}
.note{color:var(--muted);font-size:14px}
.summary ul{list-style:none;margin:8px 0 0;padding:0}
.summary li{display:grid;grid-template-columns:12.5em 1fr;gap:4px 16px;padding:10px 0;
border-top:1px solid var(--edge)}
.summary li:first-child{border-top:0}
.summary a{font-weight:600}
.summary .failed b{color:var(--warm)}
a{color:var(--link);text-decoration-thickness:1px;text-underline-offset:3px}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,340px),1fr));gap:20px;
margin:20px 0 8px}
.plots figure,.thumbnails figure{margin:0;min-width:0}
.plots .plot{display:block;width:100%;height:auto;max-width:720px}
.plots.main figure:only-child .plot{max-width:700px}
@media (min-width:900px){.plots.main:has(figure:nth-child(2)){grid-template-columns:1.7fr 1fr}
.plots.main figure:first-child{grid-row:span 2}
.plots.main:not(:has(figure:nth-child(3))){grid-template-columns:1.25fr 1fr}}
.plots.small{grid-template-columns:repeat(auto-fit,minmax(min(100%,320px),1fr))}
figcaption{font-size:13.5px;color:var(--muted);margin-top:4px}
.thumbnails{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(45%,170px),1fr));gap:12px;
margin:20px 0 4px}
.thumbnails img{display:block;width:100%;height:auto;border-radius:6px;background:#000}
.scroll{overflow-x:auto;margin:12px -24px;padding:0 24px}
table{border-collapse:collapse;font-size:14px;font-variant-numeric:tabular-nums;min-width:100%}
th,td{padding:7px 12px;text-align:right;vertical-align:top;border-top:1px solid var(--edge);white-space:nowrap}
thead th{border-top:0;color:var(--muted);font-weight:500;font-size:13px;vertical-align:bottom;
white-space:normal;min-width:6.2em}
th:first-child{text-align:left;padding-left:0;font-weight:400}
tbody th{min-width:15em;max-width:24em;white-space:normal}
tbody th .help{display:block;font-size:13px;color:var(--muted);line-height:1.35}
td small{color:var(--muted)}
th small{color:var(--muted);margin-left:.3em}
tr.classic b{color:var(--warm)}
tr.dominated td{color:var(--muted)}
abbr{text-decoration:underline dotted;text-underline-offset:3px}
details{border-top:1px solid var(--edge);margin-top:16px;padding-top:12px}
summary{cursor:pointer;font-weight:600;color:var(--link)}
.truths{font-size:14px;color:var(--muted);margin:4px 0;padding-left:1.2em}
.truths b{color:var(--text);font-weight:600}
dl{margin:8px 0;font-size:15px}
dt{font-weight:600}
dd{margin:0 0 8px;color:var(--muted);overflow-wrap:anywhere}
.made{display:grid;grid-template-columns:10em 1fr;gap:6px 16px}
.made dd{margin:0}
.reading li{margin:6px 0;max-width:52em}
@media (max-width:640px){header,main{padding:0 12px}header{padding-top:24px}section{padding:16px;
border-radius:10px}
.scroll{margin:12px -16px;padding:0 16px}.summary li,.made{grid-template-columns:1fr;gap:2px}
.made dd{margin-bottom:8px}
body{font-size:15.5px}tbody th{min-width:10em}
.plot text,.plot .tick,.plot .axis-label{font-size:14px}.plot .label{font-size:14.5px}.plot .floor-label{font-size:12.5px}}
)";
}

} // namespace postfx::host::study
