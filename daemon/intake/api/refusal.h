// The answers to what is refused.
#pragma once

#include "daemon/intake/http/request.h"
#include "daemon/intake/store/outcome.h"

namespace prismesh::intake {

HttpResponse refusal_response(const Refused& refused);
/// 401: no token, or none that is good.
HttpResponse unauthorised();
/// 429
HttpResponse too_many();
/// 204
HttpResponse no_content();

}  // namespace prismesh::intake
