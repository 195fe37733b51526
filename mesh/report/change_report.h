// What a report on two states of a deck tells: figures, histograms and lists, with no word on how they look.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/journal.h"
#include "mesh/report/check_figures.h"
#include "mesh/report/comparison.h"
#include "mesh/report/histogram.h"

namespace prismesh::mesh::report {

/// One of the two states.
struct ReportedState {
  std::string name;  ///< of the deck's main file
  std::string hash;  ///< of its content
  std::string format;
  std::size_t nodes = 0;
  CheckFigures check;
};

/// A node in both states.
struct NodeMove {
  std::int64_t id = 0;
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();  ///< deck's length unit
  double distance = 0;
};

/// A part, by its id in either state.
struct PartChange {
  std::int64_t id = 0;
  std::string name;
  std::optional<quality::Report> before, after;  ///< absent: no shells of the part, or no such part
};

/// A shell that fails in the second state.
struct FailedShell {
  std::int64_t id = 0;
  std::string metrics;         ///< "warpage, skew", or a defect
  bool failed_before = false;  ///< it failed in the first state too
};

/// What was done, as far as it is known.
struct KnownEdits {
  std::string file;                ///< the journal or script
  std::vector<std::string> edits;  ///< as JSON, in order
  bool other_deck = false;         ///< a journal of another deck than the first state
  std::string broken;              ///< why nothing behind these could be read; empty: all were
};

/// The limits of a metric, where all shells have the same.
struct MetricLimits {
  quality::Metric metric = quality::Metric::warpage;
  quality::Threshold threshold;  ///< in the metric's unit
};

struct ChangeReport {
  ReportedState before, after;
  std::string length_unit;
  std::string criteria;      ///< by which both are judged, in words
  bool judged_alike = true;  ///< the second by the target sizes of the first; else each by its own
  Difference difference;
  std::vector<NodeMove> moved;  ///< the largest moves first; at most kMovesListed
  std::vector<Histogram> histograms;
  std::vector<MetricLimits> limits;  ///< of the histograms
  std::vector<PartChange> parts;     ///< ascending by id
  std::vector<FailedShell> failed;   ///< those that are new first, then by id; at most kFailedListed
  std::size_t failed_count = 0;
  std::size_t newly_failed = 0;
  std::optional<KnownEdits> edits;  ///< absent: nobody said what was done
  /// A box about what differs, with the room that a picture of it wants; absent: no node or shell of the second state differs.
  std::optional<PartFigures::Box> changed;
};
inline constexpr std::size_t kMovesListed = 20;
inline constexpr std::size_t kFailedListed = 50;

/// A box about some places, with room about them, that shows at least a part of the model large enough to be recognised; absent without
/// places.
std::optional<PartFigures::Box> picture_box(const Model& model, std::span<const Vec3> places);

/// Whether the parts of both decks are the same, so that the second can be judged by the target sizes that were found for the first.
bool can_be_judged_alike(const deck::OpenedDeck& before, const deck::OpenedDeck& after);

/// The report on the current states of two documents.
ChangeReport change_report(const document::Document& before, const document::Document& after);

/// What a journal or a script (JSON Lines) says was done to `deck`. Errors: those of read_intents.
Result<KnownEdits> known_edits(const std::filesystem::path& journal, const document::Document& deck);

}  // namespace prismesh::mesh::report
