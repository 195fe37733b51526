#include "daemon/intake/api/api.h"

#include <utility>

#include "base/json/write.h"
#include "daemon/intake/api/body_takers.h"
#include "daemon/intake/api/model_answers.h"
#include "daemon/intake/api/openapi.h"
#include "daemon/intake/api/page.h"
#include "daemon/intake/api/pair_request.h"
#include "daemon/intake/api/refusal.h"
#include "daemon/intake/api/tus.h"
#include "daemon/intake/http/checks.h"

namespace prismesh::intake {

namespace {

using ipc::store::ContentHash;

bool takes_query(Operation operation) { return operation == Operation::list_models; }

json::Json token_json(const TokenRecord& token) {
  json::Json object = json::Json::object();
  object["name"] = token.name;
  object["scopes"] = scope_names(token.scopes);
  object["expires_s"] = token.expires_s;
  return object;
}

}  // namespace

Api::Api(std::shared_ptr<StoreThread> store, Access& access, EventHub& events, Figures& figures, ApiSettings settings, WallClock now)
    : store_(std::move(store)), access_(access), events_(events), figures_(figures), settings_(std::move(settings)), now_(std::move(now)) {}

std::shared_ptr<void> Api::permit_for(const std::string& name) {
  const std::lock_guard lock(*permits_mutex_);
  std::size_t& count = (*permits_)[name];
  if (count >= settings_.requests_of_a_token) return nullptr;
  ++count;
  return {new int(0), [mutex = permits_mutex_, permits = permits_, name](void* held) {
            delete static_cast<int*>(held);
            const std::lock_guard release(*mutex);
            if (--(*permits)[name] == 0) permits->erase(name);
          }};
}

/// Who isn't known learns nothing of which paths there are.
std::optional<HttpResponse> Api::authorise(const HttpRequest& request, const FoundRoute& found, Call& call) {
  if (found.route != nullptr && found.route->access == Route::Access::everybody) return std::nullopt;
  const std::optional<std::string_view> header = request.header("authorization");
  const std::optional<std::string_view> cookie = request.header("cookie");
  call.by_cookie = !header && cookie;
  const std::optional<std::string_view> token = header ? parse_bearer(*header) : cookie ? parse_session_cookie(*cookie) : std::nullopt;
  if (!token) return unauthorised();
  tl::expected<Caller, Denial> caller = access_.caller_of(*token);
  if (!caller) return caller.error() == Denial::unknown ? unauthorised() : too_many();
  call.caller = std::move(*caller);
  if (call.by_cookie)
    if (std::optional<HttpResponse> refused = check_browser(request)) return refused;
  if (found.route == nullptr && found.allowed.empty()) return error_response(404, "there is no such path");
  if (found.route == nullptr) {
    HttpResponse response = error_response(405, "this path takes " + found.allowed);
    response.headers.emplace_back("Allow", found.allowed);
    return response;
  }
  if (found.route->scope && !call.caller.scopes.has(*found.route->scope))
    return error_response(403,
                          "this token lacks the right '" + std::string(kScopeNames[static_cast<std::size_t>(*found.route->scope)]) + "'");
  call.permit = permit_for(call.caller.name);
  if (!call.permit) return too_many();
  return std::nullopt;
}

std::optional<HttpResponse> Api::check_body(const HttpRequest& request, const Route& route) const {
  const std::uint64_t bytes = request.body_bytes.value_or(0);
  if (route.max_body == 0) {
    if (bytes == 0) return std::nullopt;
    return error_response(413, "this request has no body");
  }
  if (!request.body_bytes) return error_response(411, "a body must come with its length (Content-Length)");
  if (bytes > route.max_body) return error_response(413, "the body may have " + std::to_string(route.max_body) + " bytes");
  if (request.header("content-type") != route.body_type)
    return error_response(415, "the body must be " + std::string(route.body_type) + " (Content-Type)");
  return std::nullopt;
}

Reaction Api::take(const HttpRequest& request) {
  ++figures_.requests;
  if (std::optional<HttpResponse> refused = check_request(request, settings_.hosts)) return std::move(*refused);
  Result<Target> target = parse_target(request.target);
  if (!target) return error_response(400, target.error().message);
  const FoundRoute found = find_route(request.method, target->path);
  Call call;
  if (std::optional<HttpResponse> refused = authorise(request, found, call)) return std::move(*refused);
  if (!target->query.empty() && !takes_query(found.route->operation)) return error_response(400, "this path takes no query");
  if (std::optional<HttpResponse> refused = check_body(request, *found.route)) return std::move(*refused);
  if (needs_tus_version(found.route->operation))
    if (std::optional<HttpResponse> refused = check_tus_version(request)) return std::move(*refused);
  call.route = found.route;
  call.parts.assign(found.parts.begin(), found.parts.end());
  call.query = std::move(target->query);
  return dispatch(request, std::move(call));
}

Reaction Api::dispatch(const HttpRequest& request, Call call) {
  switch (call.route->operation) {
    case Operation::health: return json_response("{\"status\": \"ok\"}\n");
    case Operation::show_page: return page_response(call.route->path);
    case Operation::pair: return pair(request);
    case Operation::describe_uploads: return describe_uploads();
    case Operation::begin_upload:
    case Operation::show_upload:
    case Operation::continue_upload:
    case Operation::end_upload: return dispatch_upload(request, std::move(call));
    case Operation::list_models: return list_models(call);
    case Operation::publish_model: return publish_model(request, call);
    case Operation::show_model:
    case Operation::remove_model:
    case Operation::fetch_manifest:
    case Operation::fetch_file:
    case Operation::fetch_thumbnail: return dispatch_model(request, std::move(call));
    case Operation::follow_events: return follow_events(call);
    case Operation::show_token: return show_token(call);
    case Operation::give_token_up: return give_token_up(call);
    case Operation::show_metrics: return show_metrics();
    case Operation::describe_api: return json_response(std::string(openapi_text()));
  }
  return error_response(500, "no such operation");
}

// --- pairing ---

Reaction Api::pair(const HttpRequest& request) {
  // A cookie goes to the station's own page only.
  const bool may_have_cookie = !check_browser(request);
  return std::make_shared<SmallBody>([this, may_have_cookie](std::string body, const Respond& respond) {
    const Result<PairRequest> asked = parse_pair_request(body);
    if (!asked) return respond(error_response(400, asked.error().message));
    if (asked->cookie && !may_have_cookie) return respond(error_response(403, "a cookie is for the station's own page"));
    store_->run([this, asked = *asked, respond](Store&) {
      const Result<NewToken> made = access_.pair(asked.secret, asked.name);
      if (!made) return respond(error_response(403, made.error().text()));
      json::Json answer = token_json(made->record);
      if (!asked.cookie) answer["token"] = made->token;
      HttpResponse response = json_response(json::to_line(answer) + "\n");
      if (asked.cookie)
        response.headers.emplace_back("Set-Cookie", session_cookie(made->token, made->record.expires_s - made->record.made_s));
      respond(std::move(response));
    });
  });
}

Reaction Api::show_token(const Call& call) {
  for (const TokenRecord& token : access_.tokens())
    if (token.hash == call.caller.token) return json_response(json::to_line(token_json(token)) + "\n");
  return unauthorised();
}

Reaction Api::give_token_up(const Call& call) {
  return [this, call](const Respond& respond) {
    store_->run([this, call, respond](Store&) {
      const Result<void> revoked = access_.revoke(call.caller.name);
      if (!revoked) return respond(error_response(500, "the token couldn't be revoked"));
      HttpResponse response = no_content();
      if (call.by_cookie) response.headers.emplace_back("Set-Cookie", session_cookie("", 0));
      respond(std::move(response));
    });
  };
}

// --- uploads ---

HttpResponse Api::describe_uploads() const { return tus_description(settings_.max_file_bytes); }

Reaction Api::dispatch_upload(const HttpRequest& request, Call call) {
  switch (call.route->operation) {
    case Operation::begin_upload: return begin_upload(request, call);
    case Operation::show_upload: return show_upload(call);
    case Operation::continue_upload: return continue_upload(request, call);
    default: return end_upload(call);
  }
}

Reaction Api::begin_upload(const HttpRequest& request, const Call& call) {
  Result<NewUpload> asked = parse_new_upload(request, call.caller.name);
  if (!asked) return error_response(400, asked.error().text());
  return [this, asked = std::move(*asked), call](const Respond& respond) {
    store_->run([asked, call, respond, now_s = now_()](Store& store) {
      const Outcome<UploadStatus> begun = store.begin_upload(asked);
      if (!begun) return respond(refusal_response(begun.error()));
      HttpResponse response = upload_response(201, *begun, now_s);
      response.headers.emplace_back("Location", "/uploads/" + begun->id);
      respond(std::move(response));
    });
  };
}

Reaction Api::show_upload(const Call& call) {
  return [this, call](const Respond& respond) {
    store_->run([call, respond, now_s = now_()](Store& store) {
      const Outcome<UploadStatus> status = store.uploads().status(call.caller.name, call.parts[0]);
      if (!status) return respond(refusal_response(status.error()));
      respond(shown_upload(*status, now_s));
    });
  };
}

Reaction Api::continue_upload(const HttpRequest& request, const Call& call) {
  const std::optional<std::string_view> offset_header = request.header("upload-offset");
  const std::optional<std::uint64_t> offset = offset_header ? parse_size(*offset_header) : std::nullopt;
  if (!offset) return error_response(400, "Upload-Offset must say where the chunk begins");
  std::optional<Checksum> checksum;
  if (const auto header = request.header("upload-checksum")) {
    Result<Checksum> parsed = parse_checksum(*header);
    if (!parsed) return error_response(400, parsed.error().text());
    checksum = std::move(*parsed);
  }
  return std::make_shared<ChunkBody>(store_, access_, figures_, now_, call.caller, call.permit, call.parts[0], *offset,
                                     std::move(checksum));
}

Reaction Api::end_upload(const Call& call) {
  return [this, call](const Respond& respond) {
    store_->run([call, respond](Store& store) {
      const Outcome<void> ended = store.uploads().terminate(call.caller.name, call.parts[0]);
      HttpResponse response = ended ? no_content() : refusal_response(ended.error());
      response.headers.emplace_back("Tus-Resumable", kTusVersion);
      respond(std::move(response));
    });
  };
}

// --- models ---

Reaction Api::list_models(const Call& call) {
  const Result<CatalogueQuery> query = parse_catalogue_query(call.query);
  if (!query) return error_response(400, query.error().text());
  return [this, query = *query, call](const Respond& respond) {
    store_->run([query, call, respond](Store& store) {
      const Outcome<std::vector<CatalogueEntry>> found = store.list(query);
      respond(found ? json_response(models_json(*found)) : refusal_response(found.error()));
    });
  };
}

Reaction Api::publish_model(const HttpRequest& request, const Call& call) {
  Result<Publication> asked = parse_publication(request);
  if (!asked) return error_response(400, asked.error().text());
  asked->who = call.caller.name;
  asked->may_use_stored = call.caller.scopes.has(Scope::read);
  return std::make_shared<SmallBody>([this, asked = std::move(*asked), call](std::string manifest, const Respond& respond) {
    store_->run([this, asked, call, respond, manifest = std::move(manifest)](Store& store) mutable {
      // The right may have gone since the request began.
      if (!access_.still_may(call.caller, Scope::upload)) return respond(unauthorised());
      asked.manifest = std::move(manifest);
      asked.when_s = now_();
      const Outcome<ipc::store::ModelRecord> record = store.publish(asked);
      if (!record) return respond(refusal_response(record.error()));
      ++figures_.published;
      access_.note(call.caller.name, "published", record->model.hex());
      const std::string text = model_json({*record, false});
      events_.tell("published", record->model, text);
      HttpResponse response = json_response(text + "\n", 201);
      response.headers.emplace_back("Location", "/models/" + record->model.hex());
      respond(std::move(response));
    });
  });
}

Reaction Api::dispatch_model(const HttpRequest& request, Call call) {
  const std::optional<ContentHash> model = ipc::store::parse_content_hash(call.parts[0]);
  if (!model) return error_response(404, "there is no such model");
  if (call.route->operation == Operation::fetch_file) return fetch_file(request, call, *model);
  return [this, call, model = *model](const Respond& respond) {
    store_->run([this, call, model, respond](Store& store) {
      if (call.route->operation == Operation::remove_model) {
        if (!access_.still_may(call.caller, Scope::remove)) return respond(unauthorised());
        const Outcome<void> removed = store.remove(model);
        if (!removed) return respond(refusal_response(removed.error()));
        access_.note(call.caller.name, "removed", model.hex());
        events_.tell("removed", model, "{\"model\": \"" + model.hex() + "\"}");
        return respond(no_content());
      }
      const Outcome<ipc::store::FoundModel> found = store.find(model);
      if (!found) return respond(refusal_response(found.error()));
      if (call.route->operation == Operation::show_model) return respond(json_response(found_model_json(*found) + "\n"));
      if (call.route->operation == Operation::fetch_manifest) return respond(manifest_response(*found));
      respond(thumbnail_response(store, *found));
    });
  };
}

Reaction Api::fetch_file(const HttpRequest& request, const Call& call, const ContentHash& model) {
  const std::optional<ContentHash> file = ipc::store::parse_content_hash(call.parts[1]);
  if (!file) return error_response(404, "there is no such file");
  const FileConditions conditions = file_conditions(request);
  return [this, call, model, file = *file, conditions](const Respond& respond) {
    store_->run([call, model, file, conditions, respond](Store& store) {
      const Outcome<ipc::store::FoundModel> found = store.find(model);
      if (!found) return respond(refusal_response(found.error()));
      HttpResponse response = file_response(store, *found, file, conditions);
      response.permit = call.permit;
      respond(std::move(response));
    });
  };
}

// --- the rest ---

Reaction Api::follow_events(const Call& call) {
  const std::optional<std::uint64_t> follower = events_.follow(call.caller);
  if (!follower) return too_many();
  return HttpResponse{
      200, {{"Content-Type", "text/event-stream"}, {"Cache-Control", "no-store"}}, EventBody{*follower}, std::nullopt, nullptr};
}

Reaction Api::show_metrics() {
  return [this](const Respond& respond) {
    store_->run([this, respond](Store& store) {
      const Outcome<StoreFigures> figures = store.figures();
      if (!figures) return respond(refusal_response(figures.error()));
      respond(metrics_response(*figures, figures_, events_.count()));
    });
  };
}

}  // namespace prismesh::intake
