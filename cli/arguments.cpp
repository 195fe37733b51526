// The only file with the argument parser, which is slow to compile.
#include "cli/arguments.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/nearest_name.h"
#include "cli/commands.h"
#include "mesh/deck/sample.h"
#include "mesh/document/judging_rules.h"
#include "mesh/quality/criteria.h"

namespace prismesh::cli {

namespace {

/// The parser and the values it fills. A command's options live as long as the action that uses them.
struct Parser {
  CLI::App app{"Prismesh: edit finite-element shell models for crash simulation.", "prismesh"};
  Common common;
  Action chosen;
};

/// A subcommand whose options are of type Options and that runs `command` with them.
template <class Options>
std::pair<CLI::App*, Options*> add_command(Parser& parser, const std::string& name, const std::string& what,
                                           int (*command)(const Options&, const Common&, const Context&)) {
  CLI::App* app = parser.app.add_subcommand(name, what);
  app->fallthrough();  // options that every command takes may stand after it
  auto options = std::make_shared<Options>();
  app->callback([&parser, options, command] {
    parser.chosen = [options, command, &common = parser.common](const Context& context) { return command(*options, common, context); };
  });
  return {app, options.get()};
}

/// An empty argument (a shell's unset variable) names no file.
CLI::Option* names_file(CLI::Option* option) {
  return option->check(CLI::Validator([](const std::string& text) { return text.empty() ? "names no file" : std::string(); }, ""));
}

/// Makes a CLI11 transform that stores an std::optional path, text or number.
template <class T>
CLI::Option* add_optional(CLI::App* app, const std::string& name, std::optional<T>& target, const std::string& what) {
  CLI::Option* option = app->add_option_function<std::string>(
      name, [&target](const std::string& text) { target = T(text); }, what);
  if constexpr (std::is_same_v<T, std::filesystem::path>) names_file(option);
  return option;
}

/// SIZE or SIZE@PARTS, cut at the first @.
std::pair<std::string, std::optional<std::string>> cut_at_parts(const std::string& text, std::size_t at) {
  if (at == std::string::npos) return {text, std::nullopt};
  return {text.substr(0, at), text.substr(at + 1)};
}

std::string wrong_size(const std::string& text) {
  const std::string size = cut_at_parts(text, text.find('@')).first;
  if (mesh::document::parse_target_size(size)) return "";
  return "must be a number greater than 0, \"part\" or \"deck\", not \"" + size + "\"";
}

/// Precondition: the size isn't wrong.
mesh::document::JudgingRule size_rule(const std::string& text) {
  const auto [size, parts] = cut_at_parts(text, text.find('@'));
  mesh::document::JudgingRule rule;
  rule.on = parts;
  if (const Result<mesh::document::TargetSize> known = mesh::document::parse_target_size(size)) rule.target_size = *known;
  return rule;
}

/// Cut at the first @ that has the name of criteria or of a file before it: a file's name may have an @ too.
mesh::document::JudgingRule criteria_rule(const std::string& text) {
  mesh::document::JudgingRule rule;
  rule.criteria = text;
  std::error_code failed;
  if (std::filesystem::exists(text, failed)) return rule;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at + 1)) {
    const std::filesystem::path name = text.substr(0, at);
    if (!mesh::quality::is_built_in_criteria(name) && !std::filesystem::exists(name, failed)) continue;
    rule.criteria = name.string();
    rule.on = text.substr(at + 1);
    break;
  }
  return rule;
}

