// Draws a picture without a daemon: seals a snapshot in shared memory and starts the headless kiosk, which is beside this program.
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <system_error>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/child_process.h"
#include "cli/commands.h"
#include "cli/draw_picture.h"
#include "cli/figures.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "ipc/model/field_page.h"
#include "ipc/model/snapshot_publisher.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/field.h"
#include "mesh/document/field_wish.h"
#include "mesh/document/make_field.h"
#include "mesh/document/prepare.h"

namespace prismesh::cli {

namespace {

using mesh::document::FieldWish;

constexpr const char* kKiosk = "prismesh-kiosk";

/// The snapshot's descriptors for the kiosk, open until it has ended.
struct SealedSnapshot {
  ipc::SnapshotPublisher publisher;
  ipc::PublishedSnapshot published;
  std::vector<ipc::Descriptor> segments;

  std::vector<int> descriptors() const {
    std::vector<int> all{published.table.get()};
    for (const ipc::Descriptor& segment : segments) all.push_back(segment.get());
    return all;
  }
};

Result<std::unique_ptr<SealedSnapshot>> seal(const mesh::document::Document& document) {
  auto sealed = std::make_unique<SealedSnapshot>();
  Result<ipc::PublishedSnapshot> published = sealed->publisher.publish(document, false);
  if (!published) return fail(published.error());
  sealed->published = std::move(*published);
  for (const std::uint64_t id : sealed->published.segments) {
    Result<ipc::Descriptor> segment = sealed->publisher.segment(id);
    if (!segment) return fail(segment.error());
    sealed->segments.push_back(std::move(*segment));
  }
  return sealed;
}

/// The legend's text for what a field is compared with.
std::string compared_with(const FieldWish& wish, const RenderOptions& options) {
  if (wish.of == FieldWish::Of::gap) return "of " + wish.from + " from " + wish.to;
  return options.against ? "against " + options.against->filename().string() : "";
}

/// The field that the options name; nothing if they name another colour mode. Errors: options that don't fit the mode.
Result<std::optional<FieldWish>> wished_field(const RenderOptions& options) {
  const std::string colour = options.colour.value_or("parts");
  Result<FieldWish> wish = mesh::document::field_wish(colour);
  if (!wish) {
    if (colour.find(':') != std::string::npos) return fail(wish.error());
    const char* const given = options.against         ? "--against"
                              : !options.from.empty() ? "--from"
                              : !options.to.empty()   ? "--to"
                              : options.limits        ? "--limits"
                                                      : nullptr;
    if (given != nullptr) return fail(given, "is for the colours of a field; " + wish.error().message);
    return std::optional<FieldWish>();  // other modes are the kiosk's
  }
  wish->from = options.from;
  wish->to = options.to;
  const bool gap = wish->of == FieldWish::Of::gap;
  if (gap && (wish->from.empty() || wish->to.empty()))
    return fail("--colour distance", "say with --from which nodes are coloured, and with --to what their distance is measured to");
  if (!gap && !(wish->from.empty() && wish->to.empty())) return fail("--colour " + colour, "--from and --to are for --colour distance");
  if (needs_other(*wish) && !options.against) return fail("--colour " + colour, "say with --against which deck to compare with");
  if (!needs_other(*wish) && options.against) return fail("--colour " + colour, "is compared with nothing: leave --against out");
  return std::optional(std::move(*wish));
}

/// The same of the options: reads the deck that the field compares with.
Result<SealedField> seal_wished(const mesh::document::Document& document, const FieldWish& wish, const RenderOptions& options,
                                const Context& context) {
  std::optional<mesh::deck::OpenedDeck> other;
  if (needs_other(wish)) {
    MonotonicClock clock;
    ProgressBar bar(context, "reading " + options.against->filename().string(), clock);
    Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(*options.against, bar.progress());
    if (!opened && opened.error().file.empty()) opened.error().file = options.against->string();
    if (!opened) return fail(std::move(opened.error()));
    other = std::move(*opened);
  }
  return seal_field(document, wish, other ? &other->model : nullptr, compared_with(wish, options), options.limits);
}

/// Starts a program that inherits these descriptors under their numbers.
Result<pid_t> start(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::vector<int>& descriptors) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : descriptors) posix_spawn_file_actions_adddup2(&actions, descriptor, descriptor);  // without close-on-exec
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return fail(program.string(), std::string("could not be started: ") + std::strerror(error));
  return child;
}

