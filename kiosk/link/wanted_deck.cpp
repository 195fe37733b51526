#include "kiosk/link/wanted_deck.h"

#include <cstring>
#include <variant>

#include <fmt/format.h>

#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::link {

namespace {
constexpr const char* kStoredPrefix = "stored:";
}  // namespace

std::string stored_name(const std::string& hash) { return kStoredPrefix + hash; }
bool is_stored_name(const std::string& path) { return path.starts_with(kStoredPrefix); }

WantedDeck::WantedDeck(std::optional<std::filesystem::path> deck, Connection& connection, FollowedDocument& document,
                       DocumentNumber& number, LinkNotices& notices, notices::Trace trace)
    : deck_(std::move(deck)), connection_(connection), document_(document), number_(number), notices_(notices), trace_(trace) {
  connection_.add(*this);
}

void WantedDeck::heard(const ipc::Event& event) {
  if (const auto* opened = std::get_if<ipc::DocumentOpened>(&event)) {
    if (!opening_) deck_ = opened->path;
    ask_state();
  }
  if (std::holds_alternative<ipc::DocumentClosed>(event)) {
    deck_.reset();
    ask_state();
  }
}

void WantedDeck::lost() {
  opening_ = false;
  number_.becomes({});
}

void WantedDeck::ask_state() {
  connection_.ask(ipc::GetState{}, [this](const ipc::Answer& answer) {
    if (const auto* state = std::get_if<ipc::DocumentState>(&answer)) took_state(*state);
  });
}

void WantedDeck::took_state(const ipc::DocumentState& state) {
  const bool other = document_.take_state(state);
  if (!state.open) {
    // The server is new: it brings the journal's edits back when it opens the deck. While it opens by itself what was open before, a kiosk
    // that was just started with a deck waits for its turn.
    const bool started = connection_.number() == 1 && document_.number() == 0;
    if (deck_ && !opening_ && (!state.busy || started)) open(*deck_);
    return;
  }
  if (deck_ && deck_->string() != state.path && !document_.snapshot() && !opening_) {
    const std::filesystem::path wanted = *deck_;
    deck_ = state.path;
    open(wanted);
    return;
  }
  if (!opening_) deck_ = state.path;
  document_.follow_state(other);
}

void WantedDeck::open(const std::filesystem::path& deck, Unsaved unsaved) {
  std::error_code ignored;
  const bool stored = is_stored_name(deck.string());
  const std::filesystem::path whole = stored ? deck : std::filesystem::absolute(deck, ignored);
  connection_.progress().begin_opening(stored ? "the model" : whole.filename().string());
  ipc::Open request;
  if (stored)
    request.stored = deck.string().substr(std::strlen(kStoredPrefix));
  else
    request.path = whole.string();
  request.discard = unsaved == Unsaved::discard;
  request.keep = unsaved == Unsaved::keep;
  const std::string kept = unsaved == Unsaved::keep ? std::filesystem::path(number_.path()).filename().string() : std::string();
  opening_ = connection_.connected();
  connection_.ask(request, [this, whole, kept](const ipc::Answer& answer) { took_opened(answer, whole, kept); });
  if (!connection_.connected()) connection_.progress().clear();
}

/// `kept`: the deck whose unsaved edits were kept; empty: none.
void WantedDeck::took_opened(const ipc::Answer& answer, const std::filesystem::path& whole, const std::string& kept) {
  connection_.progress().clear();
  opening_ = false;
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) return not_opened(*failed, whole);
  const auto* state = std::get_if<ipc::DocumentState>(&answer);
  deck_ = state != nullptr ? std::filesystem::path(state->path) : whole;
  document_.opened();
  trace_.line("document " + deck_->string());
  if (!kept.empty()) notices_.say(notice_of_kept_edits(kept));
  if (state != nullptr)
    took_state(*state);
  else
    ask_state();
}

void WantedDeck::not_opened(const ipc::Failed& failed, const std::filesystem::path& whole) {
  if (!was_stopped(failed) && failed.unsaved_edits.value_or(false))
    refused_ = whole;
  else
    say_not_opened(failed, whole);
  if (document_.snapshot()) return;
  // What the server has open instead is shown: nobody could save it unseen.
  deck_.reset();
  ask_state();
}

void WantedDeck::say_not_opened(const ipc::Failed& failed, const std::filesystem::path& whole) {
  notices::Notice notice = notice_of_failed_opening(failed, whole);
  not_opened_ = NotOpened{whole, notice.text};
  notices_.say(std::move(notice));
}

void WantedDeck::close(Then then) {
  connection_.ask(ipc::Close{true}, [this, then = std::move(then)](const ipc::Answer& answer) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) notices_.say(notice_of_failure(*failed, "nothing was discarded"));
    then(answer);
  });
}

void WantedDeck::save(const ipc::Save& request, const std::string& remark, Then then) {
  number_.becomes(request.becomes && request.path ? *request.path : std::string());
  connection_.ask(request, [this, becomes = request.becomes, remark, then = std::move(then)](const ipc::Answer& answer) {
    connection_.progress().clear();
    number_.becomes({});
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) notices_.say(notice_of_failure(*failed, "nothing was saved"));
    if (const auto* saved = std::get_if<ipc::Saved>(&answer)) took_saved(*saved, becomes, remark);
    then(answer);
  });
}

void WantedDeck::took_saved(const ipc::Saved& saved, bool becomes, const std::string& remark) {
  trace_.line(fmt::format("saved {} {}", saved.lines_changed, saved.path));
  if (becomes) {
    number_.rename(saved.path);
    deck_ = saved.path;
  }
  notices_.say(notice_of_saving(saved, remark));
  document_.outdate();
  ask_state();
}

}  // namespace prismesh::kiosk::link