/// Nothing where the text isn't a finite number.
std::optional<double> finite_number(const std::string& text) {
  double number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// Nothing for a word.
std::optional<double> positive_number(const std::string& text) {
  const std::optional<double> number = finite_number(text);
  return number && *number > 0 ? number : std::nullopt;
}

std::string wrong_gap(const std::string& text) {
  const std::optional<double> number = finite_number(text);
  return number && *number >= 0 ? "" : "must be a number of at least 0, not \"" + text + "\"";
}

std::string wrong_width(const std::string& text) {
  return positive_number(text) ? "" : "must be a number greater than 0, not \"" + text + "\"";
}

std::string wrong_thickness(const std::string& text) {
  if (text == "contact" || text == "section" || positive_number(text)) return "";
  return "must be contact, section or a number greater than 0, not \"" + text + "\"";
}

void add_common(Parser& parser) {
  CLI::App& app = parser.app;
  Common& common = parser.common;
  app.add_option_function<std::string>(
         "--length-unit", [&common](const std::string& text) { common.length_unit = length_unit_from(text); },
         "the deck's length unit: mm, m or in (default: guessed; a note says so)")
      ->check(CLI::IsMember({"mm", "m", "in"}));
  const auto add = [&common](const std::vector<std::string>& texts, const auto& rule_of) {
    for (const std::string& text : texts) common.rules.push_back(rule_of(text));
  };
  app.add_option_function<std::vector<std::string>>(
         "--target-size", [add](const std::vector<std::string>& texts) { add(texts, size_rule); },
         "the target element size: a length in the deck's length unit, \"part\" (default: each part's median edge; a note says so) or "
         "\"deck\" (the deck's median edge, one for all); SIZE@PARTS sets that of some parts, like 5@3,7; may be repeated")
      ->check(CLI::Validator([](const std::string& text) { return wrong_size(text); }, "SIZE[@PARTS]"))
      ->take_all()
      ->allow_extra_args(false);
  app.add_option_function<std::vector<std::string>>(
         "--criteria", [add](const std::vector<std::string>& texts) { add(texts, criteria_rule); },
         "a file of quality criteria (TOML), or a built-in one: default, strict; CRITERIA@PARTS sets those of some parts; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--json", common.json, "print only JSON");
}

void add_reading_commands(Parser& parser) {
  const auto [info_app, info_options] = add_command<InfoOptions>(parser, "info", "print what a deck contains", info);
  names_file(info_app->add_option("DECK", info_options->deck, "the deck's main file"))->required();
  CLI::Option* saves =
      info_app->add_flag("--save-settings", info_options->save_settings,
                         "also keep the target sizes and criteria in the settings file beside the deck, DECK.prismesh.toml");
  info_app
      ->add_flag("--sandboxed", info_options->sandboxed,
                 "for a deck that nobody vouches for: read it in a process that can do nothing but read its folder; includes elsewhere and "
                 "the settings file aren't read")
      ->excludes(saves);

  const auto [check_app, check_options] = add_command<CheckOptions>(parser, "check", "measure the quality of a deck's shells", check);
  names_file(check_app->add_option("DECK", check_options->deck, "the deck's main file"))->required();
  add_optional(check_app, "--select", check_options->select, "only these shells, e.g. part:3,shell:100-200");
  check_app->add_flag("--save-settings", check_options->save_settings,
                      "also keep the target sizes and criteria in the settings file beside the deck, DECK.prismesh.toml");
  check_app->add_flag("--chordal", check_options->chordal, "also the distance of edges from the smooth surface through the mesh");

  const auto [diff_app, diff_options] = add_command<DiffOptions>(parser, "diff", "compare two decks by ids and by lines", diff);
  names_file(diff_app->add_option("A", diff_options->a, "a deck"))->required();
  names_file(diff_app->add_option("B", diff_options->b, "another deck"))->required();

  const auto [report_app, report_options] =
      add_command<ReportOptions>(parser, "report", "write what changed between two decks as a page that can be mailed", report);
  names_file(report_app->add_option("A", report_options->a, "the deck before"))->required();
  names_file(report_app->add_option("B", report_options->b, "the deck after"))->required();
  names_file(report_app->add_option("-o,--output", report_options->output, "the page of HTML to write"))->required();
  add_optional(report_app, "--journal", report_options->journal, "the journal or the script of the edits, which the page then lists");
  report_app->add_option("--view", report_options->view, "of the pictures: front, back, left, right, top, bottom or iso (default)")
      ->check(CLI::IsMember({"front", "back", "left", "right", "top", "bottom", "iso"}));

  const auto [distance_app, distance_options] =
      add_command<DistanceOptions>(parser, "distance", "measure the shortest distance between two sets of nodes or shells", distance);
  names_file(distance_app->add_option("DECK", distance_options->deck, "the deck's main file"))->required();
  distance_app->add_option("--from", distance_options->from, "an expression: node ids, shell:ID, part:ID")->required();
  distance_app->add_option("--to", distance_options->to, "another expression")->required();

  const auto [penetrations_app, penetrations_options] =
      add_command<PenetrationsOptions>(parser, "penetrations", "find where shells cross or are too close", penetrations);
  names_file(penetrations_app->add_option("DECK", penetrations_options->deck, "the deck's main file"))->required();
  add_optional(penetrations_app, "--select", penetrations_options->select, "only where one of these shells takes part, e.g. part:3");
  penetrations_app->add_flag("--clear", penetrations_options->tries_clear,
                             "try what separate would remove, also in a deck of more than 100,000 shells");
  penetrations_app->add_option("--gap", penetrations_options->gap, "how far faces must be apart, in the deck's length unit (default: 0)")
      ->check(CLI::Validator([](const std::string& text) { return wrong_gap(text); }, "LENGTH"));
  penetrations_app
      ->add_option_function<std::string>(
          "--thickness",
          [options = penetrations_options](const std::string& text) {
            options->thickness = positive_number(text), options->by_contacts = text != "section";
          },
          "contact (default): what the deck's contacts say, else as section; section: that of elements and sections; a number: for all "
          "shells")
      ->check(CLI::Validator([](const std::string& text) { return wrong_thickness(text); }, "contact|section|LENGTH"));
}

/// "1.5,-2,0"; nothing where the text isn't three finite numbers.
std::optional<mesh::Vec3> three_numbers(const std::string& text) {
  mesh::Vec3 numbers;
  std::size_t begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = text.find(',', begin);
    if ((comma == std::string::npos) != (axis == 2)) return std::nullopt;
    const std::optional<double> number = finite_number(text.substr(begin, comma - begin));
    if (!number) return std::nullopt;
    numbers[axis] = *number;
    begin = comma + 1;
  }
  return numbers;
}

