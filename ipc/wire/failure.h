// Converts between an Error and the answer that tells a client of it.
#pragma once

#include "base/progress.h"
#include "ipc/wire/answers.h"

namespace prismesh::ipc {

inline Failed failed_from(const Error& error) { return {error.file, error.line, error.message}; }

/// The protocol has no field for an error's kind: cancelled work is told by its message.
inline Error error_from(const Failed& failed) {
  const bool stopped = failed.message == cancelled().message;
  return {failed.file, failed.line, failed.message, stopped ? ErrorKind::cancelled : ErrorKind::failure};
}

}  // namespace prismesh::ipc
