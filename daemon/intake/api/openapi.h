// The description of the routes in OpenAPI 3.1, compiled in from openapi.json.
#pragma once

#include <string_view>

namespace prismesh::intake {

std::string_view openapi_text();

}  // namespace prismesh::intake
