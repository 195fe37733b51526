// What a user's computer does with stations: pair, push, pull, stations, watch.
#include <array>
#include <cstdlib>
#include <ostream>

#include <unistd.h>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/deck_files.h"
#include "cli/progress_bar.h"
#include "cli/remote_json.h"
#include "cli/report_text.h"
#include "ipc/remote/pull.h"
#include "ipc/remote/push.h"
#include "ipc/remote/watch.h"

namespace prismesh::cli {

namespace {

namespace remote = ipc::remote;

constexpr std::size_t kShortHash = 12;

/// "ann@laptop"
std::string own_name() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0 || host[0] == 0) host = {'h', 'o', 's', 't'};
  const char* user = std::getenv("USER");
  return std::string(user != nullptr && *user != 0 ? user : "user") + "@" + host.data();
}

std::string listed_scopes(const std::vector<std::string>& scopes) {
  std::string text;
  for (const std::string& scope : scopes) text += (text.empty() ? "" : ", ") + printable(scope);
  return text;
}

Result<remote::PairedStation> paired_station(const std::string& wanted) {
  const Result<remote::StationBook> book = remote::StationBook::open();
  if (!book) return fail(book.error());
  return book->find(wanted);
}

int failed(const Context& context, const Error& error) {
  say(context, error);
  return kFailed;
}

/// What stops with the user's Ctrl-C.
remote::RemoteStation asked_by(const remote::PairedStation& station, const Context& context) {
  return {station, {}, [&context] { return context.stop(); }};
}

Result<remote::PairedStation> pair_now(const PairOptions& options, const Context& context) {
  const Result<remote::StationAddress> address = remote::parse_station_address(options.station);
  if (!address) return fail(address.error());
  // The token must not be lost for want of a place to keep it.
  const Result<remote::StationBook> book = remote::StationBook::open();
  if (!book) return fail(book.error());
  if (const auto known = book->stations(); !known) return fail(known.error());
  Result<remote::PairedStation> station =
      remote::pair(*address, options.code, options.name.value_or(own_name()), [&context] { return context.stop(); });
  if (!station) return station;
  if (const Result<void> kept = book->keep(*station); !kept) return fail(kept.error());
  return station;
}

void print_model(std::ostream& out, const remote::ListedModel& model) {
  const ipc::store::ModelRecord& record = model.record;
  out << record.model.hex().substr(0, kShortHash) << "  " << printable(record.name) << ": " << counted(record.files, "file") << ", "
      << counted(record.bytes, "byte") << ", by " << printable(record.who) << ", " << day_and_time(record.when_s) << " UTC";
  if (record.figures)
    out << "; " << counted(record.figures->elements, "element") << ", " << record.figures->warn << " warn, " << record.figures->fail
        << " fail";
  if (record.derived_from) out << "; from " << record.derived_from->hex().substr(0, kShortHash);
  if (model.is_damaged) out << "; damaged at the station, send it again";
  out << '\n';
}

int list_models(const std::string& wanted, const Common& common, const Context& context) {
  const Result<remote::PairedStation> station = paired_station(wanted);
  if (!station) return failed(context, station.error());
  remote::RemoteStation asked = asked_by(*station, context);
  const Result<std::vector<remote::ListedModel>> models = asked.models();
  if (!models) return failed(context, models.error());
  if (common.json) {
    context.out << models_json(station->name, *models) << '\n';
    return kDone;
  }
  for (const remote::ListedModel& model : *models) print_model(context.out, model);
  if (models->empty()) context.out << printable(station->name) << " has no models\n";
  return kDone;
}

/// The station is told too, if it can be reached.
int forget_station(const std::string& name, const Common& common, const Context& context) {
  const Result<remote::StationBook> book = remote::StationBook::open();
  if (!book) return failed(context, book.error());
  const Result<remote::PairedStation> station = book->find(name);
  if (!station) return failed(context, station.error());
  remote::RemoteStation asked = asked_by(*station, context);
  const auto answer = asked.ask_once({"DELETE", "/token", {}, {}});
  const bool is_void = answer && (answer->status == 204 || answer->status == 401);
  if (const Result<void> forgotten = book->forget(station->name); !forgotten) return failed(context, forgotten.error());
  if (!is_void)
    say(context, Error{station->name, 0,
                       "note: it couldn't be told; make the token void there: prismesh intake revoke '" + station->token_name + "'"});
  if (common.json)
    context.out << forgotten_json(station->name, is_void) << '\n';
  else
    context.out << "forgot " << printable(station->name) << '\n';
  return kDone;
}

}  // namespace

