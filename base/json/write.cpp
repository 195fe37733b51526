#include "base/json/write.h"

namespace prismesh::json {

std::string to_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace prismesh::json
