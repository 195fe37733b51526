// Reads what a store answers in XML: lists of objects, and refusals. All of it comes over the network.
// Source: Amazon S3 API Reference, ListObjectsV2 and Error Responses.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace prismesh::ipc::vault {

struct ListedObject {
  std::string key;
  std::uint64_t bytes = 0;
};

struct ObjectList {
  std::vector<ListedObject> objects;
  std::string next;  ///< asks for what follows; empty: nothing does
};

/// Errors: another form; more follows, but not where, or in more than 4 KiB.
Result<ObjectList> parse_object_list(std::string_view body);

struct S3Refusal {
  std::string code;      ///< "NoSuchBucket"; empty: there is none that can be shown
  std::string message;   ///< may be empty
  std::string endpoint;  ///< the bucket's own host; usually empty
};
S3Refusal parse_refusal(std::string_view body);

}  // namespace prismesh::ipc::vault
