#include "kiosk/tools/files/deck_files.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk::tools::files {
namespace {

using link::Unsaved;
using panels::Question;
using panels::Reply;

std::string file_name(const std::filesystem::path& path) { return path.filename().string(); }

Question::Choice choice(Reply reply, std::string label, char key) {
  return {reply, std::move(label), display::letter(key), std::string(1, key)};
}

Question::Choice cancel(std::string label = "Cancel") { return {Reply::cancel, std::move(label), display::Key::escape, "Esc"}; }

/// What can be done about unsaved edits. `stay`: what happens if nothing is.
std::vector<Question::Choice> unsaved_choices(const std::string& stay) {
  return {choice(Reply::save, "Save", 'S'), choice(Reply::keep, "Keep for next time", 'K'), choice(Reply::discard, "Discard", 'D'),
          cancel(stay)};
}

/// "the file", "3 files": what a button speaks of.
std::string one_or_several(std::size_t count, const char* one, const char* several) {
  return count == 1 ? std::string(one) : fmt::format("{} {}", count, several);
}

/// What the button does that writes all the same.
std::string doing(const ipc::SaveWould& would) {
  const std::string folders = would.make.empty() ? "" : "make " + one_or_several(would.make.size(), "the folder", "folders");
  const std::string files = would.replace.empty() ? "" : "Replace " + one_or_several(would.replace.size(), "the file", "files");
  if (files.empty()) return "M" + folders.substr(1);
  return folders.empty() ? files : files + ", " + folders;
}

}  // namespace

/// As far as the server has said; empty: none.
std::string DeckFiles::open_deck() const {
  if (const auto& snapshot = link_.document.snapshot()) return snapshot->info().document;
  return link_.document.state() ? link_.document.state()->path : std::string();
}

void DeckFiles::save(const std::string& remark) { write({}, remark); }

void DeckFiles::save_elsewhere(const std::filesystem::path& path, Elsewhere how, const std::string& remark) {
  ipc::Save request;
  std::error_code ignored;
  request.path = std::filesystem::absolute(path, ignored).lexically_normal().string();
  request.becomes = how == Elsewhere::becomes;
  request.stays_unsaved = how == Elsewhere::copy;
  request.asks = true;
  // The server takes the deck's own path for saving in place, of which a copy isn't thought.
  std::error_code missing;
  if (how == Elsewhere::copy && std::filesystem::equivalent(*request.path, open_deck(), missing) && !missing) {
    ipc::SaveWould would;
    would.replace.push_back(*request.path);
    return ask_about_writing(request, remark, would);
  }
  write(request, remark);
}

void DeckFiles::write(const ipc::Save& request, const std::string& remark) {
  link_.deck.save(request, remark, [this, request, remark](const ipc::Answer& answer) {
    if (const auto* would = std::get_if<ipc::SaveWould>(&answer)) ask_about_writing(request, remark, *would);
  });
}

void DeckFiles::ask_about_writing(const ipc::Save& request, const std::string& remark, const ipc::SaveWould& would) {
  about_ = open_deck();
  to_write_ = request;
  to_write_.asks = false;
  remark_ = remark;
  Question& question = question_.emplace();
  question.title = (request.becomes ? "Save as " : "Save a copy as ") + file_name(*request.path) + "?";
  if (!would.replace.empty())
    question.lists.push_back({would.replace.size() == 1 ? "This file is there already:" : "These files are there already:", would.replace});
  if (!would.make.empty())
    question.lists.push_back({would.make.size() == 1 ? "This folder isn't there yet:" : "These folders aren't there yet:", would.make});
  question.choices = {choice(Reply::write, doing(would), would.replace.empty() ? 'M' : 'R'), cancel()};
  trace_.line(fmt::format("asks write replace {} make {}", would.replace.size(), would.make.size()));
}

void DeckFiles::ask_about_edits(const std::filesystem::path& deck) {
  about_ = open_deck();
  to_open_ = deck;
  const std::string open = file_name(about_);
  Question& question = question_.emplace();
  const std::string next = link::is_stored_name(deck.string()) ? "the model from the store" : file_name(deck);
  question.title = fmt::format("Save {} before {} is opened?", open, next);
  question.text = fmt::format(
      "{0} has edits that aren't saved. If you keep them for next time, they come back when {0} is opened again. If you discard them, the "
      "deck stays on disk as it was last saved.",
      open);
  question.choices = unsaved_choices("Go on with " + open);
  trace_.line("asks unsaved " + deck.string());
}

bool DeckFiles::has_unsaved_edits() const {
  if (!link_.connection.connected()) return false;  // nothing can be done about them from here; they are in the journal
  if (link_.edits.under_way()) return true;
  if (const auto& snapshot = link_.document.snapshot()) return snapshot->info().changed || !link_.document.up_to_date();
  return link_.document.state() && link_.document.state()->open && link_.document.state()->changed;
}

void DeckFiles::quit() {
  if (has_unsaved_edits())
    ask_about_quitting();
  else
    quits_ = true;
}

void DeckFiles::ask_about_quitting() {
  about_ = open_deck();
  quitting_ = true;
  const std::string open = file_name(about_);
  Question& question = question_.emplace();
  question.title = fmt::format("Save {} before you quit?", open);
  question.text = fmt::format(
      "{} has edits that aren't saved. If you keep them for next time, they come back with the deck at the next start. If you discard "
      "them, "
      "the deck stays on disk as it was last saved.",
      open);
  question.choices = unsaved_choices("Stay");
  trace_.line("asks quit " + about_);
}

void DeckFiles::reply_about_quitting(Reply reply) {
  const auto quit_if = [this](bool done) { quits_ = quits_ || done; };
  if (reply == Reply::keep) quits_ = true;
  if (reply == Reply::save)
    link_.deck.save(ipc::Save{}, {}, [quit_if](const ipc::Answer& answer) { quit_if(std::holds_alternative<ipc::Saved>(answer)); });
  if (reply == Reply::discard)
    link_.deck.close([quit_if](const ipc::Answer& answer) { quit_if(std::holds_alternative<ipc::Done>(answer)); });
}

void DeckFiles::reply(Reply reply) {
  if (!question_) return;
  question_.reset();
  trace_.line("asks nothing");
  if (std::exchange(quitting_, false)) return reply_about_quitting(reply);
  switch (reply) {
    case Reply::cancel: return;
    case Reply::write: return write(std::exchange(to_write_, {}), remark_);
    case Reply::keep: return link_.deck.open(to_open_, Unsaved::keep);
    case Reply::discard: return link_.deck.open(to_open_, Unsaved::discard);
    case Reply::save:
      link_.deck.save(ipc::Save{}, {}, [this, deck = to_open_](const ipc::Answer& answer) {
        if (std::holds_alternative<ipc::Saved>(answer)) link_.deck.open(deck);
      });
  }
}

void DeckFiles::follow() {
  if (question_ && about_ != open_deck()) reply(Reply::cancel);
  // Another client may have saved the edits meanwhile.
  if (question_ && quitting_ && link_.connection.connected() && !has_unsaved_edits()) {
    reply(Reply::cancel);
    quits_ = true;
  }
  if (const std::optional<std::filesystem::path> refused = link_.deck.take_refused()) ask_about_edits(*refused);
}

}  // namespace prismesh::kiosk::tools::files
