// The page of a study's results.
#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/file.h"
#include "base/readable_number.h"
#include "mesh/batch/columns.h"
#include "mesh/batch/scatter.h"
#include "mesh/batch/tabulate.h"
#include "mesh/report/html.h"

namespace prismesh::mesh::batch {

namespace {

using report::html_text;

constexpr std::size_t kRowsShown = 20'000;

constexpr const char* kStyle = R"(<style>
body { max-width: none }
#variants th { white-space: nowrap; position: sticky; top: 0; background: #fff; vertical-align: bottom }
#variants td { vertical-align: middle }
#variants img { display: block; width: 160px; height: 100px; border-radius: 3px; background: #6f7073 }
#variants button { all: unset; cursor: pointer; color: inherit }
#variants button:hover, #variants button:focus-visible { text-decoration: underline; outline: revert }
#variants th[aria-sort=ascending] button::after { content: " ▲" }
#variants th[aria-sort=descending] button::after { content: " ▼" }
#variants .reason { min-width: 30ch; max-width: 60ch; overflow-wrap: anywhere }
</style>
)";

/// Sorts the rows by a column; numbers before texts, empty cells last.
constexpr const char* kScript = R"(<script>
"use strict";
const table = document.getElementById("variants"), body = table.tBodies[0];
for (const head of table.tHead.rows[0].cells) {
  const button = head.querySelector("button");
  if (button) button.addEventListener("click", () => {
    const down = head.getAttribute("aria-sort") === "ascending", at = head.cellIndex;
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = (row) => row.cells[at].dataset.v ?? row.cells[at].textContent.trim();
    const rows = [...body.rows].map((row) => [key(row), row]);
    const order = ([a], [b]) => {
      if (a === "" || b === "") return (a === "") - (b === "");
      const x = Number(a), y = Number(b), sign = down ? -1 : 1;
      return sign * (isNaN(x) || isNaN(y) ? a.localeCompare(b) : x - y);
    };
    body.append(...rows.sort(order).map(([, row]) => row));
  });
}
</script>
)";

/// What people look at first: what has no result, then what is worst.
std::vector<const Row*> in_order_of_need(const Table& table) {
  std::vector<const Row*> rows;
  for (const Row& row : table.rows) rows.push_back(&row);
  const auto trouble = [](const Row& row) {
    if (!row.result) return std::tuple<std::size_t, std::size_t>(0, 0);
    const Measured& after = row.result->after;
    return std::tuple(after.perforations.value_or(0) + after.penetrations.value_or(0), after.fail);
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const Row* one, const Row* other) {
    if (one->state != other->state) return one->state < other->state;
    return trouble(*one) > trouble(*other);
  });
  return rows;
}

/// A figure, and what it was where that is known and differs.
std::string cell(const std::optional<double>& figure, const std::optional<double>& before = std::nullopt) {
  if (!figure) return "<td></td>";
  const std::string now = readable(*figure, 5), then = before ? readable(*before, 5) : now;
  return "<td class=\"n\" data-v=\"" + html_text(words(*figure)) + "\">" + html_text(now) +
         (then == now ? "" : "<br><span class=\"soft\">was " + html_text(then) + "</span>") + "</td>";
}

std::string value_cell(const ParameterValue& value) {
  if (const double* number = std::get_if<double>(&value)) return cell(*number);
  return "<td>" + html_text(std::get<std::string>(value)) + "</td>";
}

std::string state_cell(RowState state) {
  switch (state) {
    case RowState::failed: return "<td data-v=\"0\" class=\"bad\">✖ failed</td>";
    case RowState::missing: return "<td data-v=\"1\" class=\"bad\">○ missing</td>";
    case RowState::refused: return "<td data-v=\"2\" class=\"warn\">▲ refused</td>";
    case RowState::done: break;
  }
  return "<td data-v=\"3\" class=\"good\">done</td>";
}

std::string picture_cell(const Row& row, const Store& store, std::size_t& shown) {
  if (!row.result || row.result->picture.empty()) return "<td></td>";
  const std::string relative = "variants/" + row.key + "/" + row.result->picture;
  if (shown < kPicturesShown)
    if (const Result<FileBytes> bytes = read_file(store.folder() / relative)) {
      ++shown;
      return "<td><img alt=\"variant " + std::to_string(row.number) + "\" src=\"" + report::png_address(bytes->text()) + "\"></td>";
    }
  return "<td><a href=\"" + html_text(relative) + "\">picture</a></td>";
}

/// Of an address within a page: only what a path needs.
std::string as_address(const std::string& path) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("/-_.~").find(c) != std::string_view::npos)
      out += c;
    else
      out += std::string("%") + kDigits[byte >> 4] + kDigits[byte & 15];
  }
  return out;
}

std::string head_cell(std::string_view words, bool is_number) {
  return std::string(is_number ? "<th class=\"n\">" : "<th>") + "<button type=\"button\">" + html_text(words) + "</button></th>";
}

/// Columns without any figure are left out.
std::vector<const Column*> told_columns(const Table& table) {
  std::vector<const Column*> told;
  for (const Column& column : columns())
    if (std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& row) { return figure_of(column, row).has_value(); }))
      told.push_back(&column);
  return told;
}

/// The variant's number leads to its deck.
std::string number_cell(const Row& row) {
  const std::string number = std::to_string(row.number), file = written_file(row);
  const std::string notes = !row.result || row.result->notes.empty() ? "" : " title=\"" + html_text(row.result->notes.front()) + "\"";
  return "<td class=\"n\" data-v=\"" + number + "\"" + notes + ">" +
         (file.empty() ? number : "<a href=\"" + as_address(file) + "\">" + number + "</a>") + "</td>";
}

