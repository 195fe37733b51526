// The commands: the options of each and the function that does it. cli/arguments.cpp parses arguments into these structs.
//
// To add a command: declare its options and function here, write it in a file of its own, and register it in
// cli/arguments.cpp (the only file with the argument parser).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/units.h"
#include "cli/context.h"
#include "mesh/document/judging_rules.h"
#include "mesh/measure/cross_section.h"

namespace prismesh::cli {

/// Options that every command takes.
struct Common {
  std::optional<LengthUnit> length_unit;
  std::vector<mesh::document::JudgingRule> rules;  ///< --target-size and --criteria, in order
  bool json = false;
};

struct InfoOptions {
  std::filesystem::path deck;
  bool save_settings = false;  ///< keeps target sizes and criteria beside the deck
  bool sandboxed = false;      ///< the deck is read by prismesh-import, locked in
};
int info(const InfoOptions& options, const Common& common, const Context& context);

struct CheckOptions {
  std::filesystem::path deck;
  std::optional<std::string> select;  ///< an expression: check only the shells it names
  bool chordal = false;               ///< also the distance of edges from the smooth surface
  bool save_settings = false;         ///< keeps target sizes and criteria beside the deck
};
int check(const CheckOptions& options, const Common& common, const Context& context);

struct EditOptions {
  std::filesystem::path deck;
  std::vector<std::string> edits;               ///< JSON, done first
  std::optional<std::filesystem::path> script;  ///< JSON Lines, done after them
  std::filesystem::path output;
  std::optional<std::filesystem::path> journal;
  bool keep_on_cancel = false;  ///< every repair keeps what it has reached
};
int edit(const EditOptions& options, const Common& common, const Context& context);

struct ReplayOptions {
  std::filesystem::path journal;
  std::filesystem::path deck;
  std::filesystem::path output;
};
int replay(const ReplayOptions& options, const Common& common, const Context& context);

struct DiffOptions {
  std::filesystem::path a;
  std::filesystem::path b;
};
int diff(const DiffOptions& options, const Common& common, const Context& context);

struct ReportOptions {
  std::filesystem::path a;
  std::filesystem::path b;
  std::filesystem::path output;
  std::optional<std::filesystem::path> journal;  ///< of the edits, or a script
  std::vector<std::string> done;                 ///< the edits in words, where no journal tells them
  std::string view = "iso";                      ///< of the pictures
};
int report(const ReportOptions& options, const Common& common, const Context& context);

struct DistanceOptions {
  std::filesystem::path deck;
  std::string from;  ///< expressions
  std::string to;
};
int distance(const DistanceOptions& options, const Common& common, const Context& context);

struct WeldsOptions {
  std::filesystem::path deck;
  double edge_distance = 0;  ///< of welds from free edges, at least; deck's length unit, as the pitch; 0: not checked
  double pitch = 0;
};
int welds(const WeldsOptions& options, const Common& common, const Context& context);

struct MeasureOptions {
  std::filesystem::path deck;
  std::int64_t a = 0, b = 0;  ///< ids of nodes
  std::optional<std::int64_t> c;
};
int measure_nodes(const MeasureOptions& options, const Common& common, const Context& context);

struct CrossSectionOptions {
  std::filesystem::path deck;
  mesh::measure::Plane plane;
  std::optional<std::string> parts;             ///< an expression: only these parts
  std::optional<std::filesystem::path> output;  ///< the curves as CSV
};
int cross_section(const CrossSectionOptions& options, const Common& common, const Context& context);

struct PenetrationsOptions {
  std::filesystem::path deck;
  std::optional<std::string> select;  ///< an expression
  double gap = 0;                     ///< deck's length unit
  std::optional<double> thickness;    ///< for all shells; nothing: as below
  bool by_contacts = true;            ///< what the deck's contacts say, else that of elements and sections
  bool tries_clear = false;           ///< what separate would remove is tried, however large the deck is
};
int penetrations(const PenetrationsOptions& options, const Common& common, const Context& context);

struct FlangesOptions {
  std::filesystem::path deck;
  std::optional<std::string> select;  ///< an expression
  double gap = 0;                     ///< deck's length unit, as the width
  std::optional<double> max_width;
};
int flanges(const FlangesOptions& options, const Common& common, const Context& context);

struct BatchOptions {
  std::filesystem::path plan;  ///< or a frozen study, which the workers get
  bool local = false, slurm = false;
  std::optional<std::size_t> jobs;     ///< workers at the same time
  std::optional<std::size_t> variant;  ///< a worker's, from 1
  std::optional<std::size_t> task;     ///< of Slurm's array
  std::size_t tasks = 1;
};
int batch(const BatchOptions& options, const Common& common, const Context& context);

struct SampleOptions {
  std::optional<std::size_t> elements;
  std::filesystem::path output;
};
int sample(const SampleOptions& options, const Common& common, const Context& context);

inline constexpr std::size_t kBenchShellsDefault = 100'000;
inline constexpr std::size_t kBenchPatchDefault = 2'500;
struct BenchOptions {
  std::optional<std::string> deck;      ///< a filter instead, where it is the only argument and no file has this name
  std::optional<std::string> filter;    ///< a regular expression: only figures in whose names it is found
  std::optional<std::size_t> elements;  ///< of the sample, without a deck
  std::optional<std::size_t> patch;     ///< about how many nodes the patch has that is lifted
};
int bench(const BenchOptions& options, const Common& common, const Context& context);

struct RenderOptions {
  std::filesystem::path deck;
  std::filesystem::path output;
  std::optional<std::string> select;             ///< an expression: these nodes are shown as selected
  std::optional<std::string> colour;             ///< a mode of the kiosk, or a field (mesh/document/field.h)
  std::optional<std::filesystem::path> against;  ///< the deck that a field compares with
  std::string from, to;                          ///< expressions, of the field "distance"
  std::optional<std::string> limits;             ///< CLEAR,FULL of the colour map
  /// Options with values that are passed on to the kiosk: --size, --profile, --eye, --mask, --view, --thickness, --map,
  /// --bands.
  std::vector<std::string> passed_on;
};
int render(const RenderOptions& options, const Common& common, const Context& context);

/// Talks to a running modeld.
struct SessionOptions {
  enum class Action : std::uint8_t { open, edit, save, state, undo, redo, close, report };
  Action action = Action::state;
  std::optional<std::filesystem::path> runtime_directory;
  std::filesystem::path deck;                   ///< open
  std::vector<std::string> edits;               ///< edit: JSON, done first
  std::optional<std::filesystem::path> script;  ///< edit: JSON Lines, done after them
  std::optional<std::filesystem::path> output;  ///< save: the main file to write; absent: in place. report: the page
  std::optional<std::filesystem::path> before;  ///< report: the deck to compare with; absent: the document's file
  std::string stored;                           ///< open: a model of the store, instead of `deck`
  bool sandboxed = false;                       ///< open
  bool discard = false;                         ///< open, close: gives unsaved edits up
  bool keep = false;                            ///< open, close: keeps unsaved edits for the next opening of their deck
  bool keep_on_cancel = false;                  ///< edit: every repair keeps what it has reached
};
int session(const SessionOptions& options, const Common& common, const Context& context);

/// Pairs this user's computer with a station.
struct PairOptions {
  std::string station;
  std::string code;
  std::optional<std::string> name;  ///< of this computer; absent: USER@HOST
};
int pair(const PairOptions& options, const Common& common, const Context& context);

struct PushOptions {
  std::filesystem::path deck;
  std::string station;  ///< empty: the only one
  std::string name;     ///< of the model; empty: that of the main file
};
int push(const PushOptions& options, const Common& common, const Context& context);

struct PullOptions {
  std::string model;
  std::string station;
  std::optional<std::filesystem::path> output;  ///< a folder
};
int pull(const PullOptions& options, const Common& common, const Context& context);

struct StationsOptions {
  enum class Action : std::uint8_t { list, forget, models };
  Action action = Action::list;
  std::string station;
};
int stations(const StationsOptions& options, const Common& common, const Context& context);

/// Prints what happens in a station's catalogue, until Ctrl-C.
struct WatchOptions {
  std::string station;
};
int watch(const WatchOptions& options, const Common& common, const Context& context);

/// Models in a store that speaks S3.
struct VaultOptions {
  enum class Action : std::uint8_t { push, list, fetch, verify };
  Action action = Action::list;
  std::string vault;                                 ///< its address; empty: that of the settings
  std::optional<std::filesystem::path> credentials;  ///< a file of settings
  bool plain_http = false;                           ///< also to another computer
  int patience_s = 60;
  std::filesystem::path deck;                   ///< push
  std::string name;                             ///< push: of the model; empty: that of the main file
  bool resend = false;                          ///< push: also what is there
  bool outside = false;                         ///< push: also files outside the deck's folder
  std::string model;                            ///< fetch; verify, empty: all
  std::optional<std::filesystem::path> output;  ///< fetch: a folder
};
int vault(const VaultOptions& options, const Common& common, const Context& context);

/// The station's side: talks to a running prismesh-intake on this machine.
struct IntakeOptions {
  enum class Action : std::uint8_t { code, tokens, revoke, describe };
  Action action = Action::tokens;
  std::optional<std::filesystem::path> runtime_directory;
  std::string name;  ///< code: the token's, if it is fixed here; revoke; describe: one model, by its name or the beginning of its hash
  std::vector<std::string> allow{"read", "upload"};  ///< code
};
int intake(const IntakeOptions& options, const Common& common, const Context& context);

/// Asks a running deviced.
struct DevicesOptions {
  std::optional<std::filesystem::path> runtime_directory;
  bool watch = false;                           ///< print again each second
  bool rearm = false;                           ///< first enable a mask again that was stuck or switched itself off
  bool reload = false;                          ///< first make the daemon read settings and profile again
  bool arm_pen = false;                         ///< first arm the haptic pen
  bool disarm_pen = false;                      ///< first disarm it
  bool self_test = false;                       ///< measure the pen's loop for some seconds
  std::optional<std::filesystem::path> record;  ///< where to write what the pen's loop does
  double seconds = 10;                          ///< for how long, besides what is known already
  std::optional<std::filesystem::path> replay;  ///< a record on which the pen's safety is run again
};
int devices(const DevicesOptions& options, const Common& common, const Context& context);

struct DoctorOptions {
  std::optional<std::filesystem::path> runtime_directory;
  std::optional<std::filesystem::path> state_directory;
};
int doctor(const DoctorOptions& options, const Common& common, const Context& context);

}  // namespace prismesh::cli
