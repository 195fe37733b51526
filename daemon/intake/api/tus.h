// Headers of tus 1.0.0 (https://tus.io/protocols/resumable-upload).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/error.h"
#include "daemon/intake/http/request.h"
#include "daemon/intake/http/routes.h"
#include "daemon/intake/store/uploads.h"

namespace prismesh::intake {

inline constexpr const char* kTusVersion = "1.0.0";

bool needs_tus_version(Operation operation);
/// 412, unless the request says that it speaks this version.
std::optional<HttpResponse> check_tus_version(const HttpRequest& request);
HttpResponse tus_description(std::uint64_t max_file_bytes);

/// Errors: no length, metadata that can't be read, a hash that is none. Metadata may have `sha256`, the whole file's in hexadecimal digits.
Result<NewUpload> parse_new_upload(const HttpRequest& request, const std::string& who);

HttpResponse upload_response(unsigned status, const UploadStatus& upload, std::int64_t now_s);
/// The answer to HEAD.
HttpResponse shown_upload(const UploadStatus& upload, std::int64_t now_s);

}  // namespace prismesh::intake
