#include "daemon/intake/api/pair_request.h"

#include "base/json/read.h"

namespace prismesh::json {

PRISMESH_JSON_OBJECT(intake::PairRequest, f.required("secret", m.secret), f("name", m.name), f("cookie", m.cookie));

}  // namespace prismesh::json

namespace prismesh::intake {

Result<PairRequest> parse_pair_request(std::string_view body) {
  const json::Json read = json::Json::parse(body, nullptr, false);
  PairRequest request;
  if (read.is_discarded()) return fail("request", "the body must be JSON, like {\"secret\": \"..\", \"name\": \"..\"}");
  if (const json::Problem problem = json::read(read, request, json::Author::program)) return fail("request", "the body " + *problem);
  return request;
}

}  // namespace prismesh::intake
