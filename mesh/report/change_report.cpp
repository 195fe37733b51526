#include "mesh/report/change_report.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "mesh/document/edit_json.h"
#include "mesh/quality/limits.h"

namespace prismesh::mesh::report {

namespace {

using document::Document;

constexpr double kRoomAbout = 0.6;      ///< of the size of what differs, on each side of the picture
constexpr double kLeastOfModel = 0.06;  ///< a picture shows at least this share of the model's size

ReportedState state_of(const Document& document) {
  ReportedState state;
  state.name = document.path.filename().string();
  state.hash = document.deck->content.hex();
  state.format = std::string(name(document.deck->format));
  state.nodes = document.current().model.node_index->size();
  state.check = check_figures(document, nullptr, false);
  return state;
}

std::vector<NodeMove> largest_moves(const Model& a, const Model& b, const std::vector<std::int64_t>& moved) {
  std::vector<NodeMove> moves;
  moves.reserve(moved.size());
  for (const std::int64_t id : moved) {
    NodeMove move{id, a.position(a.find_node(id)), b.position(b.find_node(id)), 0};
    move.distance = (move.after - move.before).norm();
    if (move.before.allFinite() && move.after.allFinite()) moves.push_back(move);
  }
  const std::size_t listed = std::min(moves.size(), kMovesListed);
  std::partial_sort(moves.begin(), moves.begin() + static_cast<std::ptrdiff_t>(listed), moves.end(),
                    [](const NodeMove& one, const NodeMove& other) {
                      return one.distance != other.distance ? one.distance > other.distance : one.id < other.id;
                    });
  moves.resize(listed);
  return moves;
}

std::vector<PartChange> part_changes(const Document& before, const CheckFigures& a, const Document& after, const CheckFigures& b) {
  std::map<std::int64_t, PartChange> found;
  const auto add = [&](const Document& document, const CheckFigures& figures, std::optional<quality::Report> PartChange::*side) {
    for (const quality::PartReport& each : figures.parts) {
      const Part& part = (*document.current().model.parts)[each.part.value];
      PartChange& change = found[part.id];
      change.id = part.id;
      change.name = part.name;
      change.*side = each.report;
    }
  };
  add(before, a, &PartChange::before);
  add(after, b, &PartChange::after);
  std::vector<PartChange> parts;
  for (auto& [id, change] : found) parts.push_back(std::move(change));
  return parts;
}

std::string failing(const quality::ShellState& state) {
  std::string names;
  const auto add = [&](std::string_view name) { names += (names.empty() ? "" : ", ") + std::string(name); };
  for (const quality::Defect defect : quality::kDefects)
    if (state.has(defect)) add(name(defect));
  for (int metric = 0; metric < quality::kMetricCount; ++metric)
    if ((state.fail >> metric & 1) != 0) add(name(static_cast<quality::Metric>(metric)));
  return names;
}

void add_failed(const document::Generation& a, const document::Generation& b, ChangeReport& report) {
  std::vector<FailedShell> before_too;
  for (std::size_t shell = 0; shell < b.model.shell_count(); ++shell) {
    const quality::ShellState state = b.quality[shell];
    if (state.is_removed() || state.grade() != quality::Grade::fail) continue;
    const std::int64_t id = b.model.shell_ids[shell];
    const ShellIndex then = a.model.find_shell(id);
    const bool failed_before = then.valid() && a.quality[then.value].grade() == quality::Grade::fail;
    ++report.failed_count;
    report.newly_failed += !failed_before;
    auto& list = failed_before ? before_too : report.failed;
    if (list.size() < kFailedListed) list.push_back({id, failing(state), failed_before});
  }
  const auto by_id = [](const FailedShell& one, const FailedShell& other) { return one.id < other.id; };
  std::sort(report.failed.begin(), report.failed.end(), by_id);
  std::sort(before_too.begin(), before_too.end(), by_id);
  for (FailedShell& shell : before_too)
    if (report.failed.size() < kFailedListed) report.failed.push_back(std::move(shell));
}

using Box = PartFigures::Box;

void add_to(std::optional<Box>& box, const Vec3& point) {
  if (!point.allFinite()) return;
  if (!box) box = Box{point, point};
  box->min = box->min.cwiseMin(point);
  box->max = box->max.cwiseMax(point);
}

/// Where nodes and shells of the second state differ from those of the first.
std::vector<Vec3> changed_places(const Model& b, const Difference& difference) {
  std::vector<Vec3> places;
  for (const std::vector<std::int64_t>* nodes : {&difference.moved, &difference.added})
    for (const std::int64_t id : *nodes) places.push_back(b.position(b.find_node(id)));
  for (const std::vector<std::int64_t>* shells : {&difference.shells_added, &difference.shells_changed})
    for (const std::int64_t id : *shells)
      for (const NodeIndex node : b.shell(b.find_shell(id)).node) places.push_back(b.position(node));
  return places;
}

std::string criteria_words(const Document& document) {
  const document::Judging& judging = *document.current().judging;
  std::string words = judging.criteria.criteria->name;
  for (const document::PartChoice& choice : judging.parts)
    if (choice.criteria) return words + ", others by part";
  return words;
}

/// Of metrics that quads and triangles have alike; where parts have their own sizes or criteria, only of metrics without a length.
std::vector<MetricLimits> common_limits(const Document& document) {
  const quality::SizedCriteria criteria = judged_by(document);
  const document::Judging& judging = *document.current().judging;
  const std::vector<quality::PartCriteria>& distinct = judging.by_part.distinct;
  bool one_size = true, one_criteria = true;
  for (const quality::PartCriteria& each : distinct) {
    one_size = one_size && each.target_size == distinct.front().target_size;
    one_criteria = one_criteria && (!each.criteria || each.criteria == judging.criteria.criteria);
  }
  std::vector<MetricLimits> limits;
  if (!one_criteria) return limits;
  const quality::SizedCriteria whole{criteria.criteria, distinct.empty() ? criteria.target_size : distinct.front().target_size};
  for (int m = 0; m < quality::kMetricCount; ++m) {
    const auto metric = static_cast<quality::Metric>(m);
    const bool is_length = metric == quality::Metric::min_length || metric == quality::Metric::max_length;
    if (is_length && (!one_size || quality::limits_for(whole).needs_material)) continue;
    const quality::Threshold threshold = quality::threshold_of(whole, metric, is_of_triangles(metric));
    limits.push_back({metric, threshold});
  }
  return limits;
}

deck::OpenedDeck as_opened(const Document& document) { return {document.deck, document.current().model}; }

}  // namespace

std::optional<Box> picture_box(const Model& model, std::span<const Vec3> places) {
  std::optional<Box> box, whole;
  for (const Vec3& place : places) add_to(box, place);
  if (!box) return box;
  for (std::size_t shell = 0; shell < model.shell_count(); ++shell)
    if (!model.is_removed(ShellIndex(shell)))
      for (const NodeIndex node : model.shell_nodes[shell].node) add_to(whole, model.position(node));
  const double of_model = whole ? (whole->max - whole->min).norm() : 0;
  const double size = std::max((box->max - box->min).norm() * (1 + kRoomAbout), of_model * kLeastOfModel);
  if (!(size > 0)) return std::nullopt;  // a model of one point has no size to look at
  const Vec3 middle = (box->min + box->max) / 2;
  const Vec3 half = ((box->max - box->min) / 2).cwiseMax(Vec3::Constant(size / 4));
  return Box{middle - half, middle + half};
}

bool can_be_judged_alike(const deck::OpenedDeck& before, const deck::OpenedDeck& after) {
  const std::vector<Part>& a = *before.model.parts;
  const std::vector<Part>& b = *after.model.parts;
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Part& one, const Part& other) { return one.id == other.id; });
}