/// "x=120", or six numbers: a point and a normal. Nothing where it is neither.
std::optional<mesh::measure::Plane> plane_from(const std::string& text) {
  const std::size_t axis = text.empty() ? std::string::npos : std::string_view("xyz").find(text[0]);
  if (axis != std::string::npos && text.size() > 1 && text[1] == '=') {
    const std::optional<double> place = finite_number(text.substr(2));
    if (!place) return std::nullopt;
    const mesh::Vec3 normal = mesh::Vec3::Unit(static_cast<int>(axis));
    return mesh::measure::Plane{normal * *place, normal};
  }
  std::size_t middle = std::string::npos;
  for (int commas = 0; commas < 3; ++commas) {
    middle = text.find(',', middle + 1);
    if (middle == std::string::npos) return std::nullopt;
  }
  const std::optional<mesh::Vec3> at = three_numbers(text.substr(0, middle)), normal = three_numbers(text.substr(middle + 1));
  if (!at || !normal) return std::nullopt;
  return mesh::measure::Plane{*at, *normal};
}

std::string wrong_plane(const std::string& text) {
  return plane_from(text) ? "" : "must be like x=120, or six numbers X,Y,Z,NX,NY,NZ: a point and a normal, not \"" + text + "\"";
}

void add_welds(Parser& parser) {
  const auto [app, options] =
      add_command<WeldsOptions>(parser, "welds", "check whether welds join the sheets that they are to join", welds);
  names_file(app->add_option("DECK", options->deck, "the deck's main file"))->required();
  app->add_option("--edge-distance", options->edge_distance, "tell welds nearer to a free edge, deck's length unit (default: 0)")
      ->check(CLI::Validator([](const std::string& text) { return wrong_gap(text); }, "LENGTH"));
  app->add_option("--pitch", options->pitch, "tell welds of the same sheets nearer to each other, deck's length unit (default: 0)")
      ->check(CLI::Validator([](const std::string& text) { return wrong_gap(text); }, "LENGTH"));
}

