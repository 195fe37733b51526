// A paired station, asked by this user's token; cut lines are made again.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/remote/answers.h"
#include "ipc/remote/https.h"
#include "ipc/remote/station_book.h"
#include "ipc/wire/retrying.h"

namespace prismesh::ipc::remote {

struct RemoteOptions {
  LinePatience line;
  /// How long the line may stay cut, without a request that is answered.
  std::chrono::milliseconds patience{60'000};
  std::chrono::milliseconds first_pause{200};  ///< before another try; each is twice as long as the last, up to 5 s
};

/// Pairs by the code that the station shows. `name`: of this computer, for the station. Errors: the code can't be read, has another
/// certificate's fingerprint, or isn't good any more; nobody answers.
Result<PairedStation> pair(const StationAddress& address, std::string_view code, const std::string& name, const Stop& stop);

class RemoteStation {
 public:
  RemoteStation(PairedStation station, RemoteOptions options, Stop stop);

  const PairedStation& station() const { return station_; }

  /// One try. What the station refuses for a while only (429, 503) is a fault that passes.
  LineResult<HttpsAnswer> ask_once(HttpsRequest request, const BodySink& sink = {}, const std::function<void(std::uint64_t)>& sent = {});
  /// As often as needed: only for requests that may come twice. Errors: a fault that doesn't pass, or for longer than the patience.
  Result<HttpsAnswer> ask(const HttpsRequest& request);
  /// Waits before another try. Errors: `fault` doesn't pass, the patience is over, the user stopped it.
  Result<void> wait_after(const LineFault& fault) { return retrying_.wait_after(fault); }
  /// An answer that goes on for long has begun: what follows is another cut.
  void line_is_good() { retrying_.line_is_good(); }
  bool is_stopped() const { return retrying_.is_stopped(); }

  /// What the answer's status says, as a sentence that says what to do. `about`: what was asked for.
  Error refusal(const HttpsAnswer& answer, const std::string& about) const;

  /// All models of the catalogue, the newest first. Errors: as `ask`; refused.
  Result<std::vector<ListedModel>> models();

 private:
  PairedStation station_;
  RemoteOptions options_;
  Stop stop_;
  std::optional<HttpsLine> line_;
  Retrying retrying_;
};

}  // namespace prismesh::ipc::remote
