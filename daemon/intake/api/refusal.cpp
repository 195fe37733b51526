#include "daemon/intake/api/refusal.h"

#include "base/log.h"

namespace prismesh::intake {

HttpResponse unauthorised() {
  HttpResponse response = error_response(401, "a token is needed (Authorization: Bearer ..); pair this client with the station");
  response.headers.emplace_back("WWW-Authenticate", "Bearer");
  return response;
}

HttpResponse too_many() {
  HttpResponse response = error_response(429, "too many requests; wait a little");
  response.headers.emplace_back("Retry-After", "1");
  return response;
}

HttpResponse no_content() { return {204, {}, std::string(), std::nullopt, nullptr}; }

HttpResponse refusal_response(const Refused& refused) {
  const auto status = [&]() -> unsigned {
    switch (refused.why) {
      case Refusal::malformed: return 400;
      case Refusal::missing: return 404;
      case Refusal::wrong_offset:
      case Refusal::taken_over:
      case Refusal::unfinished: return 409;
      case Refusal::wrong_checksum:
      case Refusal::wrong_content: return 460;
      case Refusal::too_large: return 413;
      case Refusal::damaged: return 410;
      case Refusal::over_quota:
      case Refusal::no_space: return 507;
      case Refusal::failed: return 500;
    }
    return 500;
  }();
  // Where the store lies is nobody's business outside.
  if (refused.why == Refusal::failed || refused.why == Refusal::damaged) {
    logging::error("{}", refused.error.text());
    return error_response(status, refused.why == Refusal::failed ? "the station's disk refused; its log says why"
                                                                 : "some of the model's bytes are damaged in the store; send it again");
  }
  return error_response(status, refused.error.text());
}

}  // namespace prismesh::intake