void add_measuring(Parser& parser) {
  const auto [measure_app, measure_options] =
      add_command<MeasureOptions>(parser, "measure", "measure between two nodes, or the angle and the radius at three", measure_nodes);
  names_file(measure_app->add_option("DECK", measure_options->deck, "the deck's main file"))->required();
  measure_app->add_option("A", measure_options->a, "the id of a node")->required();
  measure_app->add_option("B", measure_options->b, "that of another node")->required();
  measure_app->add_option_function<std::int64_t>(
      "C", [options = measure_options](std::int64_t id) { options->c = id; }, "that of a third one; the angle is at B");

  const auto [section_app, section_options] =
      add_command<CrossSectionOptions>(parser, "cross-section", "cut the shells with a plane", cross_section);
  names_file(section_app->add_option("DECK", section_options->deck, "the deck's main file"))->required();
  section_app
      ->add_option_function<std::string>(
          "--plane",
          [options = section_options](const std::string& text) {
            if (const auto plane = plane_from(text)) options->plane = *plane;
          },
          "x=120, y=.. or z=.., in the deck's length unit, or X,Y,Z,NX,NY,NZ: a point and a normal")
      ->check(CLI::Validator([](const std::string& text) { return wrong_plane(text); }, ""))
      ->required();
  add_optional(section_app, "--parts", section_options->parts, "only these parts, an expression, e.g. 3,7-9");
  add_optional(section_app, "-o,--output", section_options->output,
               "also write the curves to this file as CSV: curve, part, closed, x, y, z");
}

void add_flanges(Parser& parser) {
  const auto [app, options] = add_command<FlangesOptions>(parser, "flanges", "find where sheets run parallel in bands", flanges);
  names_file(app->add_option("DECK", options->deck, "the deck's main file"))->required();
  add_optional(app, "--select", options->select, "only flanges with one of these shells, e.g. part:3");
  app->add_option(
         "--gap", options->gap,
         "how much farther apart than by their thickness sheets may be, in the deck's length unit (default: 0); needed where parts "
         "have no thickness")
      ->check(CLI::Validator([](const std::string& text) { return wrong_gap(text); }, "LENGTH"));
  app->add_option_function<std::string>(
         "--max-width", [options = options](const std::string& text) { options->max_width = positive_number(text); },
         "wider bands are no flanges, in the deck's length unit (default: 40 times the thickness)")
      ->check(CLI::Validator([](const std::string& text) { return wrong_width(text); }, "LENGTH"));
}

/// An option --elements of a command that makes the sample.
void add_elements(CLI::App* app, std::optional<std::size_t>& elements, const std::string& what, std::size_t usual) {
  app->add_option_function<std::size_t>(
         "--elements", [&elements](std::size_t n) { elements = n; },
         what + ", " + std::to_string(mesh::deck::kSampleShellsMin) + " to " + std::to_string(mesh::deck::kSampleShellsMax) + " (default " +
             std::to_string(usual) + ")")
      ->check(CLI::Range(mesh::deck::kSampleShellsMin, mesh::deck::kSampleShellsMax));
}

void add_writing_commands(Parser& parser) {
  const auto [edit_app, edit_options] = add_command<EditOptions>(parser, "edit", "edit a deck and write the result", edit);
  names_file(edit_app->add_option("DECK", edit_options->deck, "the deck's main file"))->required();
  edit_app->add_option("--edit", edit_options->edits, "an edit as JSON; may be repeated")->take_all()->allow_extra_args(false);
  add_optional(edit_app, "--script", edit_options->script, "a file of edits, one JSON object per line; they follow those of --edit");
  names_file(edit_app->add_option("-o,--output", edit_options->output, "the main file to write"))->required();
  add_optional(edit_app, "--journal", edit_options->journal, "also write a journal of the edits to this file");
  edit_app->add_flag("--keep-on-cancel", edit_options->keep_on_cancel,
                     "if a repair is stopped by Ctrl-C, write what it has reached; the exit status is 1");

  const auto [replay_app, replay_options] = add_command<ReplayOptions>(parser, "replay", "apply a journal's edits to a deck again", replay);
  names_file(replay_app->add_option("JOURNAL", replay_options->journal, "a journal, or a file of edits"))->required();
  names_file(replay_app->add_option("DECK", replay_options->deck, "the deck that the journal was made on, or a variant of it"))->required();
  names_file(replay_app->add_option("-o,--output", replay_options->output, "the main file to write"))->required();

  const auto [sample_app, sample_options] =
      add_command<SampleOptions>(parser, "sample", "write a generated sheet-metal assembly as an example deck", sample);
  add_elements(sample_app, sample_options->elements, "about how many shells", mesh::deck::kSampleShellsDefault);
  names_file(sample_app->add_option("-o,--output", sample_options->output, "the deck to write"))->required();
}