/// What the columns of the page are; a column in which all rows are alike is left out.
struct PageColumns {
  bool reasons = false, decks = false, scripts = false;
  std::vector<const Column*> told;
};

PageColumns columns_of(const Table& table) {
  PageColumns wanted;
  wanted.told = told_columns(table);
  for (const Row& row : table.rows) {
    wanted.reasons = wanted.reasons || !row.reason.empty();
    wanted.decks = wanted.decks || row.deck != table.rows.front().deck;
    wanted.scripts = wanted.scripts || row.script != table.rows.front().script;
  }
  return wanted;
}

std::string head_of(const Table& table, const PageColumns& wanted) {
  std::string out = head_cell("variant", true) + head_cell("state", false) + "<th>picture</th>";
  if (wanted.reasons) out += head_cell("why", false);
  if (wanted.decks) out += head_cell("deck", false);
  if (wanted.scripts) out += head_cell("script", false);
  for (const std::string& parameter : table.parameters) out += head_cell(parameter, true);
  for (const Column* column : wanted.told)
    out += head_cell(std::string(column->words) + (column->is_length && !table.length_unit.empty() ? ", " + table.length_unit : ""), true);
  return "<tr>" + out + "</tr>";
}

std::string rows_of(const Table& table, const Store& store) {
  const PageColumns wanted = columns_of(table);
  std::string out = "<div class=\"scroll\"><table id=\"variants\"><thead>" + head_of(table, wanted) + "</thead><tbody>\n";
  std::size_t shown = 0, rows = 0;
  for (const Row* row : in_order_of_need(table)) {
    if (++rows > kRowsShown) break;
    out += "<tr>" + number_cell(*row) + state_cell(row->state) + picture_cell(*row, store, shown);
    if (wanted.reasons) out += "<td class=\"reason\">" + html_text(row->reason) + "</td>";
    if (wanted.decks) out += "<td>" + html_text(row->deck) + "</td>";
    if (wanted.scripts) out += "<td>" + html_text(row->script) + "</td>";
    for (const ParameterValue& value : row->values) out += value_cell(value);
    for (const Column* column : wanted.told) out += cell(figure_of(*column, *row), figure_before(*column, *row));
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (table.rows.size() > kRowsShown)
    out += "<p class=\"soft\">The first " + std::to_string(kRowsShown) + " of " + std::to_string(table.rows.size()) +
           "; results.csv has all.</p>\n";
  return out;
}

std::string tile(const char* what, std::size_t count, const std::string& more) {
  return "<div class=\"tile\"><span class=\"soft\">" + html_text(what) + "</span><b>" + std::to_string(count) +
         "</b><span class=\"soft\">" + html_text(more) + "</span></div>\n";
}

std::string tiles(const Table& table) {
  const std::size_t lacking = table.count(RowState::failed) + table.count(RowState::missing);
  std::size_t crossing = 0, worse = 0;
  for (const Row& row : table.rows) {
    if (row.state != RowState::done) continue;
    const Measured &before = row.result->before, &after = row.result->after;
    crossing +=
        after.perforations.value_or(0) + after.penetrations.value_or(0) > before.perforations.value_or(0) + before.penetrations.value_or(0);
    worse += after.fail > before.fail;
  }
  return "<div class=\"tiles\">\n" + tile("Variants", table.rows.size(), table.plan_file) +
         tile("Done", table.count(RowState::done), "a deck is written") +
         tile("Refused", table.count(RowState::refused), "an edit doesn't fit") +
         tile("Without a result", lacking, lacking > 0 ? "run the plan again" : "") +
         tile("More failing shells", worse, "than before the edits") + tile("More contacts", crossing, "perforations, penetrations") +
         "</div>\n";
}

}  // namespace

std::string table_page(const Table& table, const Store& store) {
  const auto with_picture =
      std::count_if(table.rows.begin(), table.rows.end(), [](const Row& row) { return row.result && !row.result->picture.empty(); });
  std::string out = report::html_head(table.name, true) + kStyle + "<h1>" + html_text(table.name) +
                    "</h1>\n<p class=\"soft\">A study by prismesh batch: " + html_text(counted(table.rows.size(), "variant")) + " of " +
                    html_text(table.plan_file) + ".</p>\n" + tiles(table);
  out += scatter_section(table);
  out +=
      "<h2>Variants</h2>\n<p class=\"soft\">What has no result comes first, then what was refused, then the most contacts and failing "
      "shells. A "
      "click on a head sorts. A number leads to the variant's deck beside this page, which <code>prismesh session open</code> and the "
      "kiosk open. "
      "Pictures are close to what moved, coloured by how far, each up to its own largest displacement. Masses and time steps are in the "
      "decks' "
      "units.</p>\n";
  out += rows_of(table, store);
  if (static_cast<std::size_t>(with_picture) > kPicturesShown)
    out += "<p class=\"soft\">Pictures of " + std::to_string(kPicturesShown) +
           " variants stand in the page; the others are files beside it.</p>\n";
  out += "<footer>Made by prismesh " PRISMESH_VERSION ". The same figures are in results.csv and results.json.</footer>\n";
  return out + kScript + "</body>\n</html>\n";
}

}  // namespace prismesh::mesh::batch
