// Why a request over a network had no answer.
#pragma once

#include <functional>

#include "base/error.h"

namespace prismesh::ipc {

struct LineFault {
  Error error;
  bool may_pass = true;  ///< the line was cut, or nobody answers: trying again may help
};
template <class T>
using LineResult = tl::expected<T, LineFault>;

/// Asked some ten times a second while a line waits. True: give up, with the error of work that was stopped.
using Stop = std::function<bool()>;

}  // namespace prismesh::ipc