void add_batch(Parser& parser) {
  const auto [app, options] = add_command<BatchOptions>(
      parser, "batch",
      "edit, repair and measure many variants of decks by a plan; without --local and --slurm, make the tables of what is there", batch);
  names_file(app->add_option("PLAN", options->plan, "the plan (TOML), or a study that was frozen from it"))->required();
  CLI::Option* local = app->add_flag("--local", options->local, "work what is missing on this machine");
  CLI::Option* slurm = app->add_flag("--slurm", options->slurm, "submit what is missing to Slurm, as a job array")->excludes(local);
  app->add_option_function<std::size_t>(
         "--jobs", [o = options](std::size_t jobs) { o->jobs = jobs; }, "variants at the same time (default: one a processor)")
      ->check(CLI::Range(1, 4096));
  CLI::Option* variant = app->add_option_function<std::size_t>(
      "--variant", [o = options](std::size_t number) { o->variant = number; }, "what workers are started with: work only this variant");
  variant->excludes(local)->excludes(slurm);
  CLI::Option* task = app->add_option_function<std::size_t>(
      "--task", [o = options](std::size_t number) { o->task = number; }, "what tasks of Slurm are started with, from 0, with --tasks");
  task->excludes(local)->excludes(slurm)->excludes(variant);
  app->add_option("--tasks", options->tasks, "how many tasks share the variants")->needs(task)->check(CLI::Range(1, 1'000'000));
}

void add_bench(Parser& parser) {
  const auto [app, options] = add_command<BenchOptions>(parser, "bench", "measure how long the core's work takes on this machine", bench);
  add_optional(app, "DECK", options->deck, "the deck's main file (default: the generated sample)");
  add_optional(app, "FILTER", options->filter,
               "measure only figures in whose names this regular expression is found; without DECK it may stand alone");
  add_elements(app, options->elements, "about how many shells the sample has", kBenchShellsDefault);
  app->add_option_function<std::size_t>(
         "--patch", [o = options](std::size_t nodes) { o->patch = nodes; },
         "about how many nodes the patch has that is lifted (default " + std::to_string(kBenchPatchDefault) + ")")
      ->check(CLI::PositiveNumber);
}

void add_render(Parser& parser) {
  const auto [app, options] = add_command<RenderOptions>(parser, "render", "draw a deck into a picture, without a screen", render);
  names_file(app->add_option("DECK", options->deck, "the deck's main file"))->required();
  names_file(app->add_option("-o,--output", options->output, "the PNG to write"))->required();
  add_optional(app, "--select", options->select, "show these nodes as selected, e.g. 1-100,part:3");
  // the kiosk checks the values of these
  const auto pass_on = [app = app, o = options](const std::string& name, const std::string& what) {
    app->add_option_function<std::string>(
        name,
        [o, name](const std::string& value) {
          o->passed_on.insert(o->passed_on.end(), {name, value});
        },
        what);
  };
  pass_on("--size", "WxH in pixels (default 1920x1080)");
  pass_on("--profile",
          "display profile: prism-mask (default), prism-mask-columns, prism-mask-stencil, lenticular, row-interlaced, side-by-side, "
          "top-bottom, anaglyph, mono, mono-left, mono-right, or a file");
  pass_on("--eye", "X,Y,Z: the point between the eyes, mm from the screen's centre (default 0,0,650)");
  pass_on("--mask", "position of a movable mask, mm (default: the right one for these eyes)");
  pass_on("--view", "front, back, left, right, top, bottom or iso (default)");
  app->add_flag_callback(
      "--thickness",
      [o = options] {
        o->passed_on.insert(o->passed_on.end(), {"--thickness", "on"});
      },
      "draw shells as plates with the thickness of their part");
  add_optional(
      app, "--colour", options->colour,
      "parts (default), quality, part-states, or a field: displacement, distance-to-original, distance, metric:NAME, composite, time-step");
  add_optional(app, "--against", options->against, "the deck that displacement and distance-to-original compare with");
  app->add_option("--from", options->from, "for the field distance: the nodes to colour, an expression");
  app->add_option("--to", options->to, "for the field distance: the nodes or shells to measure to, an expression");
  add_optional(
      app, "--limits", options->limits,
      "CLEAR,FULL: the value up to which the part's colour stays, and the value with the map's last colour (default: from the field)");
  pass_on("--map", "colour map of fields: crimson (default) or blues");
  pass_on("--bands", "number of uniform colour bands (default: a gradient)");
}

