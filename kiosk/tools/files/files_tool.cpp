#include "kiosk/tools/files/files_tool.h"

#include <array>
#include <cstdlib>
#include <filesystem>

#include "base/child_process.h"
#include "kiosk/toolkit/open_panels.h"

namespace prismesh::kiosk::tools::files {
namespace {

using input::Command;
using input::KeyBinding;
using input::Menu;

using display::letter;

constexpr std::string_view kName = "files";
constexpr std::size_t kRecentDecks = 8;
constexpr std::int64_t kReportLookNs = 100'000'000;

enum class FilesCommand : std::uint8_t { open, save, save_as, save_copy, report, quit };

constexpr Command command_of(FilesCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{letter('O'), true, false, command_of(FilesCommand::open), Menu::file, "Ctrl+O", "open a deck"},
    KeyBinding{letter('S'), true, false, command_of(FilesCommand::save), Menu::file, "Ctrl+S", "save"},
    KeyBinding{letter('S'), true, true, command_of(FilesCommand::save_as), Menu::file, "Ctrl+Shift+S",
               "save as another deck, and go on with that one"},
    KeyBinding{letter('C'), true, true, command_of(FilesCommand::save_copy), Menu::file, "Ctrl+Shift+C",
               "save a copy, and go on with this deck"},
    KeyBinding{letter('W'), true, true, command_of(FilesCommand::report), Menu::file, "Ctrl+Shift+W",
               "write a report of the unsaved edits, a page to mail"},
    KeyBinding{letter('Q'), true, false, command_of(FilesCommand::quit), Menu::file, "Ctrl+Q", "quit; with unsaved edits it asks first"},
};

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

Command quit_command() { return command_of(FilesCommand::quit); }
Command open_command() { return command_of(FilesCommand::open); }
Command save_command() { return command_of(FilesCommand::save); }

std::string_view FilesTool::name() const { return kName; }

void FilesTool::command(std::uint8_t number, const toolkit::Pointer&) {
  const auto dialog = [&](PathDialog kind) { toolkit::open_dialog(context_, this, static_cast<int>(kind)); };
  switch (static_cast<FilesCommand>(number)) {
    case FilesCommand::open:
      not_opened_.reset();
      dialog(PathDialog::open);
      break;
    case FilesCommand::save: deck_files_.save(save_remark()); break;
    case FilesCommand::save_as:
      if (context_.shown.snapshot) dialog(PathDialog::save_as);
      break;
    case FilesCommand::save_copy:
      if (context_.shown.snapshot) dialog(PathDialog::save_copy);
      break;
    case FilesCommand::report: write_report(); break;
    case FilesCommand::quit:
      deck_files_.quit();
      context_.quits = deck_files_.quits();
      break;
  }
}

Result<void> FilesTool::prepare() {
  deck_files_.follow();
  context_.quits = deck_files_.quits();
  if (question() != nullptr) toolkit::set_cover(context_, toolkit::Cover::none);
  if (auto failed = context_.link.deck.take_not_opened(); failed && failed->deck == asked_) {
    // The box comes back with what was tried, and says what is wrong with it: the notice would say it twice.
    if (!context_.notices.empty() && context_.notices.front().text == failed->why) context_.notices.read();
    entry_.typed = entry_.begun = failed->deck.string();  // the box may not have been away for a picture
    not_opened_ = std::move(failed);
    toolkit::open_dialog(context_, this, static_cast<int>(PathDialog::open));
  }
  return {};
}

/// The deck is open: the next time it is one of the recent ones.
void FilesTool::document_changed() {
  asked_.clear();
  const auto& shown = context_.shown.snapshot;
  if (!shown) return;
  // The copy of a stored model isn't opened as any other deck: nobody vouches for it.
  if (const auto& state = context_.link.document.state(); state && !state->stored.empty()) return;
  const ipc::SnapshotInfo& info = shown->info();
  decks_.add(line_of({info.document, info.counts.ok + info.counts.warn + info.counts.fail, info.nodes, info.parts.size()}));
}

void FilesTool::reply(panels::Reply reply) {
  deck_files_.reply(reply);
  context_.quits = deck_files_.quits();
}

void FilesTool::write_report() {
  using Kind = notices::Notice::Kind;
  const auto& newest = context_.link.document.snapshot();
  if (!newest) return;
  if (!newest->info().changed)
    return context_.notices.say(Kind::information,
                                "There are no unsaved edits to report. `prismesh report BEFORE AFTER -o PAGE` compares two decks.");
  const Result<std::filesystem::path> program = program_beside("prismesh", "which writes reports", "prismesh");
  const char* home = std::getenv("HOME");
  const std::filesystem::path page = report_page(newest->info().document, home != nullptr ? home : "");
  const Result<void> begun =
      program ? report_.begin(*program, context_.link.connection.socket().parent_path(), page) : fail(program.error());
  context_.trace.line("report " + std::string(begun ? "begun" : "refused"));
  if (begun)
    context_.notices.say(Kind::information, "Writing " + page.string() + "; you can go on.");
  else
    context_.notices.say(Kind::error, "No report: " + begun.error().text());
}

void FilesTool::watch(std::int64_t) {
  const std::optional<ReportWriter::Outcome> outcome = report_.look();
  if (!outcome) return;
  context_.notices.say(outcome->is_written ? notices::Notice::Kind::information : notices::Notice::Kind::error, outcome->words);
  context_.trace.line(std::string("report ") + (outcome->is_written ? "written" : "failed"));
}

/// A program that ends sends no message.
std::int64_t FilesTool::next_ns(std::int64_t now_ns) const { return report_.writes() ? now_ns + kReportLookNs : -1; }

std::string FilesTool::save_remark() const {
  return context_.shown.older ? "It is the newest state that was saved, not the older one that is shown." : "";
}

void FilesTool::draw_dialog(int kind, bool opened, panels::PanelLayout& layout) {
  const auto dialog = static_cast<PathDialog>(kind);
  const std::string deck = context_.shown.snapshot ? context_.shown.snapshot->info().document : std::string();
  if (opened && dialog == PathDialog::open) shelf_ = read_shelf(context_.options.intake);
  if (opened) pairing_.clear();
  PathFacts facts{dialog, opened, deck, {}, {}, recent_decks(decks_.entries(), kRecentDecks), shelf_, pairing_};
  if (not_opened_ && dialog == PathDialog::open) {
    facts.tried = not_opened_->deck.string();
    facts.problem = not_opened_->why;
  }
  const std::optional<std::string> entered = path_box(facts, entry_, layout);
  if (std::exchange(entry_.cancelled, false)) layout.ask([this] { toolkit::close_dialog(context_); });
  if (!entered) return;
  if (*entered == kPairName) {
    // The box stays and shows the code: it is read off while it is typed elsewhere.
    layout.ask([this] { pairing_ = ask_for_pairing(context_.options.intake); });
    return;
  }
  layout.ask([this, dialog, path = *entered] { enter(dialog, path); });
  layout.ask([this] { toolkit::close_dialog(context_); });
}

void FilesTool::enter(PathDialog dialog, const std::string& path) {
  if (dialog == PathDialog::open) {
    std::error_code ignored;
    asked_ = link::is_stored_name(path) ? path : std::filesystem::absolute(path, ignored).string();
    not_opened_.reset();
    return deck_files_.open(path);
  }
  const auto how = dialog == PathDialog::save_copy ? DeckFiles::Elsewhere::copy : DeckFiles::Elsewhere::becomes;
  deck_files_.save_elsewhere(path, how, save_remark());
}

}  // namespace prismesh::kiosk::tools::files
