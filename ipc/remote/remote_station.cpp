#include "ipc/remote/remote_station.h"

#include <algorithm>
#include <utility>

#include "base/json/write.h"
#include "ipc/intake/pairing_code.h"

namespace prismesh::ipc::remote {

namespace {

constexpr std::size_t kListedAtOnce = 1000;

}  // namespace

Result<PairedStation> pair(const StationAddress& address, std::string_view code, const std::string& name, const Stop& stop) {
  const Result<PairingCode> read = decode_pairing_code(code);
  if (!read) return fail(read.error());
  LineResult<HttpsLine> line = HttpsLine::connect(address, Pin(read->fingerprint.begin(), read->fingerprint.end()), {}, stop);
  if (!line && is_cancelled(line.error().error)) return fail(line.error().error);
  if (!line && !line.error().may_pass)
    return fail(
        address.text(),
        "isn't the station that made this code: the keys differ, and nothing was sent. Compare the address, and type the code again");
  if (!line) return fail(line.error().error);
  json::Json asked = json::Json::object();
  asked["secret"] = encode_pairing_secret(read->secret);
  asked["name"] = name;
  const std::string body = json::to_line(asked);
  const LineResult<HttpsAnswer> answer = line->ask({"POST", "/pair", {{"Content-Type", "application/json"}}, body, true});
  if (!answer) return fail(answer.error().error);
  const std::string sentence = refusal_sentence(answer->body);
  if (answer->status != 200)
    return fail(address.text(), sentence.empty() ? "doesn't pair (status " + std::to_string(answer->status) + ")" : sentence);
  Result<PairAnswer> paired = parse_pair_answer(answer->body);
  if (!paired) return fail(address.text(), paired.error().message);
  return PairedStation{
      address.text(),   address, line->fingerprint(), std::move(paired->token), std::move(paired->name), std::move(paired->scopes),
      paired->expires_s};
}

RemoteStation::RemoteStation(PairedStation station, RemoteOptions options, Stop stop)
    : station_(std::move(station)), options_(options), stop_(stop), retrying_({options.patience, options.first_pause}, std::move(stop)) {}

LineResult<HttpsAnswer> RemoteStation::ask_once(HttpsRequest request, const BodySink& sink,
                                                const std::function<void(std::uint64_t)>& sent) {
  if (!line_ || !line_->is_open()) {
    line_.reset();
    const auto& fingerprint = station_.fingerprint.bytes;
    LineResult<HttpsLine> made = HttpsLine::connect(station_.address, Pin(fingerprint.begin(), fingerprint.end()), options_.line, stop_);
    if (!made) return tl::unexpected(std::move(made.error()));
    line_ = std::move(*made);
  }
  request.headers.emplace_back("Authorization", "Bearer " + station_.token);
  LineResult<HttpsAnswer> answer = line_->ask(request, sink, sent);
  if (!answer) {
    line_.reset();
    return answer;
  }
  if (answer->status == 429 || answer->status == 503) return tl::unexpected(LineFault{refusal(*answer, ""), true});
  line_is_good();
  return answer;
}

Result<HttpsAnswer> RemoteStation::ask(const HttpsRequest& request) {
  for (;;) {
    LineResult<HttpsAnswer> answer = ask_once(request);
    if (answer) return std::move(*answer);
    if (const Result<void> waited = wait_after(answer.error()); !waited) return fail(waited.error());
  }
}

Error RemoteStation::refusal(const HttpsAnswer& answer, const std::string& about) const {
  const std::string sentence = refusal_sentence(answer.body);
  const std::string said = (about.empty() ? "" : about + ": ") + (sentence.empty() ? "status " + std::to_string(answer.status) : sentence);
  const Error error{station_.name, 0, said};
  switch (answer.status) {
    case 401:
      return {station_.name, 0,
              "the token of this computer isn't good any more: it was revoked, or its year is over. Pair again with a new code: prismesh "
              "pair " +
                  station_.name + " CODE"};
    case 403: return {station_.name, 0, said + ". Pair again with a code that allows it: prismesh pair " + station_.name + " CODE"};
    case 507: return {station_.name, 0, said + ". Remove models at the station, or ask for more room there ([remote] in its settings)"};
    default: return error;
  }
}

Result<std::vector<ListedModel>> RemoteStation::models() {
  std::vector<ListedModel> all;
  for (;;) {
    const std::string target = "/models?count=" + std::to_string(kListedAtOnce) + "&skip=" + std::to_string(all.size());
    const Result<HttpsAnswer> answer = ask({"GET", target, {}, {}});
    if (!answer) return fail(answer.error());
    if (answer->status != 200) return fail(refusal(*answer, "the catalogue"));
    Result<std::vector<ListedModel>> some = parse_model_list(answer->body);
    if (!some) return fail(station_.name, some.error().message);
    const std::size_t count = some->size();
    std::move(some->begin(), some->end(), std::back_inserter(all));
    if (count < kListedAtOnce) return all;
  }
}

}  // namespace prismesh::ipc::remote
