#include "kiosk/display/kms/flipper.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk::display::kms {
namespace {

template <class Objects>
const Properties* properties_with(const Objects& objects, ObjectId id) {
  const auto found = std::find_if(objects.begin(), objects.end(), [&](const auto& one) { return one.id == id; });
  return found == objects.end() ? nullptr : &found->properties;
}

/// Collects the settings of one object by their names. Skips what the driver doesn't have.
class Settings {
 public:
  explicit Settings(std::vector<Setting>& to) : to_(to) {}
  Settings& on(ObjectId object, const Properties* properties) {
    object_ = object;
    properties_ = properties;
    return *this;
  }
  Settings& set(std::string_view name, std::uint64_t value) {
    if (properties_ == nullptr) return *this;
    if (const auto found = properties_->find(name); found != properties_->end()) to_.push_back({object_, found->second.id, value});
    return *this;
  }

 private:
  std::vector<Setting>& to_;
  ObjectId object_ = 0;
  const Properties* properties_ = nullptr;
};

std::uint64_t value_or(const Properties& properties, std::string_view name, std::uint64_t otherwise) {
  const auto found = properties.find(name);
  return found == properties.end() ? otherwise : found->second.value;
}

}  // namespace

Flipper::~Flipper() {
  if (mode_blob_ != 0) card_.drop_blob(mode_blob_);
}

void Flipper::set_output(Output output) {
  if (mode_blob_ != 0) card_.drop_blob(mode_blob_);
  output_ = std::move(output);
  mode_blob_ = card_.make_blob(output_.mode.timings);
  mode_set_ = false;
  if (pending_) replace_shown();
  release(shown_);
  release(next_);
  again_ = false;
  ++token_;  // events of before are none of these pictures'
  retry_ns_.reset();
  busy_since_ns_.reset();
  shown_ns_.reset();
}

Result<void> Flipper::show(ObjectId framebuffer) {
  if (next_) ++counts_.replaced;
  release(next_);
  next_ = framebuffer;
  return advance();
}

Result<void> Flipper::turn() {
  for (const Flip& flip : card_.take_flips()) take(flip);
  const std::int64_t now = clock_.now_ns();
  if (pending_ && !paused_ && now - committed_ns_ >= std::max(kLostNs, 10 * period_ns())) {
    // The event will not come. The mode is set anew, so that whatever the card is doing ends.
    ++counts_.lost;
    give_up_event();
    mode_set_ = false;
  }
  return advance();
}

std::optional<std::int64_t> Flipper::next_ns() const {
  if (paused_) return std::nullopt;
  if (pending_) return committed_ns_ + std::max(kLostNs, 10 * period_ns());
  return retry_ns_;
}

std::vector<ObjectId> Flipper::take_released() { return std::exchange(released_, {}); }

void Flipper::pause() {
  paused_ = true;
  give_up_event();
  retry_ns_.reset();
  busy_since_ns_.reset();
  shown_ns_.reset();
}

Result<void> Flipper::resume() {
  paused_ = false;
  mode_set_ = false;
  again_ = true;
  return advance();
}

/// The event of the picture under way isn't waited for any more. It is on the display, more likely than not.
void Flipper::give_up_event() {
  ++token_;
  if (pending_) replace_shown();
  again_ = true;
}

/// The picture under way becomes the shown one.
void Flipper::replace_shown() {
  if (shown_ != pending_) release(shown_);
  shown_ = std::exchange(pending_, std::nullopt);
}

/// Gives the waiting picture to the card, if it is time to.
Result<void> Flipper::advance() {
  const std::optional<ObjectId>& picture = next_ || !again_ ? next_ : shown_;
  if (paused_ || pending_ || !picture || (retry_ns_ && clock_.now_ns() < *retry_ns_)) return {};
  retry_ns_.reset();
  return commit(*picture);
}

Result<void> Flipper::commit(ObjectId framebuffer) {
  bool sets_mode = !mode_set_;
  int error = 0;
  for (int tries = 0; tries < 2; ++tries) {
    if (sets_mode)
      if (Result<void> prepared = prepare_mode(framebuffer); !prepared) return prepared;
    Change wanted = change(framebuffer, sets_mode, wishes_);
    wanted.flip_token = token_ + 1;
    error = card_.commit(wanted);
    // Something has changed below us, for example at a plug: the whole is set anew.
    if (error != EINVAL || sets_mode) break;
    sets_mode = true;
    mode_set_ = false;
  }
  if (error != 0) return judge(error, sets_mode);
  ++token_;
  if (sets_mode) ++counts_.modes;
  mode_set_ = true;
  pending_ = framebuffer;
  if (next_ == pending_) next_.reset();
  again_ = false;
  committed_ns_ = clock_.now_ns();
  busy_since_ns_.reset();
  return {};
}

