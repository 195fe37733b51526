#include <ostream>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/deck/save.h"
#include "mesh/document/journal.h"

namespace prismesh::cli {

namespace {

namespace document = mesh::document;

void print_text(std::ostream& out, const std::vector<document::ReplayStep>& steps) {
  std::size_t applied = 0;
  for (const document::ReplayStep& step : steps) {
    applied += step.applied;
    out << "line " << step.line << ": " << step.edit << (step.applied ? ": " : " not applied: ");
    if (step.applied)
      out << change_words(step.report) << '\n';
    else
      out << printable(step.message) << '\n';
  }
  out << applied << " of " << steps.size() << " edits applied\n";
}

std::vector<document::ReplayStep> replay_watched(document::Document& document, const document::JournalIntents& intents,
                                                 const ReplayOptions& options, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "replaying " + options.journal.filename().string(), clock);
  return document::replay(document, intents, bar.progress(), &clock);
}

}  // namespace

// An edit that doesn't fit a variant is a warning; the others are applied. If none fits, nothing is written.
int replay(const ReplayOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  bool is_not_json = false;
  const Result<document::JournalIntents> intents = document::read_intents(options.journal, &is_not_json);
  if (!intents) {
    say(context, intents.error());
    return is_not_json ? kWrongUsage : kFailed;
  }
  Result<document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  say_warnings(context, *document);
  say_guesses(context, *document);
  const std::string journal = options.journal.string();
  if (intents->damage)
    say(context, Error{intents->damage->file, intents->damage->line,
                       "warning: " + intents->damage->message + "; only the edits before it are replayed"});
  if (intents->torn_tail) say(context, Error{journal, 0, "warning: the last record is incomplete and left out"});
  const bool other_deck = !intents->deck_hash.empty() && intents->deck_hash != document->deck->content.hex();
  if (other_deck) say(context, Error{journal, 0, "note: made on another deck, " + intents->deck_path});

  const std::vector<document::ReplayStep> steps = replay_watched(*document, *intents, options, context);
  if (context.stop()) return refuse({journal, 0, "cancelled; nothing is written"});
  std::size_t applied = 0;
  for (const document::ReplayStep& step : steps) {
    applied += step.applied;
    if (!step.applied) say(context, Error{journal, step.line, "warning: this " + step.edit + " was not applied: " + step.message});
  }
  if (common.json)
    context.out << replay_json(steps, intents->deck_hash, other_deck) << '\n';
  else
    print_text(context.out, steps);
  if (applied == 0 && !steps.empty()) return refuse({journal, 0, "no edit could be applied; nothing is written"});
  if (!output_is_good(context)) return kFailed;
  const Result<mesh::deck::SaveReport> saved = save_deck(*document, options.output, context);
  if (!saved) return refuse(saved.error());
  for (const std::string& note : saved->notes) say(context, Error{options.output.string(), 0, "note: " + note});
  return kDone;
}

}  // namespace prismesh::cli
