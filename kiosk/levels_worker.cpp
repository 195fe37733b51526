#include "kiosk/levels_worker.h"

#include <malloc.h>

#include <new>
#include <utility>

namespace prismesh::kiosk {

namespace {

constexpr std::int64_t kGlanceNs = 100'000'000;

bool same(const std::weak_ptr<const render::ModelSource>& a, const std::shared_ptr<const render::ModelSource>& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

}  // namespace

LevelsWorker::~LevelsWorker() { stop(); }

std::optional<render::MadeLevels> LevelsWorker::turn(std::int64_t now_ns, const std::shared_ptr<const render::ModelSource>& shown,
                                                     bool wanted) {
  if (!same(seen_, shown)) {
    seen_ = shown;
    since_ns_ = now_ns;
  }
  if (source_ && (!shown || shown->document_key() != source_->document_key())) stop();
  if (source_ && done_) {
    thread_.join();
    source_.reset();
    return std::exchange(made_, std::nullopt);
  }
  const bool large = shown && shown->size(ipc::SnapshotArray::shell_nodes) > kFewestShells;
  waiting_ = !source_ && wanted && large;
  if (waiting_ && now_ns - since_ns_ >= kRestNs) {
    waiting_ = false;
    begin(shown);
  }
  return std::nullopt;
}

std::optional<std::int64_t> LevelsWorker::next_ns(std::int64_t now_ns) const {
  if (source_) return now_ns + kGlanceNs;
  if (waiting_) return since_ns_ + kRestNs;
  return std::nullopt;
}

void LevelsWorker::begin(const std::shared_ptr<const render::ModelSource>& source) {
  source_ = source;
  cancelled_ = done_ = false;
  thread_ = std::thread([this] {
    try {
      Result<render::MadeLevels> made = render::make_levels(*source_, [this](double) { return !cancelled_; });
      if (made) made_ = std::move(*made);
    } catch (const std::bad_alloc&) {
      // The model is drawn as it is.
    }
    ::malloc_trim(0);  // making them takes more than they hold; what is free goes back
    done_ = true;
  });
}

void LevelsWorker::stop() {
  if (!source_) return;
  cancelled_ = true;
  thread_.join();
  source_.reset();
  made_.reset();
}

}  // namespace prismesh::kiosk
