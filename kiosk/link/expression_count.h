// Asks how many entities an expression names. Sends one question at a time, and keeps only the newest of those that wait.
#pragma once

#include <optional>
#include <string>

#include "kiosk/link/connection.h"

namespace prismesh::kiosk::link {

class ExpressionCount final : public ConnectionListener {
 public:
  struct Count {
    std::string expr;
    mesh::select::EntityKind kind = mesh::select::EntityKind::node;
    std::optional<ipc::Counted> counted;
    std::optional<ipc::Failed> failed;
  };

  ExpressionCount(Connection& connection, notices::Trace trace);

  void ask(const std::string& expr, mesh::select::EntityKind kind);
  /// The server's newest answer.
  const std::optional<Count>& answer() const { return answer_; }

  void lost() override { asking_ = false; }

 private:
  void ask_next();

  Connection& connection_;
  notices::Trace trace_;
  std::optional<Count> answer_;
  std::optional<Count> next_;
  bool asking_ = false;
};

}  // namespace prismesh::kiosk::link
