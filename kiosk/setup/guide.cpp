#include "kiosk/setup/guide.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>
#include <variant>

#include "drivers/display/profile.h"
#include "ipc/setup/checks.h"

namespace prismesh::kiosk::setup {
namespace {

constexpr std::array<std::string_view, 8> kPageNames{"name", "network", "profile", "calibration", "zone", "clock", "pairing", "done"};
constexpr std::size_t kMaxText = 80;

struct ProfileWords {
  std::string_view name, words;
};
constexpr std::array<ProfileWords, 11> kProfileWords{{
    {"prism-mask", "prisms before the panel, moved by a servo"},
    {"prism-mask-columns", "the same, woven in whole columns"},
    {"prism-mask-stencil", "the same, for comparison"},
    {"lenticular", "lenses that don't move"},
    {"row-interlaced", "polarised glasses"},
    {"side-by-side", "both pictures next to each other"},
    {"top-bottom", "the left eye's picture on top"},
    {"anaglyph", "red and cyan glasses"},
    {"mono", "an ordinary screen, no depth"},
    {"mono-left", "the left eye's picture only"},
    {"mono-right", "the right eye's picture only"},
}};

std::string_view words_of_profile(std::string_view name) {
  const auto found = std::ranges::find(kProfileWords, name, &ProfileWords::name);
  return found == kProfileWords.end() ? std::string_view() : found->words;
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c == ' ' ? '_' : c;
  });
  return small;
}

/// Words with blanks or commas between.
std::vector<std::string> split(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

bool same(const ipc::SetNetwork& a, const ipc::SetNetwork& b) {
  return a.dhcp == b.dhcp && a.address == b.address && a.gateway == b.gateway && a.dns == b.dns;
}

bool is_built_in(const std::string& profile) { return ipc::check_profile(profile).has_value(); }

}  // namespace

std::string_view name_of(Page page) { return kPageNames[static_cast<std::size_t>(page)]; }

Guide::Guide(const ipc::StationSetup& station, const Facts& facts) : station_(station), facts_(facts) {
  const auto kept = std::ranges::find(kPageNames, station.page);
  Page at = kept == kPageNames.end() ? Page::name : static_cast<Page>(kept - kPageNames.begin());
  while (!applies(at)) at = static_cast<Page>(static_cast<int>(at) + 1);
  enter(at);
}

bool Guide::applies(Page page) const {
  if (page == Page::calibration) return facts_.stereo;
  if (page == Page::clock) return !station_.clock_is_kept;
  return true;
}

void Guide::enter(Page page) {
  page_ = page;
  fields_.clear();
  focus_ = chosen_ = 0;
  trouble_.clear();
  calibration_.clear();
  code_.clear();
  shows_code_ = network_set_ = clock_known_ = typed_ = false;
  asked_.reset();
  switch (page) {
    case Page::name: fields_ = {{"name", "Name", station_.name, "", Pad::letters}}; break;
    case Page::network:
      chosen_ = station_.network.dhcp ? 0 : 1;
      fields_ = {{"address", "Address/prefix", station_.network.address, "", Pad::addresses},
                 {"gateway", "Gateway", station_.network.gateway, "", Pad::addresses},
                 {"dns", "Name servers", joined(station_.network.dns, " "), "", Pad::addresses}};
      break;
    case Page::profile: {
      const std::vector<Choice> all = choices();
      const auto found = std::ranges::find(all, is_built_in(facts_.profile) ? facts_.profile : all.front().label, &Choice::label);
      chosen_ = found == all.end() ? 0 : static_cast<std::size_t>(found - all.begin());
      break;
    }
    case Page::pairing: chosen_ = station_.pairing ? 1 : 0; break;
    case Page::zone:
      fields_ = {{"zone", "Find a town", "", "", Pad::letters}};
      filter_zones();
      break;
    case Page::clock: fields_ = {{"date", "Day", station_.date, "", Pad::digits}, {"time", "Time", station_.time, "", Pad::digits}}; break;
    case Page::calibration:
    case Page::done: break;
  }
}

void Guide::go(int by) {
  int at = static_cast<int>(page_) + by;
  while (at >= 0 && at < static_cast<int>(kPageNames.size()) && !applies(static_cast<Page>(at))) at += by;
  if (at >= 0 && at < static_cast<int>(kPageNames.size())) enter(static_cast<Page>(at));
}

std::vector<Choice> Guide::choices() const {
  std::vector<Choice> all;
  switch (page_) {
    case Page::network: return {{"By itself (DHCP)", "the network gives the address"}, {"Fixed address", "as your network's keeper says"}};
    case Page::profile:
      if (!is_built_in(facts_.profile)) all.push_back({"As it is", facts_.profile});
      for (const auto& profile : drivers::display::built_in_profiles())
        all.push_back({profile.name, std::string(words_of_profile(profile.name))});
      return all;
    case Page::pairing:
      if (shows_code_) return {};
      return {{"Off", "no model comes in from the network"}, {"On", "computers that you pair may send and fetch models"}};
    case Page::zone:
      for (const std::string& zone : zones_) all.push_back({zone, ""});
      return all;
    default: return all;
  }
}

