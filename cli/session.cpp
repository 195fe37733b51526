// A client of modeld: shows and edits the open document, from scripts or by hand. Continues when the daemon was restarted meanwhile.
#include <filesystem>
#include <ostream>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/edit_list.h"
#include "cli/json_output.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "cli/temporary_folder.h"
#include "ipc/model/client.h"
#include "ipc/model/messages_json.h"
#include "ipc/wire/failure.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/quality/criteria.h"

namespace prismesh::cli {

namespace {

namespace document = mesh::document;
using SessionAction = SessionOptions::Action;

/// How long a daemon may take to restart. systemd restarts it in well under a second; it answers while it still reads a large deck.
constexpr std::chrono::seconds kPatience{15};
constexpr std::chrono::seconds kFirstPatience{5};
constexpr std::chrono::milliseconds kTurn{100};
/// How long work may take to stop: in a large model on a busy machine it checks every few seconds only.
constexpr std::int64_t kPatienceWithCancel_ns = 30'000'000'000;

class Session {
 public:
  Session(const SessionOptions& options, const Context& context)
      : socket_(ipc::model_socket_path(options.runtime_directory)), client_(socket_, "prismesh session"), context_(context) {}

  const std::filesystem::path& socket() const { return socket_; }

  /// Connects. Without a socket it fails at once; else it waits for the daemon. A daemon that ends in order removes its socket, so a socket
  /// without a listener belongs to one that may be restarting.
  Result<ipc::Client*> connected() {
    std::error_code problem;
    if (client_.connections() > 0) return client_.wait(kPatience);
    return client_.wait(std::filesystem::exists(socket_, problem) ? kFirstPatience : std::chrono::seconds(0));
  }

  /// Sends a request and waits for its answer with a progress bar, until the user stops it. Sets `lost` if the daemon ended.
  Result<ipc::Answer> ask(const ipc::Request& request, const std::string& what, bool* lost = nullptr) {
    const Result<ipc::Client*> client = connected();
    if (!client) return fail(client.error());
    const auto gone = [&](const Error& error) -> tl::unexpected<Error> {
      client_.lost(error);
      if (lost != nullptr) *lost = true;
      return fail(error);
    };
    const Result<std::uint64_t> number = (*client)->send(request);
    if (!number) return gone(number.error());
    MonotonicClock clock;
    ProgressBar bar(context_, what, clock);
    const Progress progress = bar.progress();
    std::optional<std::int64_t> stopped_ns;
    for (;;) {
      while (auto reply = (*client)->next_reply())
        if (reply->request == *number) return unfailed(std::move(reply->answer));
      while (const auto event = (*client)->next_event())
        if (const auto* made = std::get_if<ipc::ProgressMade>(&*event); made != nullptr)
          progress(
              made->fraction, made->doing.empty() ? Doing() : [made] { return made->doing; });
      if (context_.stop()) {
        if (!stopped_ns) {
          stopped_ns = clock.now_ns();
          if (const Result<std::uint64_t> sent = (*client)->send(ipc::Cancel{}); !sent) return gone(sent.error());
        }
        if (clock.now_ns() - *stopped_ns > kPatienceWithCancel_ns) return fail("", "stopped waiting; the request may still be carried out");
      }
      if (const Result<void> polled = (*client)->poll(kTurn); !polled) return gone(polled.error());
    }
  }

  /// As `ask`, for requests that may be sent twice.
  Result<ipc::Answer> ask_again(const ipc::Request& request, const std::string& what) {
    bool lost = false;
    Result<ipc::Answer> answer = ask(request, what, &lost);
    return !answer && lost ? ask(request, what) : answer;
  }

  /// The state, after a restarted daemon has opened its document again.
  Result<ipc::DocumentState> state() {
    for (;;) {
      const Result<ipc::Answer> answer = ask_again(ipc::GetState{}, "waiting");
      if (!answer) return fail(answer.error());
      const auto* state = std::get_if<ipc::DocumentState>(&*answer);
      if (state == nullptr) return fail("", "the daemon's answer isn't a state");
      if (state->open || !state->busy) return *state;
      if (context_.stop()) return fail("", "stopped");
      (void)(*connected())->poll(kTurn);
    }
  }