void add_session(Parser& parser) {
  const auto [app, options] = add_command<SessionOptions>(parser, "session", "edit the document that a running modeld has open", session);
  app->require_subcommand(1);
  add_optional(app, "--runtime-dir", options->runtime_directory, "the folder of modeld's socket");
  using Action = SessionOptions::Action;
  const auto add = [app = app, o = options](const std::string& name, Action action, const std::string& what) {
    CLI::App* command = app->add_subcommand(name, what);
    command->fallthrough();
    command->parse_complete_callback([o, action] { o->action = action; });
    return command;
  };
  const auto add_unsaved = [o = options](CLI::App* command) {
    CLI::Option* discard = command->add_flag("--discard", o->discard, "give unsaved edits up");
    command->add_flag("--keep", o->keep, "keep unsaved edits: they come back when their deck is opened again")->excludes(discard);
  };
  CLI::App* open_app = add("open", Action::open, "open a deck");
  CLI::Option* deck = names_file(open_app->add_option("DECK", options->deck, "the deck's main file"));
  CLI::Option* stored =
      open_app->add_option("--stored", options->stored, "instead of DECK: a model of the store, by its hash")->excludes(deck);
  open_app->callback([deck, stored] {
    if (deck->count() + stored->count() == 0) throw CLI::RequiredError("DECK or --stored");
  });
  open_app->add_flag("--sandboxed", options->sandboxed, "nobody vouches for the deck: modeld has it read and rewritten in a sandbox");
  add_unsaved(open_app);
  CLI::App* edit_app = add("edit", Action::edit, "edit the open document");
  edit_app->add_option("EDIT", options->edits, "an edit as JSON; may be repeated");
  add_optional(edit_app, "--script", options->script, "a file of edits, one JSON object per line; they follow the others");
  edit_app->add_flag("--keep-on-cancel", options->keep_on_cancel,
                     "if a repair is stopped by Ctrl-C, keep what it has reached; the exit status is 1");
  add_optional(add("save", Action::save, "save the document"), "OUT", options->output, "the main file to write (default: in place)");
  CLI::App* report_app = add("report", Action::report, "write what the open document changes as a page that can be mailed");
  report_app->add_option("-o,--output", options->output, "the page of HTML to write")->required();
  add_optional(report_app, "--before", options->before, "the deck before (default: the document's file, as it is on disk)");
  add("state", Action::state, "print what is open");
  add("undo", Action::undo, "undo the last edit");
  add("redo", Action::redo, "apply the last undone edit again");
  add_unsaved(add("close", Action::close, "close the document"));
}

void add_station(CLI::App* app, std::string& station) {
  app->add_option("--station", station, "the station's address, HOST or HOST:PORT (default: the only one that is paired)");
}

void add_remote(Parser& parser) {
  const auto [pair_app, pair_options] = add_command<PairOptions>(parser, "pair", "pair this computer with a station", pair);
  pair_app->add_option("STATION", pair_options->station, "the station's address, HOST or HOST:PORT (default port 7443)")->required();
  pair_app->add_option("CODE", pair_options->code, "the code that `prismesh intake code` shows at the station")->required();
  add_optional(pair_app, "--name", pair_options->name, "how the station calls this computer (default: USER@HOST)");

  const auto [push_app, push_options] = add_command<PushOptions>(
      parser, "push", "send a deck with its includes to a station; called again, it goes on where it stopped", push);
  names_file(push_app->add_option("DECK", push_options->deck, "the deck's main file"))->required();
  add_station(push_app, push_options->station);
  push_app->add_option("--name", push_options->name, "the model's name at the station (default: the main file's)");

  const auto [pull_app, pull_options] =
      add_command<PullOptions>(parser, "pull", "fetch a model from a station; called again, it goes on where it stopped", pull);
  pull_app->add_option("MODEL", pull_options->model, "its name, its hash, or six digits or more of the hash's beginning")->required();
  add_station(pull_app, pull_options->station);
  add_optional(pull_app, "-o,--output", pull_options->output, "the folder to make (default: named by main file and hash)");

  const auto [watch_app, watch_options] =
      add_command<WatchOptions>(parser, "watch", "print what is published at a station, until Ctrl-C", watch);
  add_station(watch_app, watch_options->station);

  const auto [app, options] =
      add_command<StationsOptions>(parser, "stations", "list the stations that this computer is paired with", stations);
  app->require_subcommand(0, 1);
  using Action = StationsOptions::Action;
  CLI::App* forget_app = app->add_subcommand("forget", "give the token of a station up, and forget the station");
  forget_app->add_option("STATION", options->station, "the station's address")->required();
  forget_app->fallthrough();
  forget_app->parse_complete_callback([o = options] { o->action = Action::forget; });
  CLI::App* models_app = app->add_subcommand("models", "list a station's models");
  add_station(models_app, options->station);
  models_app->fallthrough();
  models_app->parse_complete_callback([o = options] { o->action = Action::models; });
}