View Guide::view() const {
  View view;
  view.count = view.number = 0;
  for (std::size_t i = 0; i < kPageNames.size(); ++i) {
    if (!applies(static_cast<Page>(i))) continue;
    ++view.count;
    if (static_cast<Page>(i) <= page_) ++view.number;
  }
  view.first = view.number == 1;
  view.choices = choices();
  view.chosen = chosen_;
  if (page_ != Page::network || chosen_ == 1) view.fields = fields_;
  view.focus = focus_;
  view.trouble = trouble_;
  view.next = "Next";
  const std::string now =
      addresses_.empty() ? "The station has no address in the network now." : "Address now: " + joined(addresses_, ", ");
  switch (page_) {
    case Page::name:
      view.title = "The station's name";
      view.task = "By this name the station is told from others. Letters, digits and hyphens.";
      break;
    case Page::network:
      view.title = "Network";
      view.task = "How the station gets its address. It works without a network too.";
      view.remarks = {now};
      if (network_set_)
        view.remarks.insert(view.remarks.begin(), "It is set. An address may take some seconds; Back and Next leave it so.");
      break;
    case Page::profile:
      view.title = "Display";
      view.task = "What stands before the panel. Words that can't be read afterwards: go back and choose another, or mono.";
      break;
    case Page::calibration:
      view.title = "Calibration";
      view.can_calibrate = facts_.stereo && (!facts_.mask_moves || facts_.mask_answers);
      view.task = "Depth is right when the display is measured with your own eyes. It takes ten minutes, and can be done later.";
      if (!view.can_calibrate) view.remarks = {"The mask doesn't answer: its port and its supply first (docs/display.md)."};
      if (!calibration_.empty()) view.remarks.push_back(calibration_);
      view.next = calibration_.empty() ? "Later" : "Next";
      break;
    case Page::pairing:
      view.title = "Other computers";
      view.task = "Models can come from other computers and go back. Each one is paired with a code that this page shows.";
      view.remarks = code_;
      if (!code_.empty()) view.remarks.push_back(now);
      if (shows_code_ && code_.empty()) view.remarks = {"Waiting for the code .."};
      break;
    case Page::zone:
      view.title = "Time zone";
      view.finds = true;
      view.task = "Type a part of a town's name in your zone, and choose.";
      view.remarks = {"Set: " + station_.zone};
      if (zones_.empty()) view.trouble = "No zone has that in its name.";
      break;
    case Page::clock:
      view.title = "Clock";
      view.task = "No time server answers. Set day and time by hand; if one answers later, it goes before this.";
      break;
    case Page::done:
      view.title = "The station is set up";
      view.task = "All of this can be called again: F12.";
      view.remarks = {"Name: " + station_.name, now, "Time zone: " + station_.zone};
      view.next = "Finish";
      view.can_skip = false;
      break;
  }
  return view;
}

// --- the hands ---

void Guide::type(std::string_view text) {
  if (focus_ >= fields_.size() || (page_ == Page::network && chosen_ == 0) || asked_) return;
  Field& field = fields_[focus_];
  if (field.text.size() + text.size() > kMaxText) return;
  field.text += text;
  typed_ = true;
  field.trouble.clear();
  if (page_ == Page::zone) filter_zones();
}

void Guide::erase() {
  if (focus_ >= fields_.size() || (page_ == Page::network && chosen_ == 0) || asked_) return;
  Field& field = fields_[focus_];
  const auto continues = [&] { return !field.text.empty() && (static_cast<unsigned char>(field.text.back()) & 0xc0) == 0x80; };
  while (continues()) field.text.pop_back();
  if (!field.text.empty()) field.text.pop_back();
  typed_ = true;
  field.trouble.clear();
  if (page_ == Page::zone) filter_zones();
}

void Guide::focus(std::size_t field) {
  if (field < fields_.size()) focus_ = field;
}

void Guide::focus_next() {
  if (!fields_.empty()) focus_ = (focus_ + 1) % fields_.size();
}

void Guide::choose(std::size_t choice) {
  if (choice >= choices().size() || asked_) return;
  chosen_ = choice;
  trouble_.clear();
}

void Guide::step(int by) {
  const auto count = static_cast<int>(choices().size());
  if (count > 0) choose(static_cast<std::size_t>(std::clamp(static_cast<int>(chosen_) + by, 0, count - 1)));
}