/// Reads what others have left on the card. A driver may refuse a setting that it offers: finds out which, so that the others are set.
Result<void> Flipper::prepare_mode(ObjectId framebuffer) {
  Result<CardState> now = card_.read(false);
  if (!now) return fail(now.error());
  state_ = std::move(*now);
  const auto refuses = [&](const std::vector<LinkWish>& wishes) {
    Change test = change(framebuffer, true, wishes);
    test.only_test = true;
    return card_.commit(test) == EINVAL;
  };
  wishes_ = link_wishes(state_, output_);
  refused_.clear();
  if (wishes_.empty() || !refuses(wishes_) || refuses({})) return {};
  std::vector<LinkWish> accepted;
  for (const LinkWish& wish : wishes_) {
    accepted.push_back(wish);
    if (!refuses(accepted)) continue;
    accepted.pop_back();
    refused_.push_back(fmt::format("{}: the graphics card refuses to set its {} (\"{}\") to {}", output_.connector.name, wish.what,
                                   wish.property, wish.value_text));
  }
  wishes_ = std::move(accepted);
  return {};
}

Result<void> Flipper::judge(int error, bool sets_mode) {
  const std::int64_t now = clock_.now_ns();
  switch (error) {
    case EBUSY:
    case EAGAIN:
    case EINTR:
      ++counts_.busy;
      if (!busy_since_ns_) busy_since_ns_ = now;
      if (now - *busy_since_ns_ >= kHungNs) return fail(card_.name(), "the graphics card has been busy for ten seconds: it hangs");
      retry_ns_ = now + std::max<std::int64_t>(period_ns() / 4, 1'000'000);
      return {};
    case EACCES:
    case EPERM:  // the seat will tell when the display is ours again
      mode_set_ = false;
      retry_ns_ = now + kLostNs;
      return {};
    case EINVAL:
    case ERANGE:
    case ENOSPC:
      return fail(output_.connector.name, fmt::format("the graphics card refuses the mode {} ({}): [display] mode names another",
                                                      output_.mode.text(), std::strerror(error)));
    default:
      return fail(card_.name(), fmt::format("the graphics card {} ({})", sets_mode ? "can't set the mode" : "shows no more pictures",
                                            std::strerror(error)));
  }
}

Change Flipper::change(ObjectId framebuffer, bool sets_mode, const std::vector<LinkWish>& wishes) const {
  Change made;
  Settings settings(made.settings);
  const Properties* plane = properties_with(state_.planes, output_.plane);
  settings.on(output_.plane, plane).set("FB_ID", framebuffer);
  if (!sets_mode) return made;
  const auto width = static_cast<std::uint64_t>(output_.mode.size.width), height = static_cast<std::uint64_t>(output_.mode.size.height);
  settings.set("CRTC_ID", output_.crtc).set("SRC_X", 0).set("SRC_Y", 0).set("SRC_W", width << 16U).set("SRC_H", height << 16U);
  settings.set("CRTC_X", 0).set("CRTC_Y", 0).set("CRTC_W", width).set("CRTC_H", height);
  settings.on(output_.crtc, properties_with(state_.crtcs, output_.crtc)).set("MODE_ID", mode_blob_).set("ACTIVE", 1);
  settings.on(output_.connector.id, properties_with(state_.connectors, output_.connector.id))
      .set("CRTC_ID", output_.crtc)
      .set("link-status", 0);
  // What another program has left on this CRTC, such as its cursor, or a second monitor.
  for (const Plane& other : state_.planes)
    if (other.id != output_.plane && value_or(other.properties, "CRTC_ID", 0) == output_.crtc)
      settings.on(other.id, &other.properties).set("FB_ID", 0).set("CRTC_ID", 0);
  for (const Connector& other : state_.connectors)
    if (other.id != output_.connector.id && value_or(other.properties, "CRTC_ID", 0) == output_.crtc)
      settings.on(other.id, &other.properties).set("CRTC_ID", 0);
  for (const LinkWish& wish : wishes) made.settings.push_back(wish.setting);
  made.may_set_mode = true;
  return made;
}

void Flipper::take(const Flip& flip) {
  if (!pending_ || flip.token != token_) return;  // of a picture that was given up
  replace_shown();
  ++counts_.shown;
  const std::int64_t now = clock_.now_ns();
  // A time in the future or long ago is of another clock, or none.
  const bool plausible = flip.time_ns <= now + period_ns() && flip.time_ns >= committed_ns_ - 2 * period_ns();
  shown_ns_ = plausible ? std::optional(flip.time_ns) : std::nullopt;
  if (plausible) {
    const std::int64_t waited = (flip.time_ns - committed_ns_) / std::max<std::int64_t>(period_ns(), 1);
    if (waited > 0) counts_.missed += static_cast<std::uint64_t>(waited);
  }
}

void Flipper::release(std::optional<ObjectId>& picture) {
  if (picture) released_.push_back(*picture);
  picture.reset();
}

std::int64_t Flipper::period_ns() const { return output_.mode.refresh_hz > 0 ? std::llround(1e9 / output_.mode.refresh_hz) : 16'666'667; }

}  // namespace prismesh::kiosk::display::kms
