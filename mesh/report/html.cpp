#include "mesh/report/html.h"

#include "base/base64.h"
#include "mesh/report/printable.h"

namespace prismesh::mesh::report {

namespace {

/// Black on white, since reports are printed; status words carry a shape besides their colour.
constexpr const char* kStyle = R"(
:root { --ink: #1c2126; --soft: #5a6570; --line: #d5dae0; --ground: #f4f6f8; --before: #8b97a3; --after: #1668b0; --bad: #b3261e; --warn: #8a6100; --good: #20703c }
* { box-sizing: border-box }
html { color-scheme: light }
body { margin: 0 auto; padding: 28px 32px 48px; max-width: 1180px; background: #fff; color: var(--ink); font: 14px/1.5 system-ui, "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums }
h1 { margin: 0 0 4px; font-size: 24px; line-height: 1.25; overflow-wrap: anywhere }
h2 { margin: 34px 0 10px; padding-bottom: 4px; border-bottom: 1px solid var(--line); font-size: 17px }
p { margin: 6px 0; max-width: 90ch }
.soft, figcaption, footer { color: var(--soft) }
code, .ids { font: 12px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere }
table { border-collapse: collapse; max-width: 100% }
th, td { padding: 4px 12px 4px 0; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top }
th { color: var(--soft); font-weight: 600 }
td.n, th.n { text-align: right; white-space: nowrap }
.scroll { overflow-x: auto }
figure { margin: 0 }
figure img { display: block; width: 100%; height: auto; border-radius: 4px; background: #6f7073 }
figcaption { margin-top: 4px; font-size: 13px }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 16px; margin-bottom: 16px }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(170px, 1fr)); gap: 12px; margin: 18px 0 }
.tile { padding: 10px 14px; border-radius: 6px; background: var(--ground) }
.tile b { display: block; font-size: 20px; line-height: 1.3 }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(330px, 1fr)); gap: 18px 22px }
.charts figure { break-inside: avoid }
.charts h3 { margin: 0; font-size: 14px }
svg { display: block; width: 100%; height: auto }
svg text { font: 11px system-ui, "DejaVu Sans", sans-serif; fill: var(--soft) }
.bad { color: var(--bad); font-weight: 600 }
.warn { color: var(--warn); font-weight: 600 }
.good { color: var(--good) }
.key { display: inline-block; width: 11px; height: 11px; margin-right: 5px; border-radius: 2px; vertical-align: -1px }
footer { margin-top: 40px; padding-top: 8px; border-top: 1px solid var(--line); font-size: 12px }
@media (max-width: 700px) { body { padding: 16px } .pair { grid-template-columns: 1fr } }
@media print {
  @page { margin: 14mm }
  body { max-width: none; padding: 0; font-size: 10.5pt; -webkit-print-color-adjust: exact; print-color-adjust: exact }
  h2 { break-after: avoid }
  figure, tr { break-inside: avoid }
  .charts { grid-template-columns: 1fr 1fr }
}
)";

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string png_address(std::string_view png) { return "data:image/png;base64," + base64_encode(std::as_bytes(std::span(png))); }

std::string html_head(std::string_view title, bool scripts) {
  return std::string("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n") +
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'" +
         (scripts ? "; script-src 'unsafe-inline'" : "") +
         "; base-uri 'none'; form-action 'none'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         html_text(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
}

}  // namespace prismesh::mesh::report