void Guide::filter_zones() {
  const std::string wanted = small_letters(fields_.front().text);
  zones_.clear();
  std::ranges::copy_if(station_.zones, std::back_inserter(zones_),
                       [&](const std::string& zone) { return small_letters(zone).find(wanted) != std::string::npos; });
  const auto set = std::ranges::find(zones_, station_.zone);
  chosen_ = wanted.empty() && set != zones_.end() ? static_cast<std::size_t>(set - zones_.begin()) : 0;
}

void Guide::skip() {
  if (asked_ || page_ == Page::done) return;
  go(1);
}

void Guide::back() {
  if (!asked_) go(-1);
}

ipc::SetNetwork Guide::typed_network() const {
  if (chosen_ == 0) return {};
  return {false, fields_[0].text, fields_[1].text, split(fields_[2].text)};
}

/// What the page would set; nothing: it is set already.
std::optional<ipc::SetupRequest> Guide::request() const {
  const auto other = [](bool changes, ipc::SetupRequest request) { return changes ? std::optional(std::move(request)) : std::nullopt; };
  switch (page_) {
    case Page::name: return other(fields_[0].text != station_.name, ipc::SetName{fields_[0].text});
    case Page::network: return other(!same(typed_network(), station_.network), typed_network());
    case Page::profile: {
      const std::string chosen = choices()[chosen_].label;
      return other(is_built_in(chosen) && chosen != facts_.profile, ipc::SetProfile{chosen});
    }
    // Also where it is so already: after a power cut between the setting and the service both are made to agree.
    case Page::pairing: return ipc::SetPairing{chosen_ == 1};
    case Page::zone: return other(!zones_.empty() && zones_[chosen_] != station_.zone, ipc::SetZone{zones_.empty() ? "" : zones_[chosen_]});
    case Page::clock: return other(typed_, ipc::SetClock{fields_[0].text, fields_[1].text});
    case Page::done: return ipc::FinishSetup{};
    case Page::calibration: return std::nullopt;
  }
  return std::nullopt;
}

std::optional<ipc::SetupRequest> Guide::next() {
  if (asked_ || finished_) return std::nullopt;
  trouble_.clear();
  for (Field& field : fields_) field.trouble.clear();
  if (shows_code_) {
    go(1);
    return std::nullopt;
  }
  if (page_ == Page::zone && zones_.empty()) return std::nullopt;
  asked_ = request();
  if (!asked_) {
    answered({});
    return std::nullopt;
  }
  if (const Result<void> checked = ipc::check_setup(*asked_); !checked) {
    asked_.reset();
    tell(checked.error());
    return std::nullopt;
  }
  return asked_;
}

void Guide::tell(const Error& error) {
  const auto field = std::ranges::find(fields_, error.file, &Field::name);
  if (field == fields_.end()) {
    trouble_ = error.file.find('/') == std::string::npos ? error.message : error.text();
    return;
  }
  field->trouble = error.message;
  focus_ = static_cast<std::size_t>(field - fields_.begin());
}

void Guide::answered(const Result<void>& done) {
  const std::optional<ipc::SetupRequest> asked = std::exchange(asked_, std::nullopt);
  if (!done) return tell(done.error());
  if (asked) {
    if (const auto* name = std::get_if<ipc::SetName>(&*asked)) station_.name = name->name;
    if (const auto* network = std::get_if<ipc::SetNetwork>(&*asked)) station_.network = *network;
    if (const auto* profile = std::get_if<ipc::SetProfile>(&*asked)) take_profile(profile->profile);
    if (const auto* pairing = std::get_if<ipc::SetPairing>(&*asked)) station_.pairing = pairing->on;
    if (const auto* zone = std::get_if<ipc::SetZone>(&*asked)) station_.zone = zone->zone;
    if (const auto* clock = std::get_if<ipc::SetClock>(&*asked)) {
      station_.date = clock->date;
      station_.time = clock->time;
    }
  }
  if (page_ == Page::done) {
    finished_ = true;
  } else if (page_ == Page::pairing && station_.pairing) {
    shows_code_ = true;
  } else if (asked && page_ == Page::network) {
    network_set_ = true;  // the page stays, and says the address that comes of it
  } else {
    go(1);
  }
}

void Guide::set_clock(const ipc::StationSetup& now) {
  station_.date = now.date;
  station_.time = now.time;
  station_.clock_is_kept = now.clock_is_kept;
  if (page_ != Page::clock || asked_) return;
  clock_known_ = true;
  if (now.clock_is_kept) return go(1);
  if (typed_) return;
  fields_[0].text = now.date;
  fields_[1].text = now.time;
}

void Guide::take_profile(const std::string& name) {
  station_.profile = facts_.profile = name;
  for (const auto& profile : drivers::display::built_in_profiles()) {
    if (profile.name != name) continue;
    facts_.stereo = profile.stereo();
    facts_.mask_moves = profile.mask_moves;
  }
}

void Guide::calibrated(std::string how) {
  if (page_ == Page::calibration) calibration_ = std::move(how);
}

}  // namespace prismesh::kiosk::setup