void add_vault(Parser& parser) {
  const auto [app, options] =
      add_command<VaultOptions>(parser, "vault", "keep models in a store that speaks S3, and fetch them from there", vault);
  app->require_subcommand(1);
  app->add_option("--vault", options->vault,
                  "s3+https://HOST[:PORT]/BUCKET[/FOLDER] (default: $PRISMESH_VAULT, else that of the file of keys)");
  add_optional(app, "--credentials", options->credentials,
               "the file of keys, which only you may read (default: vault.toml in ~/.config/prismesh; $AWS_ACCESS_KEY_ID and "
               "$AWS_SECRET_ACCESS_KEY come first)");
  app->add_flag("--plain-http", options->plain_http, "send without encryption to another computer too: all on the way can read the models");
  app->add_option("--patience", options->patience_s, "how long to try again when the store doesn't answer (default: 60 s)")
      ->type_name("SECONDS")
      ->check(CLI::Range(1, 86400).description(""));
  using Action = VaultOptions::Action;
  const auto add = [app = app, o = options](const std::string& name, Action action, const std::string& what) {
    CLI::App* command = app->add_subcommand(name, what);
    command->fallthrough();
    command->parse_complete_callback([o, action] { o->action = action; });
    return command;
  };
  CLI::App* push_app = add("push", Action::push, "put a deck with its includes there; called again, it sends what is missing");
  names_file(push_app->add_option("DECK", options->deck, "the deck's main file"))->required();
  push_app->add_option("--name", options->name, "the model's name there (default: the main file's)");
  push_app->add_flag("--resend", options->resend, "send also what is there: mends what `vault verify` names");
  push_app->add_flag("--outside", options->outside, "send also files that the deck includes from outside its folder");
  add("list", Action::list, "list the models that are there");
  CLI::App* fetch_app = add("fetch", Action::fetch, "fetch a model; called again, it goes on where it stopped");
  fetch_app->add_option("MODEL", options->model, "its name, its hash, or six digits or more of the hash's beginning")->required();
  add_optional(fetch_app, "-o,--output", options->output, "the folder to make (default: named by main file and hash)");
  add("verify", Action::verify, "read everything that is there again, and name what doesn't match its hash")
      ->add_option("MODEL", options->model, "only this model, by name or hash (default: all)");
}

void add_intake(Parser& parser) {
  const auto [app, options] =
      add_command<IntakeOptions>(parser, "intake", "at a station: make pairing codes, list and revoke tokens", intake);
  app->require_subcommand(1);
  add_optional(app, "--runtime-dir", options->runtime_directory, "the folder of prismesh-intake's socket");
  using Action = IntakeOptions::Action;
  const auto add = [app = app, o = options](const std::string& name, Action action, const std::string& what) {
    CLI::App* command = app->add_subcommand(name, what);
    command->fallthrough();
    command->parse_complete_callback([o, action] { o->action = action; });
    return command;
  };
  CLI::App* code_app = add("code", Action::code, "make a code that pairs one computer, good for five minutes");
  code_app->add_option("--name", options->name, "the token's name (default: the computer says one)");
  code_app->add_option("--allow", options->allow, "what the token may do, of read, upload, remove, metrics (default: read,upload)")
      ->delimiter(',')
      ->check(CLI::IsMember({"read", "upload", "remove", "metrics"}));
  add("tokens", Action::tokens, "list the tokens");
  add("describe", Action::describe, "read stored models in the sandbox, and give the catalogue their figures and pictures")
      ->add_option("MODEL", options->name, "its name, or six digits or more of its hash (default: all that aren't described yet)");
  add("revoke", Action::revoke, "make a token void at once")->add_option("NAME", options->name, "the token's name")->required();
}

