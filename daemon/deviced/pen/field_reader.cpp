#include "daemon/deviced/pen/field_reader.h"

#include <chrono>
#include <cstring>
#include <utility>

namespace prismesh::deviced::pen {

namespace {

constexpr std::chrono::microseconds kLookPeriod{500};
constexpr std::chrono::milliseconds kIdlePeriod{20};

}  // namespace

FieldReader::FieldReader() {
  for (auto& copy : copies_) {
    copy = std::make_unique<FieldCopy>();
    // Touches the memory now, not in a tick.
    std::memset(static_cast<void*>(copy.get()), 0, sizeof(FieldCopy));
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void FieldReader::attach(ipc::HapticFieldPageReader page) {
  const std::lock_guard lock(mutex_);
  page_ = std::move(page);
  copied_ = 0;
}

void FieldReader::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    bool attached = false;
    {
      const std::lock_guard lock(mutex_);
      attached = page_.has_value();
      if (attached) copy_newest();
    }
    if (attached)
      std::this_thread::sleep_for(kLookPeriod);
    else
      std::this_thread::sleep_for(kIdlePeriod);
  }
}

bool FieldReader::copy_newest() {
  const std::uint64_t newest = page_->newest();
  if (newest == 0 || newest == copied_) return false;
  FieldCopy& copy = *copies_[back_];
  copy.has_field = page_->read(copy.field);
  if (!copy.has_field) return false;
  copied_ = copy.field.number;
  const auto guides = page_->guides();
  const auto resistance = page_->resistance();
  if ((copy.has_guides = guides.has_value())) copy.guides = *guides;
  if ((copy.has_resistance = resistance.has_value())) copy.resistance = *resistance;
  back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  return true;
}

const FieldCopy* FieldReader::acquire() {
  if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~kFresh;
    any_ = true;
  }
  return any_ ? copies_[front_].get() : nullptr;
}

}  // namespace prismesh::deviced::pen
