// How a request's body and its answer go between a connection and what is done.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemon/intake/http/request.h"

namespace prismesh::intake {

using Respond = std::function<void(HttpResponse)>;
/// Nothing: go on. Else that is the answer, and the rest of the body isn't read.
using GoOn = std::function<void(std::optional<HttpResponse>)>;

/// Takes the body of one request, piece by piece; one call at a time. Continuations come from any thread. Destroyed before `end`: the
/// sender is gone.
class BodyTaker {
 public:
  virtual ~BodyTaker() = default;
  virtual void open(GoOn go_on) = 0;
  virtual void piece(std::string bytes, GoOn go_on) = 0;
  virtual void end(Respond respond) = 0;
};

}  // namespace prismesh::intake
