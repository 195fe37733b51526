// What each route does. Knows nothing of sockets.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/intake/access/access.h"
#include "daemon/intake/api/body_taker.h"
#include "daemon/intake/api/event_hub.h"
#include "daemon/intake/api/figures.h"
#include "daemon/intake/api/store_thread.h"
#include "daemon/intake/http/fields.h"
#include "daemon/intake/http/request.h"
#include "daemon/intake/http/routes.h"

namespace prismesh::intake {

/// An answer, work that answers later, or a body that is to be read first.
using Reaction = std::variant<HttpResponse, std::function<void(Respond)>, std::shared_ptr<BodyTaker>>;

struct ApiSettings {
  std::vector<std::string> hosts;  ///< names of the station
  std::uint64_t max_file_bytes = 0;
  std::size_t requests_of_a_token = 16;  ///< at once
};

class Api {
 public:
  Api(std::shared_ptr<StoreThread> store, Access& access, EventHub& events, Figures& figures, ApiSettings settings, WallClock now);

  /// Called by one thread. A refusal comes before anything of the body is read.
  Reaction take(const HttpRequest& request);

 private:
  struct Call {
    const Route* route = nullptr;
    std::vector<std::string> parts;
    std::map<std::string, std::string, std::less<>> query;
    Caller caller;
    bool by_cookie = false;  ///< the token came as a browser's cookie
    std::shared_ptr<void> permit;
  };
  std::optional<HttpResponse> authorise(const HttpRequest& request, const FoundRoute& found, Call& call);
  std::optional<HttpResponse> check_body(const HttpRequest& request, const Route& route) const;
  std::shared_ptr<void> permit_for(const std::string& name);
  Reaction dispatch(const HttpRequest& request, Call call);
  Reaction dispatch_upload(const HttpRequest& request, Call call);
  Reaction dispatch_model(const HttpRequest& request, Call call);

  Reaction pair(const HttpRequest& request);
  Reaction show_token(const Call& call);
  Reaction give_token_up(const Call& call);
  HttpResponse describe_uploads() const;
  Reaction begin_upload(const HttpRequest& request, const Call& call);
  Reaction show_upload(const Call& call);
  Reaction continue_upload(const HttpRequest& request, const Call& call);
  Reaction end_upload(const Call& call);
  Reaction list_models(const Call& call);
  Reaction publish_model(const HttpRequest& request, const Call& call);
  Reaction fetch_file(const HttpRequest& request, const Call& call, const ipc::store::ContentHash& model);
  Reaction follow_events(const Call& call);
  Reaction show_metrics();

  std::shared_ptr<StoreThread> store_;
  Access& access_;
  EventHub& events_;
  Figures& figures_;
  ApiSettings settings_;
  WallClock now_;
  std::shared_ptr<std::mutex> permits_mutex_ = std::make_shared<std::mutex>();
  std::shared_ptr<std::map<std::string, std::size_t>> permits_ = std::make_shared<std::map<std::string, std::size_t>>();
};

}  // namespace prismesh::intake
