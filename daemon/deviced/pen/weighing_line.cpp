#include "daemon/deviced/pen/weighing_line.h"

namespace prismesh::deviced::pen {

namespace {

constexpr std::int64_t kForceValidNs = 3'000'000;

}  // namespace

bool WeighingLine::send(std::int64_t now_ns, const Eigen::Vector3d& newton) {
  if (guard_.is_tripped() && forces_) ended_ = true;
  const Eigen::Vector3d sent = ended_ ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : newton;
  forces_ = !sent.isZero();
  pen_.send(now_ns, {sent, now_ns + kForceValidNs});
  if (!forces_) guard_.acknowledge();
  if (!pen_.is_stuck(now_ns)) guard_.beats.fetch_add(1);
  return ended_;
}

}  // namespace prismesh::deviced::pen
