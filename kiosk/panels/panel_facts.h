// What the panels show, as plain data, and what they give back. Knows neither the model server nor the renderer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kiosk/panels/legend_facts.h"
#include "kiosk/panels/quality_facts.h"
#include "kiosk/tools/command.h"
#include "kiosk/tools/deck_warnings.h"
#include "kiosk/tools/question.h"
#include "kiosk/tools/shaping_options.h"
#include "mesh/document/edit.h"
#include "mesh/quality/report.h"

namespace prismesh::kiosk::panels {

struct PartRow {
  std::int64_t id = 0;
  std::string name;
  std::uint64_t shells = 0;
  unsigned colour = 0;  ///< 0xAABBGGRR, as the picture shows it
  bool hidden = false;
  bool locked = false;
};

/// A file of the deck that holds shells.
struct FileRow {
  std::string name;
  std::uint64_t shells = 0;
  std::size_t parts = 0;
  bool hidden = false, locked = false;  ///< all of its parts are
};

struct DocumentFacts {
  std::string path;
  std::uint64_t nodes = 0, shells = 0;
  std::uint64_t generation = 0;
  std::string length_unit;
  bool length_unit_guessed = false;
  double target_size = 0;
  bool target_size_guessed = false;
  bool changed = false;
  std::uint64_t selected_nodes = 0;
  std::uint64_t selected_shells = 0;
  mesh::quality::Counts counts;
  std::vector<PartRow> parts;
  std::vector<FileRow> files;
};

struct Notice {
  enum class Kind : std::uint8_t { information, warning, error };
  Kind kind = Kind::information;
  std::string text;
  std::uint64_t document = 0;   ///< ModelLink::document_number of the one it speaks of; 0: of none
  bool lists_warnings = false;  ///< there are more of its kind in the list of the deck's warnings
};

/// What is being dragged, while it is.
struct PullFacts {
  std::string what;               ///< "Lift", "Slide", "Move", "Turn"
  double length = 0;              ///< deck's length unit
  std::optional<double> degrees;  ///< instead of a length
  std::uint64_t nodes = 0;
  std::optional<mesh::quality::Counts> counts;  ///< of the whole document as it would become
};

/// How the picture follows the eyes, in words.
struct EyesFacts {
  enum class State : std::uint8_t { good, waiting, trouble };
  State state = State::waiting;
  std::string eyes = "waiting";  ///< a few words
  std::string mask;              ///< a few words; empty: the display has no mask that moves
  std::string advice;            ///< a sentence: what to do; empty: nothing
  bool in_depth = false;
  bool simulated = false;
  bool operator==(const EyesFacts&) const = default;
};

/// How much depth the picture has. Only for pictures in stereo.
struct DepthFacts {
  int strength_percent = 100;
  double comfort_degrees = 1;
  bool selection_in_plane = false;  ///< the selection is kept in the plane of the screen
};

/// How outlines and regions select.
struct SelectFacts {
  bool lasso = true;
  bool through = false;
  mesh::document::RegionBy by = mesh::document::RegionBy::features;
  double angle = 30;
  bool across_welds = false;
};

struct ExpressionFacts {
  struct Count {
    std::uint64_t nodes = 0, shells = 0, parts = 0;
  };
  const std::vector<std::string>* entered = nullptr;  ///< before, oldest first
  std::string counted_for;                            ///< what count or problem are of
  std::optional<Count> count;
  std::string problem;
  long column = 0;  ///< where the problem is, from 1; 0: nowhere
};

/// A number that is typed for something.
struct NumberFacts {
  std::string title, hint;
  std::string begun;    ///< what the field begins with
  std::string problem;  ///< a sentence; empty: none
};

enum class Dialog : std::uint8_t { none, open, save_as, save_copy, expression, number };

struct PanelData {
  bool connected = false;
  std::string socket;
  std::optional<DocumentFacts> document;
  std::optional<PullFacts> pull;
  SelectFacts selecting;
  tools::ShapingOptions shaping;
  bool shaping_open = false;
  std::optional<CompareFacts> compare;
  std::optional<QualityFacts> quality;            ///< while its panel is open
  tools::Under tool = tools::Under::lift_handle;  ///< what a typed number would do
  std::string guidance;                           ///< what to do next, or which state is shown; empty: nothing
  std::uint64_t history_bytes = 0, history_cap = 0;
  bool shadows = false;
  bool colour_by_quality = false;
  bool colour_by_state = false;
  std::string profile;
  std::optional<EyesFacts> eyes;
  std::optional<DepthFacts> depth;
  std::string signs;  ///< which signs of quality are left out on purpose; empty: none
  std::uint64_t glyphs_left_out = 0;
  std::optional<Notice> notice;
  std::size_t more_notices = 0;
  std::string busy;  ///< what the model server is at; empty: nothing
  double busy_fraction = 0;
  bool help = false, menu = false;
  const std::vector<tools::ToldWarning>* warnings = nullptr;  ///< while their list is open
  const std::vector<tools::MouseBinding>* mouse = nullptr;
  std::optional<ExpressionFacts> expression;
  std::optional<NumberFacts> number;
  Dialog dialog = Dialog::none;
  const tools::Question* question = nullptr;  ///< stands before everything else
};

/// `on` is an expression of parts: an id, or file:NAME.
struct AskParts {
  std::string on;
  mesh::document::VisibilityAction action = mesh::document::VisibilityAction::hide;
};
struct AskOpen {
  std::string path;
};
struct AskSave {
  std::string path;
  bool copy = false;
};
struct ExpressionTyped {
  std::string text;
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
};
struct ExpressionEntered {
  std::string text;
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
  mesh::document::SelectMode mode = mesh::document::SelectMode::set;
};
struct NumberEntered {
  std::string text;
};
struct SetShaping {
  tools::ShapingOptions options;
};
struct SetRegion {
  mesh::document::RegionBy by = mesh::document::RegionBy::features;
  double angle = 30;
  bool across_welds = false;
};
struct NoticeRead {};
struct DialogClosed {};
using PanelAction =
    std::variant<tools::Command, tools::Reply, AskParts, AskOpen, AskSave, ExpressionTyped, ExpressionEntered, NumberEntered, SetShaping,
                 SetRegion, ChooseMetric, BarClicked, ErrorClicked, SetCompare, SetLimits, NoticeRead, DialogClosed>;

/// What a field that is typed into remembers from one layout to the next.
struct EntryState {
  std::string text;
  std::string told;  ///< what was last said of it
  mesh::select::EntityKind kind = mesh::select::EntityKind::node;
  std::optional<std::size_t> recalled;  ///< which of the earlier entries stands in the field
  std::string own;                      ///< what stood there before
  bool caret_to_end = false;
};

}  // namespace prismesh::kiosk::panels
