// A graphics card in virtual time: keeps the kernel's rules of atomic changes, refreshes its display at a steady rate, and fails as real
// drivers do when it is told to.
#pragma once

#include <cerrno>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "kiosk/display/kms/card.h"

namespace prismesh::kiosk::display::kms {

inline Mode fake_mode(int width, int height, double refresh_hz, bool preferred = false) {
  Mode mode;
  mode.size = {width, height};
  mode.refresh_hz = refresh_hz;
  mode.preferred = preferred;
  const std::uint32_t tag[] = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                               static_cast<std::uint32_t>(refresh_hz)};
  std::memcpy(mode.timings.data(), tag, sizeof tag);
  return mode;
}

class FakeCard final : public Card {
 public:
  static constexpr ObjectId kConnector = 10, kCrtc = 20, kPlane = 30, kOverlay = 31;
  static constexpr std::int64_t kPeriodNs = 10'000'000;  ///< 100 Hz

  explicit FakeCard(ManualClock& clock) : clock_(clock) {
    state_.connectors.push_back(connector(kConnector, "DP-1"));
    state_.crtcs.push_back({kCrtc, {}});
    for (const char* name : {"MODE_ID", "ACTIVE", "CTM", "DEGAMMA_LUT", "GAMMA_LUT"}) add(state_.crtcs[0].properties, name);
    for (const ObjectId id : {kPlane, kOverlay}) {
      Plane plane;
      plane.id = id;
      plane.primary = plane.takes_xrgb8888 = id == kPlane;
      plane.crtcs = {kCrtc};
      for (const char* name : {"FB_ID", "CRTC_ID", "SRC_X", "SRC_Y", "SRC_W", "SRC_H", "CRTC_X", "CRTC_Y", "CRTC_W", "CRTC_H"})
        add(plane.properties, name);
      add(plane.properties, "rotation", {{"rotate-0", 1}, {"rotate-180", 4}});
      state_.planes.push_back(std::move(plane));
    }
  }

  /// A connected monitor with two modes.
  Connector connector(ObjectId id, const std::string& name) {
    Connector made;
    made.id = id;
    made.name = name;
    made.connected = true;
    made.modes = {fake_mode(1920, 1200, 100, true), fake_mode(1024, 768, 60)};
    made.crtcs = {kCrtc};
    add(made.properties, "CRTC_ID");
    add(made.properties, "link-status", {{"Good", 0}, {"Bad", 1}});
    add(made.properties, "scaling mode", {{"None", 0}, {"Full", 1}}).value = 1;
    add(made.properties, "Broadcast RGB", {{"Automatic", 0}, {"Full", 1}, {"Limited 16:235", 2}});
    Property& depth = add(made.properties, "max bpc");
    depth.low = 6;
    depth.high = depth.value = 12;
    return made;
  }

  const std::string& name() const override { return name_; }
  Result<CardState> read(bool) override {
    if (gone) return fail(name_, "the graphics card doesn't answer");
    return state_;
  }
  int commit(const Change& change) override {
    commits.push_back(change);
    if (gone) return ENODEV;
    if (!change.only_test && !fails.empty()) {
      const int error = fails.front();
      fails.pop_front();
      if (error != 0) return error;
    }
    if (pending_ && !change.only_test) return EBUSY;
    if (stolen) return EACCES;
    for (const Setting& setting : change.settings) {
      const auto known = names_.find(setting.property);
      if (known == names_.end() || refused.contains(known->second)) return EINVAL;
      const bool sets_mode = known->second == "MODE_ID" || known->second == "ACTIVE" || known->second == "link-status";
      if (sets_mode && !change.may_set_mode) return EINVAL;
    }
    if (!change.may_set_mode && !mode_set_) return EINVAL;
    if (change.only_test) return 0;
    for (const Setting& setting : change.settings) apply(setting);
    mode_set_ = true;
    if (change.flip_token) {
      // The picture appears at the next refresh, or later if the card is slow.
      const std::int64_t next = (clock_.now_ns() / kPeriodNs + 1) * kPeriodNs + skips * kPeriodNs;
      pending_ = Flip{*change.flip_token, static_cast<std::uint32_t>(next / kPeriodNs), next};
      skips = 0;
    }
    return 0;
  }
  ObjectId make_blob(std::span<const std::byte> bytes) override {
    blobs[++last_blob_].assign(bytes.begin(), bytes.end());
    return last_blob_;
  }
  void drop_blob(ObjectId blob) override { blobs.erase(blob); }
  std::vector<Flip> take_flips() override {
    std::vector<Flip> flips = std::exchange(late, {});
    if (!pending_ || clock_.now_ns() < pending_->time_ns + event_delay_ns) return flips;
    Flip flip = *pending_;
    pending_.reset();
    if (!std::exchange(loses_event, false)) {
      if (time_is_wrong) flip.time_ns = 0;
      flips.push_back(flip);
    }
    return flips;
  }
  int descriptor() const override { return -1; }

  CardState& state() { return state_; }
  std::uint64_t value(const Properties& properties, const char* name) const { return properties.find(name)->second.value; }
  /// The picture that the display shows or will show next.
  std::uint64_t picture() const { return value(state_.planes[0].properties, "FB_ID"); }
  const std::vector<std::byte>& mode() { return blobs[static_cast<ObjectId>(value(state_.crtcs[0].properties, "MODE_ID"))]; }
  bool flips() const { return pending_.has_value(); }
  /// As a hot plug or another program leaves the card.
  void lose_mode() { mode_set_ = false; }
  void end_flip() { pending_.reset(); }

  // What goes wrong.
  bool gone = false;
  bool stolen = false;              ///< another program shows its pictures
  std::deque<int> fails;            ///< results of the next changes that aren't tests; 0: as usual
  std::set<std::string> refused;    ///< properties that can't be set
  std::int64_t skips = 0;           ///< refreshes that the next picture misses
  std::int64_t event_delay_ns = 0;  ///< between a flip and its event
  bool loses_event = false;         ///< the next one
  bool time_is_wrong = false;       ///< flips have no time
  std::set<std::string> stays;      ///< properties that are accepted and keep their value
  std::vector<Flip> late;           ///< events of long ago
  std::vector<Change> commits;
  std::map<ObjectId, std::vector<std::byte>> blobs;

 private:
  Property& add(Properties& properties, const std::string& name, std::vector<std::pair<std::string, std::uint64_t>> names = {}) {
    Property property;
    property.id = ++last_property_;
    property.names = std::move(names);
    names_[property.id] = name;
    return properties[name] = std::move(property);
  }
  void apply(const Setting& setting) {
    if (stays.contains(names_[setting.property])) return;
    const auto set = [&](auto& objects) {
      for (auto& object : objects)
        if (object.id == setting.object)
          for (auto& [name, property] : object.properties)
            if (property.id == setting.property) property.value = setting.value;
    };
    set(state_.connectors);
    set(state_.crtcs);
    set(state_.planes);
  }

  ManualClock& clock_;
  std::string name_ = "/dev/dri/card7";
  CardState state_;
  std::map<ObjectId, std::string> names_;
  ObjectId last_property_ = 100, last_blob_ = 500;
  bool mode_set_ = false;
  std::optional<Flip> pending_;
};

}  // namespace prismesh::kiosk::display::kms