void add_devices(Parser& parser) {
  const auto [app, options] = add_command<DevicesOptions>(
      parser, "devices", "show the eye tracker, the prism servo, the haptic pen and their control loops", devices);
  add_optional(app, "--runtime-dir", options->runtime_directory, "the folder of deviced's socket");
  app->add_flag("--watch", options->watch, "print again each second, until Ctrl-C");
  app->add_flag("--rearm", options->rearm, "first enable a mask again that was stuck or switched itself off");
  app->add_flag("--reload", options->reload, "first read prismesh.toml and the display profile again");
  auto* arm = app->add_flag("--arm-pen", options->arm_pen, "first arm the haptic pen, so that it may push");
  app->add_flag("--disarm-pen", options->disarm_pen, "first disarm the haptic pen")->excludes(arm);
  app->add_flag("--self-test", options->self_test, "measure the loop, the delay and the forces of the haptic pen for three seconds");
  CLI::Option* record = add_optional(app, "--record", options->record,
                                     "write what the haptic pen's loop does to a file: its last four seconds, and what follows");
  app->add_option("--seconds", options->seconds, "how long to go on recording (default 10; 0: only what has been)")
      ->needs(record)
      ->check(CLI::Range(0.0, 86400.0));
  add_optional(app, "--replay", options->replay, "run the pen's safety again on such a file, and say what it does otherwise")
      ->excludes(record);
}

void add_doctor(Parser& parser) {
  const auto [app, options] = add_command<DoctorOptions>(
      parser, "doctor", "say of everything that a station needs whether it is good, or what to do about it", doctor);
  add_optional(app, "--runtime-dir", options->runtime_directory, "the folder of the daemons' sockets");
  add_optional(app, "--state-dir", options->state_directory, "the folder of modeld's journals");
}

/// Wrong usage as an Error that names the command and, for an unknown command, the nearest known one.
tl::unexpected<Error> usage_error(const Parser& parser, std::span<const std::string> args, const CLI::ParseError& problem) {
  std::string command = "prismesh";
  std::vector<std::string> names;
  for (const CLI::App* known : parser.app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(known->get_name());
    if (known->parsed()) command += " " + known->get_name();
  }
  std::string message = problem.what();
  if (command == "prismesh" && !args.empty() && !args[0].starts_with('-')) {
    const std::vector<std::string_view> known(names.begin(), names.end());
    message = "there is no command \"" + args[0] + "\"; the nearest is \"" + std::string(nearest_name(args[0], known)) + "\"";
  }
  return fail(command, message + " (" + command + " --help shows the usage)");
}

}  // namespace

Result<Action> parse_arguments(std::span<const std::string> args) {
  const auto parser = std::make_shared<Parser>();
  parser->app.require_subcommand(1);
  parser->app.set_version_flag("--version", "prismesh " PRISMESH_VERSION);
  add_common(*parser);
  add_reading_commands(*parser);
  add_flanges(*parser);
  add_welds(*parser);
  add_measuring(*parser);
  add_writing_commands(*parser);
  add_batch(*parser);
  add_bench(*parser);
  add_render(*parser);
  add_session(*parser);
  add_remote(*parser);
  add_vault(*parser);
  add_intake(*parser);
  add_devices(*parser);
  add_doctor(*parser);
  try {
    std::vector<std::string> reversed(args.rbegin(), args.rend());
    parser->app.parse(std::move(reversed));
  } catch (const CLI::ParseError& problem) {
    if (problem.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) return usage_error(*parser, args, problem);
    std::ostringstream text;  // --help and --version come as exceptions too
    parser->app.exit(problem, text, text);
    return Action([text = text.str()](const Context& context) {
      context.out << text;
      return kDone;
    });
  }
  return Action([parser](const Context& context) { return parser->chosen(context); });
}

}  // namespace prismesh::cli
