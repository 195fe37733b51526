#include "mesh/report/change_page.h"

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/quality/limits.h"
#include "mesh/report/histogram_svg.h"
#include "mesh/report/html.h"
#include "mesh/report/id_list.h"

namespace prismesh::mesh::report {

namespace {

constexpr std::size_t kIdCharacters = 1500;  ///< of a list of ids
constexpr std::size_t kPartsListed = 200;
constexpr std::size_t kEditsListed = 500;
constexpr std::size_t kEditCharacters = 2000;
constexpr const char* kUnknown = "not known";

std::string number(double value, int digits = 6) { return std::isfinite(value) ? readable(value, digits) : kUnknown; }
std::string number(const std::optional<double>& value, int digits = 6) { return value ? number(*value, digits) : kUnknown; }
std::string place(const Vec3& at) { return readable({at.x(), at.y(), at.z()}, 7); }

std::string signed_number(double value) { return (value > 0 ? "+" : "") + number(value, 4); }
std::string change(double before, double after) { return before == after ? "none" : signed_number(after - before); }
std::string change(const std::optional<double>& before, const std::optional<double>& after) {
  if (!before || !after) return "";
  std::string words = change(*before, *after);
  if (*before != *after && *before != 0)
    words += std::string(" (") + (*after > *before ? "+" : "") + number((*after - *before) / *before * 100, 2) + "\u00a0%)";
  return words;
}

std::string cell(const std::string& text, bool is_number = true) {
  return std::string(is_number ? "<td class=\"n\">" : "<td>") + html_text(text) + "</td>";
}

std::string row(const std::string& what, const std::string& before, const std::string& after, const std::string& changed) {
  return "<tr><th scope=\"row\">" + html_text(what) + "</th>" + cell(before) + cell(after) + cell(changed) + "</tr>\n";
}
std::string row(const std::string& what, std::size_t before, std::size_t after) {
  return row(what, std::to_string(before), std::to_string(after), change(static_cast<double>(before), static_cast<double>(after)));
}

/// A list of ids, cut at a comma where it is long.
std::string ids(const std::vector<std::int64_t>& all) {
  std::string list = id_list(all);
  if (list.size() > kIdCharacters) {
    list.resize(list.rfind(',', kIdCharacters));
    list += ", … (cut; prismesh diff --json has all)";
  }
  return "<span class=\"ids\">" + html_text(list) + "</span>";
}

std::string tile(const std::string& what, const std::string& figure, const std::string& more) {
  return "<div class=\"tile\"><span class=\"soft\">" + html_text(what) + "</span><b>" + html_text(figure) + "</b><span class=\"soft\">" +
         html_text(more) + "</span></div>\n";
}

std::string tiles(const ChangeReport& report) {
  const Difference& d = report.difference;
  const auto counts = [](const ReportedState& state) { return state.check.report.counts; };
  std::string out = "<div class=\"tiles\">\n";
  if (report.moved.empty())
    out += tile("Largest displacement", d.displacement ? "0 " + report.length_unit : kUnknown,
                d.displacement ? "no node moved" : "the decks have no node in common");
  else
    out += tile("Largest displacement", number(d.max_displacement, 4) + " " + report.length_unit,
                "node " + std::to_string(report.moved.front().id) + " at " + place(report.moved.front().before));
  out += tile("Nodes moved", std::to_string(d.nodes_moved),
              std::to_string(d.nodes_added) + " added, " + std::to_string(d.nodes_removed) + " removed");
  out += tile("Elements", std::to_string(d.elements_added) + " added",
              std::to_string(d.elements_removed) + " removed, " + std::to_string(d.elements_changed) + " with other corners");
  out += tile("Shells that fail", std::to_string(counts(report.before).fail) + " → " + std::to_string(counts(report.after).fail),
              std::to_string(report.newly_failed) + " new");
  out += tile("Mass", number(report.after.check.report.mass), change(report.before.check.report.mass, report.after.check.report.mass));
  return out + "</div>\n";
}

std::string picture(const PagePicture& picture) {
  if (picture.png.empty()) return "<figure><figcaption>" + html_text(picture.caption) + "</figcaption></figure>\n";
  return "<figure><img alt=\"" + html_text(picture.caption) + "\" src=\"" + png_address(picture.png) + "\"><figcaption>" +
         html_text(picture.caption) + "</figcaption></figure>\n";
}

std::string pictures_section(const ChangePictures& pictures) {
  std::string out = "<h2>Pictures</h2>\n<div class=\"pair\">\n" + picture(pictures.before) + picture(pictures.after) + "</div>\n";
  for (const PagePicture& each : pictures.differences) out += picture(each);
  return out;
}

/// What only shells have; nothing without any.
std::optional<double> of_shells(const quality::Report& report, double value) {
  return report.elements > 0 ? std::optional(value) : std::nullopt;
}

std::string figures_section(const ChangeReport& report) {
  const quality::Report &a = report.before.check.report, &b = report.after.check.report;
  std::string out =
      "<h2>Figures</h2>\n<div class=\"scroll\"><table id=\"figures\"><thead><tr><td></td><th class=\"n\">before</th>"
      "<th class=\"n\">after</th><th class=\"n\">change</th></tr></thead><tbody>\n";
  out += row("nodes", report.before.nodes, report.after.nodes);
  out += row("shells", a.elements, b.elements);
  out += row("shells that are ok", a.counts.ok, b.counts.ok);
  out += row("shells that warn", a.counts.warn, b.counts.warn);
  out += row("shells that fail", a.counts.fail, b.counts.fail);
  const auto shown = [&](const char* what, double before, double after) {
    const std::optional<double> had = of_shells(a, before), has = of_shells(b, after);
    return row(what, number(had, 4), number(has, 4), had && has ? change(*had, *has) : "");
  };
  out += shown("triangles, %", a.triangles_percent, b.triangles_percent);
  out += shown("composite, least", a.min_composite, b.min_composite);
  out += shown("composite, mean", a.mean_composite, b.mean_composite);
  out += row("mass", number(a.mass), number(b.mass), change(a.mass, b.mass));
  const auto centre = [](const quality::Report& of) { return of.centre_of_gravity ? place(*of.centre_of_gravity) : std::string(kUnknown); };
  const bool centres = a.centre_of_gravity && b.centre_of_gravity;
  out += row("centre of gravity", centre(a), centre(b),
             centres ? "by " + number((*b.centre_of_gravity - *a.centre_of_gravity).norm(), 4) : "");
  const auto step = [](const quality::Report& of) { return of.time_step ? std::optional(of.time_step->seconds) : std::nullopt; };
  out += row("least time step", number(step(a)), number(step(b)), change(step(a), step(b)));
  out += row("mass added by mass scaling", number(a.added_mass), number(b.added_mass), change(a.added_mass, b.added_mass));
  out += row("lines of the decks", "", "", std::to_string(report.difference.lines_changed) + " differ");
  out += "</tbody></table></div>\n<p class=\"soft\">Lengths are in " + html_text(report.length_unit) +
         ", masses and time steps in the deck's units. Criteria: " + html_text(report.criteria) +
         (report.judged_alike ? ", with the target sizes of the first deck for both."
                              : "; the decks have other parts or settings, so each is judged by its own target sizes.") +
         "</p>\n";
  for (const auto& [words, state] : {std::pair("before", &report.before), std::pair("after", &report.after)})
    for (const std::string& sentence : state->check.unknown)
      out += "<p class=\"soft\">Not known, " + std::string(words) + ": " + html_text(sentence) + "</p>\n";
  return out;
}

std::string node_list(const char* what, std::size_t count, const std::vector<std::int64_t>& listed) {
  if (count == 0) return "";
  return "<p>" + html_text(what) + ", " + std::to_string(count) + ": " + ids(listed) + "</p>\n";
}

std::string displacement_section(const ChangeReport& report) {
  const Difference& d = report.difference;
  std::string out = "<h2>Displacement</h2>\n";
  if (!d.displacement) return out + "<p>The two decks have no node in common, so displacements aren't known.</p>\n";
  if (report.moved.empty()) return out + "<p>No node of both decks has moved.</p>\n";
  out += "<p>" + html_text(counted(d.nodes_moved, "node")) + " moved. The mean over all " + std::to_string(d.displacement->measured) +
         " nodes of both decks is " + number(d.displacement->mean, 4) + " " + html_text(report.length_unit) + ".";
  if (d.surface_distance && d.surface_distance->max > 0)
    out += " Shells lie up to " + number(d.surface_distance->max, 4) + " " + html_text(report.length_unit) +
           " from the surface before, at " + html_text(d.surface_distance->max_at) + ".";
  out +=
      "</p>\n<div class=\"scroll\"><table id=\"moves\"><thead><tr><th class=\"n\">node</th><th class=\"n\">displacement</th>"
      "<th class=\"n\">x y z before</th><th class=\"n\">x y z after</th></tr></thead><tbody>\n";
  for (const NodeMove& move : report.moved)
    out += "<tr>" + cell(std::to_string(move.id)) + cell(number(move.distance, 5)) + cell(place(move.before)) + cell(place(move.after)) +
           "</tr>\n";
  out += "</tbody></table></div>\n";
  if (d.nodes_moved > report.moved.size())
    out += "<p class=\"soft\">The " + std::to_string(report.moved.size()) + " largest of " + std::to_string(d.nodes_moved) + ".</p>\n";
  return out;
}

std::optional<quality::Threshold> limits_of(const ChangeReport& report, const Histogram& histogram) {
  for (const MetricLimits& limits : report.limits)
    if (limits.metric == histogram.metric) return limits.threshold;
  return std::nullopt;
}

std::string quality_section(const ChangeReport& report) {
  std::string out =
      "<h2>Quality</h2>\n<p class=\"soft\"><span class=\"key\" style=\"background:#b9c1c9\"></span>before &nbsp; <span "
      "class=\"key\" style=\"border:2px solid #1668b0\"></span>after &nbsp; dashed: warns beyond &nbsp; red: fails beyond. "
      "The height grows with the square root of the count, so that few bad shells can be seen.</p>\n<div class=\"charts\">\n";
  for (const Histogram& histogram : report.histograms) {
    const auto& a = report.before.check.report.metrics[int(histogram.metric)];
    const auto& b = report.after.check.report.metrics[int(histogram.metric)];
    const std::string unit(unit_of(histogram.metric, report.length_unit));
    out += "<figure data-metric=\"" + html_text(name(histogram.metric)) + "\"><h3>" + html_text(name(histogram.metric)) +
           (unit.empty() ? "" : ", " + html_text(unit)) + "</h3>" + histogram_svg(histogram, limits_of(report, histogram), unit) +
           "<figcaption>warn " + std::to_string(a.warn) + " → " + std::to_string(b.warn) + ", fail " + std::to_string(a.fail) + " → " +
           std::to_string(b.fail) + "; mean " + number(of_shells(report.before.check.report, a.mean), 4) + " → " +
           number(of_shells(report.after.check.report, b.mean), 4) + "</figcaption></figure>\n";
  }
  out += "</div>\n";
  if (report.failed_count == 0) return out + "<p>No shell fails after the change.</p>\n";
  out += "<h2>Shells that fail after the change: " + std::to_string(report.failed_count) + ", of them new " +
         std::to_string(report.newly_failed) +
         "</h2>\n<div class=\"scroll\"><table id=\"failed\"><thead><tr><th "
         "class=\"n\">shell</th><th>by</th><th>before</th></tr></thead><tbody>\n";
  for (const FailedShell& shell : report.failed)
    out += "<tr>" + cell(std::to_string(shell.id)) + cell(shell.metrics, false) +
           (shell.failed_before ? "<td>failed too</td>" : "<td class=\"bad\">▲ new</td>") + "</tr>\n";
  out += "</tbody></table></div>\n";
  if (report.failed_count > report.failed.size())
    out += "<p class=\"soft\">" + std::to_string(report.failed.size()) + " of " + std::to_string(report.failed_count) + ".</p>\n";
  return out;
}

std::string parts_section(const ChangeReport& report) {
  if (report.parts.empty()) return "";
  std::string out =
      "<h2>Parts</h2>\n<div class=\"scroll\"><table id=\"parts\"><thead><tr><th class=\"n\">part</th><th>name</th><th "
      "class=\"n\">shells</th><th class=\"n\">warn</th><th class=\"n\">fail</th><th class=\"n\">mass</th></tr></thead><tbody>\n";
  const auto both = [](const std::string& before, const std::string& after) { return before == after ? after : before + " → " + after; };
  for (std::size_t i = 0; i < std::min(report.parts.size(), kPartsListed); ++i) {
    const PartChange& part = report.parts[i];
    const auto count = [&](std::size_t (*of)(const quality::Report&)) {
      const auto words = [&](const std::optional<quality::Report>& side) { return side ? std::to_string(of(*side)) : std::string("–"); };
      return cell(both(words(part.before), words(part.after)));
    };
    const auto mass = [](const std::optional<quality::Report>& side) { return side ? number(side->mass) : std::string("–"); };
    out += "<tr>" + cell(std::to_string(part.id)) + cell(part.name, false) + count([](const quality::Report& r) { return r.elements; }) +
           count([](const quality::Report& r) { return r.counts.warn; }) + count([](const quality::Report& r) { return r.counts.fail; }) +
           cell(both(mass(part.before), mass(part.after))) + "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (report.parts.size() > kPartsListed)
    out += "<p class=\"soft\">The first " + std::to_string(kPartsListed) + " of " + std::to_string(report.parts.size()) + " parts.</p>\n";
  return out;
}

std::string changes_section(const ChangeReport& report) {
  const Difference& d = report.difference;
  std::string lists = node_list("Nodes moved", d.nodes_moved, d.moved) + node_list("Nodes added", d.nodes_added, d.added) +
                      node_list("Nodes removed", d.nodes_removed, d.removed) +
                      node_list("Shells added", d.shells_added.size(), d.shells_added) +
                      node_list("Shells removed", d.shells_removed.size(), d.shells_removed) +
                      node_list("Shells with other corners", d.shells_changed.size(), d.shells_changed);
  const std::size_t others = d.elements_added + d.elements_removed - d.shells_added.size() - d.shells_removed.size();
  if (others > 0) lists += "<p>Other elements added or removed: " + std::to_string(others) + "</p>\n";
  if (lists.empty()) lists = "<p>No node or element differs.</p>\n";
  return "<h2>Nodes and elements that differ</h2>\n" + lists;
}

std::string edits_section(const ChangeReport& report) {
  std::string out = "<h2>Edits</h2>\n";
  if (!report.edits)
    return out +
           "<p>Not known. Two decks show what differs, not how it was done; --journal names the journal or the script of the edits.</p>\n";
  const KnownEdits& known = *report.edits;
  out += "<p class=\"soft\">As " + html_text(known.file) + " says. Whether they lead from the first deck to the second wasn't checked" +
         (known.other_deck ? "; the journal was made on another deck than the first" : "") + ".</p>\n<ol>\n";
  for (std::size_t i = 0; i < std::min(known.edits.size(), kEditsListed); ++i) {
    std::string edit = known.edits[i];
    if (edit.size() > kEditCharacters) edit = edit.substr(0, kEditCharacters) + " …";
    out += "<li><code>" + html_text(edit) + "</code></li>\n";
  }
  out += "</ol>\n";
  if (known.edits.size() > kEditsListed)
    out += "<p class=\"soft\">The first " + std::to_string(kEditsListed) + " of " + std::to_string(known.edits.size()) + ".</p>\n";
  if (!known.broken.empty()) out += "<p class=\"bad\">What follows isn't known: " + html_text(known.broken) + "</p>\n";
  return out;
}

}  // namespace

std::string change_page(const ChangeReport& report, const ChangePictures& pictures) {
  const std::string title = report.before.name + " → " + report.after.name;
  std::string out = html_head(title, false);
  out += "<h1>" + html_text(report.before.name) + " → " + html_text(report.after.name) +
         "</h1>\n<p class=\"soft\">What changed between two decks, " + html_text(report.before.format) +
         (report.before.format == report.after.format ? "" : " and " + html_text(report.after.format)) + ".</p>\n";
  out += tiles(report) + pictures_section(pictures) + figures_section(report) + displacement_section(report) + quality_section(report) +
         parts_section(report) + changes_section(report) + edits_section(report);
  out += "<footer>Made by prismesh " PRISMESH_VERSION ". Content of the decks: before <code>" + html_text(report.before.hash) +
         "</code>, after <code>" + html_text(report.after.hash) + "</code>.</footer>\n</body>\n</html>\n";
  return out;
}

}  // namespace prismesh::mesh::report