ChangeReport change_report(const Document& before, const Document& after) {
  ChangeReport report;
  report.before = state_of(before);
  report.after = state_of(after);
  report.length_unit = std::string(name(before.settings.length_unit));
  report.criteria = criteria_words(before);
  report.judged_alike = before.current().judging == after.current().judging;
  const Model& a = before.current().model;
  const Model& b = after.current().model;
  report.difference = compare(as_opened(before), as_opened(after));
  report.moved = largest_moves(a, b, report.difference.moved);
  report.histograms = histograms(before.current(), after.current());
  report.limits = common_limits(before);
  report.parts = part_changes(before, report.before.check, after, report.after.check);
  add_failed(before.current(), after.current(), report);
  report.changed = picture_box(b, changed_places(b, report.difference));
  return report;
}

Result<KnownEdits> known_edits(const std::filesystem::path& journal, const Document& deck) {
  const Result<document::JournalIntents> intents = document::read_intents(journal);
  if (!intents) return fail(intents.error());
  KnownEdits known;
  known.file = journal.filename().string();
  for (const document::Edit& edit : intents->edits) known.edits.push_back(document::edit_to_json(edit).dump());
  known.other_deck = !intents->deck_hash.empty() && intents->deck_hash != deck.deck->content.hex();
  if (intents->damage) known.broken = intents->damage->text();
  if (intents->torn_tail && known.broken.empty()) known.broken = "the last record is incomplete";
  return known;
}

}  // namespace prismesh::mesh::report