int pair(const PairOptions& options, const Common& common, const Context& context) {
  const Result<remote::PairedStation> station = pair_now(options, context);
  if (!station) return failed(context, station.error());
  if (common.json)
    context.out << paired_json(*station) << '\n';
  else
    context.out << "paired with " << printable(station->name) << " as " << printable(station->token_name) << "; may "
                << listed_scopes(station->scopes) << " until " << day_and_time(station->expires_s) << " UTC\n";
  return kDone;
}

int push(const PushOptions& options, const Common& common, const Context& context) {
  const Result<remote::StationBook> book = remote::StationBook::open();
  if (!book) return failed(context, book.error());
  const Result<remote::PairedStation> station = book->find(options.station);
  if (!station) return failed(context, station.error());
  const Result<DeckFiles> files = files_of_deck(options.deck, common, context);
  if (!files) return failed(context, files.error());
  if (files->leaves_folder)
    say(context, Error{options.deck.string(), 0,
                       "note: it includes files outside its folder; the station keeps them, but its sandbox doesn't read them"});
  Result<remote::Pushed> pushed = fail("", "");
  {
    MonotonicClock clock;
    ProgressBar bar(context, "sending " + options.deck.filename().string(), clock);
    remote::PushOptions how;
    how.name = options.name;
    how.progress = bar.progress();
    pushed = remote::push(*book, *station, files->files, files->main, how);
  }
  if (!pushed) return failed(context, pushed.error());
  if (common.json)
    context.out << pushed_json(station->name, *pushed) << '\n';
  else if (pushed->was_there)
    context.out << printable(station->name) << " has it already: model " << pushed->model.record.model.hex() << '\n';
  else
    context.out << "pushed " << printable(pushed->model.record.name) << " to " << printable(station->name) << ": model "
                << pushed->model.record.model.hex() << ", " << counted(pushed->model.record.files, "file") << ", "
                << counted(pushed->model.record.bytes, "byte") << '\n';
  return kDone;
}

int pull(const PullOptions& options, const Common& common, const Context& context) {
  const Result<remote::PairedStation> station = paired_station(options.station);
  if (!station) return failed(context, station.error());
  Result<remote::Pulled> pulled = fail("", "");
  {
    MonotonicClock clock;
    ProgressBar bar(context, "fetching " + printable(options.model), clock);
    remote::PullOptions how;
    how.folder = options.output;
    how.progress = bar.progress();
    pulled = remote::pull(*station, options.model, how);
  }
  if (!pulled) return failed(context, pulled.error());
  if (common.json)
    context.out << pulled_json(station->name, *pulled) << '\n';
  else
    context.out << "pulled " << printable(pulled->model.record.name) << " from " << printable(station->name) << ": "
                << printable(pulled->main.string()) << ", " << counted(pulled->model.record.files, "file") << ", "
                << counted(pulled->model.record.bytes, "byte") << '\n';
  return kDone;
}

int stations(const StationsOptions& options, const Common& common, const Context& context) {
  if (options.action == StationsOptions::Action::models) return list_models(options.station, common, context);
  if (options.action == StationsOptions::Action::forget) return forget_station(options.station, common, context);
  const Result<remote::StationBook> book = remote::StationBook::open();
  if (!book) return failed(context, book.error());
  const Result<std::vector<remote::PairedStation>> known = book->stations();
  if (!known) return failed(context, known.error());
  if (common.json) {
    context.out << stations_json(*known) << '\n';
    return kDone;
  }
  for (const remote::PairedStation& station : *known)
    context.out << printable(station.name) << ": as " << printable(station.token_name) << "; may " << listed_scopes(station.scopes)
                << " until " << day_and_time(station.expires_s) << " UTC\n";
  if (known->empty()) context.out << "this computer is paired with no station; pair it: prismesh pair STATION CODE\n";
  return kDone;
}

int watch(const WatchOptions& options, const Common& common, const Context& context) {
  const Result<remote::PairedStation> station = paired_station(options.station);
  if (!station) return failed(context, station.error());
  remote::RemoteStation asked = asked_by(*station, context);
  const auto connected = [&] {
    if (!common.json) context.out << "follows " << printable(station->name) << std::endl;
  };
  const auto heard = [&](const remote::CatalogueEvent& event) {
    const auto model = remote::model_of_event(event);
    const std::string hash = model ? model->hex() : "";
    const Result<remote::ListedModel> listed = remote::parse_listed_model(event.data);
    if (common.json)
      context.out << event_json(event.kind, hash) << std::endl;
    else
      context.out << printable(event.kind) << " " << hash << (listed ? "  " + printable(listed->record.name) : "") << std::endl;
  };
  if (const Result<void> watched = remote::watch(asked, connected, heard); !watched) return failed(context, watched.error());
  return kDone;
}

}  // namespace prismesh::cli