/// Waits for a child, and ends it when the user wants to stop. Returns its wait status.
int wait_for(pid_t child, const Context& context) {
  int status = 0;
  bool told = false;
  while (true) {
    if (context.stop() && !told) told = kill(child, SIGTERM) == 0;
    const pid_t ended = waitpid(child, &status, context.interrupted != nullptr ? WNOHANG : 0);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return status;
    if (ended == 0) usleep(5000);
  }
}

}  // namespace

Result<SealedField> seal_field(const mesh::document::Document& document, const FieldWish& wish, const mesh::Model* other,
                               const std::string& compared_with, const std::optional<std::string>& limits) {
  const mesh::document::Generation& current = document.current();
  const auto field = make_field(wish, current, document, other);
  if (!field) return fail(field.error());
  Result<ipc::Descriptor> values = ipc::seal_field(current.number, field->on_nodes, field->values);
  if (!values) return fail(std::move(values.error()));
  const FieldFigures figures = figures_of(*field, current.model);
  // for a distance between two expressions only the first one's nodes are meant to have values
  const std::size_t without = wish.of == FieldWish::Of::gap ? 0 : shells_without_value(current.model, *field);
  SealedField sealed{std::move(*values), {}};
  sealed.arguments = {"--field-fd",      std::to_string(sealed.values.get()),
                      "--field-title",   field->title,
                      "--field-unit",    field->unit,
                      "--field-of",      compared_with,
                      "--field-range",   shortest(figures.min) + "," + shortest(figures.max),
                      "--field-least",   figures.min_at,
                      "--field-most",    figures.max_at,
                      "--field-without", std::to_string(without),
                      "--limits",        limits.value_or(shortest(field->limits.clear) + "," + shortest(field->limits.full))};
  return sealed;
}

std::string box_argument(const mesh::report::PartFigures::Box& box) {
  std::string text;
  for (const mesh::Vec3* corner : {&box.min, &box.max})
    for (int axis = 0; axis < 3; ++axis) text += (text.empty() ? "" : ",") + shortest((*corner)[axis]);
  return text;
}

std::string displacement_limits(double largest) { return shortest(largest / 50) + "," + shortest(largest); }

Result<int> draw_picture(const mesh::document::Document& document, const std::filesystem::path& output,
                         const std::vector<std::string>& more, int field, const Context& context) {
  const Result<std::filesystem::path> kiosk = program_beside(kKiosk, "which draws pictures", "prismesh-station");
  if (!kiosk) return fail(kiosk.error());
  const auto sealed = seal(document);
  if (!sealed) return fail(sealed.error());
  std::vector<int> inherited = (*sealed)->descriptors();
  std::string list;
  for (const int descriptor : inherited) list += (list.empty() ? "" : ",") + std::to_string(descriptor);
  std::vector<std::string> arguments{kKiosk, "--render", output.string(), "--snapshot-fds", list};
  arguments.insert(arguments.end(), more.begin(), more.end());
  if (field >= 0) inherited.push_back(field);
  context.err.flush();
  const Result<pid_t> child = start(*kiosk, arguments, inherited);
  if (!child) return fail(child.error());
  const int status = wait_for(*child, context);
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  if (context.stop()) return fail(output.string(), "stopped; no picture was written");
  return fail(kiosk->string(), "ended by signal " + std::to_string(WTERMSIG(status)) + "; no picture was written");
}

int render(const RenderOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<std::optional<FieldWish>> wish = wished_field(options);
  if (!wish) {
    say(context, wish.error());
    return kWrongUsage;
  }
  const Result<std::filesystem::path> kiosk = program_beside(kKiosk, "which draws pictures", "prismesh-station");
  if (!kiosk) return refuse(kiosk.error());
  Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  if (const Result<void> other = check_replaces_no_deck(options.output, *document); !other) return refuse(other.error());
  if (options.select) {
    mesh::document::Select select;
    select.expr = *options.select;
    if (const auto selected = mesh::document::apply(*document, select); !selected) return refuse(selected.error());
  }
  say_warnings(context, *document);
  std::vector<std::string> arguments = options.passed_on;
  std::optional<SealedField> coloured;
  if (*wish) {
    Result<SealedField> field = seal_wished(*document, **wish, options, context);
    if (!field) return refuse(field.error());
    coloured = std::move(*field);
    arguments.insert(arguments.end(), coloured->arguments.begin(), coloured->arguments.end());
  } else if (options.colour) {
    arguments.insert(arguments.end(), {"--colour", *options.colour});
  }
  const Result<int> drawn = draw_picture(*document, options.output, arguments, coloured ? coloured->values.get() : -1, context);
  return drawn ? *drawn : refuse(drawn.error());
}

}  // namespace prismesh::cli
