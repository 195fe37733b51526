#include "kiosk/link/expression_count.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

namespace prismesh::kiosk::link {

ExpressionCount::ExpressionCount(Connection& connection, notices::Trace trace) : connection_(connection), trace_(trace) {
  connection_.add(*this);
}

void ExpressionCount::ask(const std::string& expr, mesh::select::EntityKind kind) {
  next_ = Count{expr, kind, std::nullopt, std::nullopt};
  ask_next();
}

void ExpressionCount::ask_next() {
  if (!connection_.connected() || asking_ || !next_) return;
  Count what = *std::exchange(next_, std::nullopt);
  asking_ = true;
  connection_.ask(ipc::Count{what.expr, what.kind}, [this, what](const ipc::Answer& answer) mutable {
    asking_ = false;
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) what.failed = *failed;
    if (const auto* counted = std::get_if<ipc::Counted>(&answer)) what.counted = *counted;
    trace_.line(fmt::format("counted {} {}", what.counted ? std::to_string(what.counted->nodes) : "none", what.expr));
    answer_ = std::move(what);
    ask_next();
  });
}

}  // namespace prismesh::kiosk::link