  /// Applies an edit exactly once, even if the daemon ends in between: the journal then shows whether the edit was done.
  Result<document::EditReport> edit(const document::Edit& edit) {
    const Result<ipc::DocumentState> before = state();
    if (!before) return fail(before.error());
    bool lost = false;
    Result<ipc::Answer> answer = ask(ipc::ApplyEdit{edit}, std::string(name(edit)), &lost);
    if (!answer && lost) {
      const Result<ipc::DocumentState> after = state();
      if (!after) return fail(after.error());
      if (after->path != before->path) return fail(after->path, "the daemon was restarted with another document");
      if (after->journalled_edits == before->journalled_edits + 1) {
        document::EditReport report;
        report.edit = name(edit);
        report.before = before->counts;
        report.after = after->counts;
        report.notes.push_back(
            "the daemon ended after this edit and was restarted; the edit is done, but how many nodes it moved isn't known");
        return report;
      }
      if (after->journalled_edits != before->journalled_edits)
        return fail(after->path, "the daemon ended while others were editing too: check whether the edit was done");
      answer = ask(ipc::ApplyEdit{edit}, std::string(name(edit)));
    }
    if (!answer) return fail(std::move(answer.error()));
    auto* edited = std::get_if<ipc::Edited>(&*answer);
    if (edited == nullptr) return fail("", "the daemon's answer isn't a report");
    return std::move(edited->report);
  }

 private:
  static Result<ipc::Answer> unfailed(ipc::Answer answer) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) return fail(ipc::error_from(*failed));
    return answer;
  }

  std::filesystem::path socket_;
  ipc::ReconnectingClient client_;
  const Context& context_;
};

void print_state(std::ostream& out, const Context& context, const ipc::DocumentState& state) {
  if (!state.open) {
    out << (state.busy ? "a deck is being opened\n" : "no document is open\n");
    return;
  }
  out << printable(state.path) << ": " << state.nodes << " nodes, " << state.shells << " shells, " << state.parts << " parts; "
      << state.selected_nodes << " nodes selected\n"
      << "quality: " << state.counts.ok << " ok, " << state.counts.warn << " warn, " << state.counts.fail << " fail; length unit "
      << state.length_unit << (state.length_unit_guessed ? " (guessed)" : "") << ", target size " << shortest(state.target_size)
      << (state.target_size_guessed ? " (guessed)" : "") << '\n'
      << (state.changed ? "unsaved edits" : "no unsaved edits") << (state.can_undo ? ", undo" : "") << (state.can_redo ? ", redo" : "")
      << "; " << state.recovered_edits << " edits were recovered from the journal at opening\n";
  say_warnings(context, state.warnings);
}

void print_saved(std::ostream& out, const Context& context, const ipc::Saved& saved) {
  out << "saved " << printable(saved.path) << ": ";
  // Edits that only add or remove write no moved nodes.
  if (saved.nodes_written > 0 || saved.lines_changed == 0) out << counted(saved.nodes_written, "node") << " written, ";
  out << counted(saved.lines_changed, "line") << " changed\n";
  for (const std::string& note : saved.notes) say(context, Error{saved.path, 0, "note: " + note});
}

std::string whole_path(const std::filesystem::path& path) {
  std::error_code problem;
  const std::filesystem::path whole = std::filesystem::absolute(path, problem);
  return (problem ? path : whole).string();
}

ipc::Open open_request(const SessionOptions& options, const Common& common) {
  ipc::Open open;
  open.stored = options.stored;
  if (options.stored.empty()) open.path = whole_path(options.deck);
  open.discard = options.discard;
  open.keep = options.keep;
  open.sandboxed = options.sandboxed;
  if (common.length_unit) open.length_unit = std::string(name(*common.length_unit));
  open.rules = common.rules;
  for (document::JudgingRule& rule : open.rules)
    if (rule.criteria && !mesh::quality::is_built_in_criteria(*rule.criteria)) rule.criteria = whole_path(*rule.criteria);
  return open;
}

int edit_all(Session& session, const std::vector<WantedEdit>& wanted, const Common& common, const Context& context) {
  for (const WantedEdit& one : wanted) {
    const Result<document::EditReport> report = session.edit(one.edit);
    if (!report) {
      if (common.json) context.out << failed_edit_json(std::string(name(one.edit)), report.error().text()) << '\n';
      say(context, report.error().file.empty() ? Error{one.file, one.line, report.error().message} : report.error());
      return kFailed;
    }
    if (common.json)
      context.out << edit_json(*report) << '\n';
    else
      print_edit(context.out, *report);
    if (context.stop() && report->stopped) {
      say(context, Error{one.file, one.line, "stopped in the middle of this edit; what was reached is kept"});
      return kFailed;
    }
  }
  return kDone;
}

