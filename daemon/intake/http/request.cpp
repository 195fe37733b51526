#include "daemon/intake/http/request.h"

#include "base/json/write.h"

namespace prismesh::intake {

HttpResponse json_response(std::string text, unsigned status) {
  return {status, {{"Content-Type", "application/json"}, {"Cache-Control", "no-store"}}, std::move(text), std::nullopt, nullptr};
}

HttpResponse error_response(unsigned status, std::string_view sentence) {
  json::Json object = json::Json::object();
  object["error"] = std::string(sentence);
  return json_response(json::to_line(object) + "\n", status);
}

}  // namespace prismesh::intake