/// The last states up to the current one, at most as many as edits are in the journal.
std::vector<std::string> edits_done(const ipc::DocumentState& state) {
  std::vector<std::string> done;
  for (const ipc::ListedGeneration& each : state.generations)
    if (each.number <= state.generation && each.number != state.generations.front().number) done.push_back(each.made_by);
  const std::uint64_t journalled = state.journalled_edits + state.recovered_edits;
  if (done.size() > journalled) done.erase(done.begin(), done.end() - static_cast<std::ptrdiff_t>(journalled));
  return done;
}

/// Has the document saved as a copy, and writes the page from the deck before and this copy.
int report_document(Session& session, const SessionOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<ipc::DocumentState> state = session.state();
  if (!state) return refuse(state.error());
  if (!state->open) return refuse({"prismesh session", 0, "no document is open"});
  if (!state->changed && !options.before) return refuse({state->path, 0, "has no unsaved edits: name the deck before them with --before"});
  if (!state->stored.empty())
    return refuse({state->path, 0, "comes from the store, and nobody vouches for it: a report reads decks outside the sandbox"});
  struct stat socket {};
  if (::stat(session.socket().c_str(), &socket) == 0 && socket.st_uid != ::geteuid())
    return refuse({session.socket().string(), 0,
                   "belongs to another user, who can't save a copy for this one: save the document, and use prismesh report"});
  std::error_code unlike;
  if (std::filesystem::equivalent(state->path, *options.output, unlike) && !unlike)
    return refuse({options.output->string(), 0, "is the open deck, and would be replaced: name another file with -o"});
  const Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder) return refuse(folder.error());
  ipc::Save copy;
  copy.path = (folder->path() / std::filesystem::path(state->path).filename()).string();
  copy.stays_unsaved = true;
  if (const Result<ipc::Answer> saved = session.ask_again(copy, "saving a copy"); !saved) return refuse(saved.error());
  ReportOptions wanted;
  wanted.a = options.before.value_or(state->path);
  wanted.b = *copy.path;
  wanted.output = *options.output;
  wanted.done = edits_done(*state);
  Common judged = common;  // as the document is
  if (!common.length_unit && !state->length_unit_guessed) judged.length_unit = length_unit_from(state->length_unit);
  if (common.rules.empty() && !state->target_size_guessed) judged.rules.push_back({{}, state->target_size, {}, {}, 0});
  return report(wanted, judged, context);
}

}  // namespace

int session(const SessionOptions& options, const Common& common, const Context& context) {
  std::vector<WantedEdit> wanted;
  if (options.action == SessionAction::undo) wanted.push_back({document::Undo{}, "undo", 0});
  if (options.action == SessionAction::redo) wanted.push_back({document::Redo{}, "redo", 0});
  if (const auto refusal = read_edits(options.edits, "EDIT", options.script, wanted)) {
    say(context, refusal->error);
    return refusal->status;
  }
  if (options.keep_on_cancel) keep_on_cancel(wanted);
  Session session(options, context);
  Result<ipc::Answer> answer = ipc::Done{};
  switch (options.action) {
    case SessionAction::edit:
    case SessionAction::undo:
    case SessionAction::redo: return edit_all(session, wanted, common, context);
    case SessionAction::report: return report_document(session, options, common, context);
    case SessionAction::open:
      answer = session.ask_again(open_request(options, common), "reading " + options.deck.filename().string());
      break;
    case SessionAction::state: {
      Result<ipc::DocumentState> state = session.state();
      answer = state ? Result<ipc::Answer>(std::move(*state)) : fail(state.error());
      break;
    }
    case SessionAction::save: {
      ipc::Save save;
      if (options.output) save.path = whole_path(*options.output);
      answer = session.ask_again(save, "saving");
      break;
    }
    case SessionAction::close: answer = session.ask(ipc::Close{options.discard, options.keep}, "closing"); break;
  }
  if (!answer) {
    say(context, answer.error());
    return kFailed;
  }
  if (common.json)
    context.out << ipc::answer_fields(*answer) << '\n';
  else if (const auto* state = std::get_if<ipc::DocumentState>(&*answer))
    print_state(context.out, context, *state);
  else if (const auto* saved = std::get_if<ipc::Saved>(&*answer))
    print_saved(context.out, context, *saved);
  return kDone;
}

}  // namespace prismesh::cli
